// What may be changed while it runs: the author's parameters as sliders, every other number for experts.

import { count, type Numbers, none } from "../../api/numbers";
import type { AfterChange, SessionParameter } from "../../api/types";
import { announce, h, setText } from "../../core/dom";
import { t } from "../../core/texts";

import type { Session } from "../../session/session";
import { empty } from "../../ui/notice";
import type { Panel } from "../../ui/panel";
import { Attempts } from "./attempts";
import { ExpertPanel } from "./expert-panel";
import { ParameterRow } from "./parameter-row";
import { PullPanel } from "./pull-panel";

/** Pause after which a change is sent again that the server did not answer, ms. */
const AGAIN_MS = 2000;

/** How the run stands to that of the author. */
export function standing(changed: number, altered: boolean): string {
  if (changed > 0) return t("{numbers} changed.", { numbers: t("{n} number | {n} numbers", { n: changed }) });
  return altered
    ? t("The numbers are the author’s; this run was changed on its way.")
    : t("As the author wrote it.");
}

export class ParametersTab implements Panel {
  readonly root: HTMLElement;
  private readonly attempts = new Attempts();
  private readonly rows = new Map<string, ParameterRow>();
  private readonly list = h("div", { class: "parameters" });
  private readonly status = h("p", { class: "help", role: "status" });
  private readonly undo = h(
    "button",
    { type: "button", class: "button small", onclick: () => void this.attempt(() => this.session.undo()) },
    t("Undo"),
  );
  private readonly reset = h(
    "button",
    {
      type: "button",
      class: "button small",
      onclick: () => void this.attempt(() => this.session.change(none())),
    },
    t("Reset all"),
  );
  private readonly expert: ExpertPanel;
  private readonly pull: PullPanel;
  /** The change to be sent next. */
  private wanted: { to: Numbers; then?: AfterChange | undefined } | undefined;
  private sending = false;
  /** The change that the server did not answer: it is sent again when that is back. */
  private unsent: { to: Numbers; then?: AfterChange | undefined } | undefined;
  private timer = 0;

  constructor(private readonly session: Session) {
    this.expert = new ExpertPanel(session, (pointer, value, then) => {
      const base = this.base();
      this.change({ values: base.values, places: { ...base.places, [pointer]: value } }, then);
    });
    this.pull = new PullPanel(session);
    this.root = h(
      "div",
      { class: "stack" },
      h("div", { class: "row between" }, this.status, h("div", { class: "row" }, this.undo, this.reset)),
      this.attempts.root,
      this.list,
      this.pull.root,
      this.expert.root,
    );
    session.on("opened", () => {
      if (this.unsent) this.again();
      else this.attempts.answers();
    });
    session.on("scene", () => {
      this.paint();
      this.expert.refresh();
      if (count(session.numbers) === 0 && session.canUndo)
        announce(t("All numbers stand as the author wrote them."));
    });
  }

  refresh(): void {
    this.paint();
    this.expert.refresh();
    this.pull.refresh();
  }

  /** Goes back: what waits for the server is given up. */
  private async attempt(change: () => Promise<void>): Promise<void> {
    this.unsent = undefined;
    await this.attempts.run(change);
    this.paint();
  }

  /** What a further change starts from: the one that waits, if there is one. */
  private base(): Numbers {
    return (this.wanted ?? this.unsent)?.to ?? this.session.numbers;
  }

  private setValue(name: string, value: number): void {
    const base = this.base();
    this.change({ values: { ...base.values, [name]: value }, places: base.places });
  }

  /** A slider that is dragged asks often: one request at a time, the newest wins. */
  private change(to: Numbers, then?: AfterChange): void {
    this.wanted = { to, then };
    if (!this.sending) void this.send();
  }

  /** Sends once more what the server did not answer, as long as the page is there. */
  private again(): void {
    const { unsent } = this;
    if (unsent && this.root.isConnected) this.change(unsent.to, unsent.then);
  }

  private async send(): Promise<void> {
    this.sending = true;
    while (this.wanted) {
      const { to, then } = this.wanted;
      this.wanted = undefined;
      const answered = await this.attempts.run(() => this.session.change(to, then));
      this.unsent = answered ? undefined : { to, then };
    }
    clearTimeout(this.timer);
    if (this.unsent) this.timer = window.setTimeout(() => this.again(), AGAIN_MS);
    this.sending = false;
    this.paint();
  }

  private paint(): void {
    const { view, numbers, canUndo } = this.session;
    if (!view) return;
    const names = view.parameters.map((parameter) => parameter.name);
    if (names.join("|") !== [...this.rows.keys()].join("|") || this.list.childElementCount === 0)
      this.makeRows(view.parameters);
    // What was typed and not sent stays where it was typed.
    if (!this.sending && !this.unsent)
      for (const parameter of view.parameters)
        this.rows.get(parameter.name)?.show(parameter, parameter.value);
    const changed = count(numbers);
    setText(this.status, standing(changed, this.session.altered));
    this.undo.disabled = !canUndo;
    this.reset.disabled = changed === 0;
  }

  private makeRows(parameters: SessionParameter[]): void {
    this.rows.clear();
    for (const parameter of parameters)
      this.rows.set(
        parameter.name,
        new ParameterRow(parameter, (value) => this.setValue(parameter.name, value)),
      );
    this.list.replaceChildren(...[...this.rows.values()].map((row) => row.root));
    if (parameters.length === 0)
      this.list.replaceChildren(
        empty(
          t("No sliders here"),
          t("The author of this scene offers no parameters. Every number of it can be changed below."),
        ),
      );
  }
}
