// "What happened": the events of the run and the singular positions that it passed, the newest first.

import { AUTHORED, h, setText } from "../core/dom";
import { t } from "../core/texts";
import { type Happening, happenings, leftOut } from "../session/happened";
import type { Session } from "../session/session";
import { keyed } from "../ui/keyed";

export class HappenedList {
  private readonly list = h("ol", { class: "happened-list" });
  private readonly earlier = h("p", { class: "help", hidden: true });
  readonly root = h(
    "section",
    { class: "happened", "aria-label": t("What happened"), hidden: true },
    h("h3", null, t("What happened")),
    this.list,
    this.earlier,
  );

  constructor(private readonly session: Session) {}

  /** The run so far, whatever moment of it is shown. */
  refresh(): void {
    const state = this.session.latest;
    if (!state) return;
    const newest = [...happenings(state)].reverse();
    this.root.hidden = newest.length === 0;
    keyed(
      this.list,
      newest.map(({ when, words }) => `${when} ${words}`),
      (at) => this.item(newest[at] as Happening),
    );
    const n = leftOut(state);
    this.earlier.hidden = n === 0;
    setText(this.earlier, t("{n} earlier one is not told. | {n} earlier ones are not told.", { n }));
  }

  private item({ kind, time, when, words, name }: Happening): HTMLElement {
    const what = h("span", { class: "happened-what" }, words);
    if (kind === "event" && words === name) what.lang = AUTHORED;
    return h(
      "li",
      null,
      h(
        "button",
        {
          type: "button",
          class: "happened-go",
          title: t("Look at this moment"),
          onclick: () => this.session.seek(time),
        },
        h("span", { class: `happened-mark is-${kind}`, "aria-hidden": "true" }),
        h("span", { class: "happened-when" }, when),
        " ",
        what,
      ),
    );
  }
}
