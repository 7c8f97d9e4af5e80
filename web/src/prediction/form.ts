// One prediction as buttons: chosen, then kept. Skipping is a button, too, and is kept as that.

import type { Prediction } from "../api/types";
import { authored, h, uid } from "../core/dom";
import { recall, remember, student } from "../core/prefs";
import { t } from "../core/texts";
import { problemNotice } from "../ui/notice";

/** What somebody says; no choice where they skip, who then need no name. */
export interface Said {
  name: string;
  choice: string | null;
  why: string;
}

export class PredictionForm {
  readonly root: HTMLElement;
  private chosen: string | null = null;
  private readonly buttons: HTMLButtonElement[];
  private readonly why = h("input", {
    class: "field",
    id: uid("why"),
    maxlength: "1000",
    autocomplete: "off",
  });
  private readonly name = h("input", {
    class: "field",
    id: uid("who"),
    maxlength: "80",
    autocomplete: "name",
    value: student.get(),
  });
  private readonly keep = h(
    "button",
    { type: "submit", class: "button primary", disabled: true },
    t("That is my prediction"),
  );
  private readonly skip = h("button", { type: "button", class: "button quiet" }, t("Skip, and say so"));
  private readonly trouble = h("div", { role: "status" });

  /** `draft` is where the words of the reason are kept until they are given: a name or another language makes the form anew. */
  constructor(
    asked: Prediction,
    private readonly draft: `why:${string}`,
    private readonly give: (said: Said) => Promise<void>,
  ) {
    this.why.value = recall(draft) ?? "";
    this.why.addEventListener("input", () => remember(draft, this.why.value || null));
    this.buttons = asked.options.map((option) => {
      const button = authored(
        h("button", { type: "button", class: "button choice", "aria-pressed": "false" }),
        option.html,
      );
      button.addEventListener("click", () => this.choose(option.id, button));
      return button;
    });
    this.skip.addEventListener("click", () => void this.send(null));
    const question = uid("asked");
    this.root = h(
      "form",
      { class: "prediction-form", novalidate: true, tabindex: "-1", "aria-label": t("Before you run it") },
      h("h2", null, t("Before you run it")),
      authored(h("div", { id: question, class: "prediction-asked" }), asked.html),
      h("div", { class: "row wrap", role: "group", "aria-labelledby": question }, ...this.buttons),
      asked.asks_why
        ? h("p", { class: "labelled" }, h("label", { for: this.why.id }, t("Why? A few words")), this.why)
        : null,
      student.known() || student.get()
        ? null
        : h(
            "p",
            { class: "labelled" },
            h("label", { for: this.name.id }, t("Your name, under which it is kept")),
            this.name,
          ),
      h("div", { class: "row wrap" }, this.keep, this.skip),
      h("p", { class: "help" }, rules(asked)),
      this.trouble,
    );
    this.root.addEventListener("submit", (event) => {
      event.preventDefault();
      if (this.chosen !== null) void this.send(this.chosen);
    });
  }

  /** Not on a button: the key that brought it here would press it. */
  focus(): void {
    this.root.focus({ preventScroll: true });
  }

  private choose(id: string, pressed: HTMLButtonElement): void {
    this.chosen = id;
    this.keep.disabled = false;
    for (const button of this.buttons) button.setAttribute("aria-pressed", String(button === pressed));
  }

  private async send(choice: string | null): Promise<void> {
    const name = this.name.value.trim();
    if (!name && choice !== null) {
      this.trouble.textContent = t("Write your name: the prediction is kept under it.");
      this.name.focus();
      return;
    }
    this.skip.disabled = true;
    this.keep.disabled = true;
    try {
      await this.give({ name, choice, why: this.why.value.trim() });
      remember(this.draft, null);
    } catch (error) {
      this.trouble.replaceChildren(problemNotice(error));
      this.skip.disabled = false;
      this.keep.disabled = this.chosen === null;
    }
  }
}

function rules(asked: Prediction): string {
  const points =
    asked.points > 0
      ? ` ${t("{n} point for having predicted, right or wrong. | {n} points for having predicted, right or wrong.", { n: asked.points })}`
      : "";
  return `${t("The run waits for it. It is kept once, and not graded as right or wrong.")}${points}`;
}
