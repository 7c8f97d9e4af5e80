// What only the presenter sees: hands, questions without names, how the answers stand, notes, the next slide.

import type { PresenterState } from "../api/types";
import { h, setText } from "../core/dom";
import { t } from "../core/texts";

export interface DeskHooks {
  show: (remark: number, shown: boolean) => void;
  settle: (remark: number) => void;
  lower: () => void;
}

/** Folded where the presenter's page itself is projected; it unfolds when another window shows the lecture to the hall. */
export class Desk {
  readonly root: HTMLDetailsElement;
  private readonly summary = h("span", { role: "status" });
  private readonly hands = h("p");
  private readonly lower = h("button", { type: "button", class: "button small" }, t("Put hands down"));
  private readonly remarks = h("ul", { class: "desk-remarks" });
  private readonly votes = h("section", { class: "desk-part", hidden: true });
  private readonly notes = h("div");
  private apart = false;
  private shownRemarks = "";

  constructor(private readonly hooks: DeskHooks) {
    this.lower.addEventListener("click", () => hooks.lower());
    this.root = h(
      "details",
      { class: "desk" },
      h("summary", null, h("b", null, t("Your desk")), " ", this.summary),
      h(
        "div",
        { class: "desk-parts" },
        h(
          "section",
          { class: "desk-part" },
          h("h2", null, t("From the hall")),
          h("div", { class: "row wrap tight" }, this.hands, this.lower),
          this.remarks,
        ),
        this.votes,
        this.notes,
      ),
    );
  }

  /** Notes and the next slide have their place here. */
  place(notes: HTMLElement | undefined): void {
    this.notes.replaceChildren(...(notes ? [notes] : []));
  }

  paint(state: PresenterState, votes: HTMLElement | undefined): void {
    const { hands, remarks, roaming, screens } = state;
    // Where the hall sees another window, all of this is for the presenter's eyes.
    if (screens > 0 !== this.apart) {
      this.apart = screens > 0;
      this.root.open = this.apart;
    }
    const said = [
      t("{n} hand | {n} hands", { n: hands }),
      t("{n} question | {n} questions", { n: remarks.length }),
      t("{n} looks around alone | {n} look around alone", { n: roaming }),
    ];
    setText(this.summary, said.join(" · "));
    setText(this.hands, hands === 0 ? t("No hand is raised.") : t("{n} hand | {n} hands", { n: hands }));
    this.lower.hidden = hands === 0;
    this.votes.hidden = !votes || !this.apart;
    this.votes.replaceChildren(
      ...(votes && this.apart ? [h("h2", null, t("How they stand; the hall does not see it")), votes] : []),
    );
    this.paintRemarks(remarks);
  }

  private paintRemarks(remarks: PresenterState["remarks"]): void {
    const key = JSON.stringify(remarks);
    if (key === this.shownRemarks) return;
    this.shownRemarks = key;
    const press = (label: string, run: () => void): HTMLElement =>
      h("button", { type: "button", class: "button small", onclick: run }, label);
    this.remarks.replaceChildren(
      ...(remarks.length === 0 ? [h("li", { class: "help" }, t("No question waits."))] : []),
      ...remarks.map(({ number, text, shown }) =>
        h(
          "li",
          { class: shown ? "is-shown" : "" },
          h("p", null, text),
          h(
            "span",
            { class: "row wrap tight" },
            press(shown ? t("Hide it again") : t("Show to everybody"), () => this.hooks.show(number, !shown)),
            press(t("Done"), () => this.hooks.settle(number)),
          ),
        ),
      ),
    );
  }
}
