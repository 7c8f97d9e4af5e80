// The dialog in which a presenter writes a question for everybody.

import { h } from "../core/dom";
import { t } from "../core/texts";
import { dialog } from "../ui/dialog";
import { problemNotice } from "../ui/notice";

export interface NewQuestion {
  text: string;
  choices: string[];
}

/** `ask` sends the question with the index of its right choice; the dialog stays open until it is accepted. */
export function questionDialog(
  joint: string | null,
  ask: (question: NewQuestion, right: number | null) => Promise<void>,
): void {
  const text = h("input", {
    class: "field",
    id: "ask-text",
    maxlength: "400",
    value: joint
      ? t("Which sign does Fx of {joint} have at this moment?", { joint })
      : t("What happens next?"),
  });
  const choices = h(
    "textarea",
    { class: "field", id: "ask-choices", rows: "4" },
    t("positive\nnegative\nzero"),
  );
  const right = h("input", {
    class: "field compact",
    id: "ask-right",
    inputmode: "numeric",
    placeholder: t("none"),
  });
  const wrong = h("div");
  const form = h(
    "form",
    { class: "stack" },
    h("label", { for: "ask-text" }, t("Question")),
    text,
    h("label", { for: "ask-choices" }, t("Choices, one a line")),
    choices,
    h("label", { for: "ask-right" }, t("Number of the right choice, shown at the reveal")),
    right,
    wrong,
    h("div", { class: "row" }, h("button", { class: "button primary" }, t("Ask"))),
  );
  const box = dialog(t("Ask everybody"), form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const lines = choices.value.split("\n").map((line) => line.trim());
    const index = right.value.trim() === "" ? null : Number(right.value) - 1;
    ask({ text: text.value.trim(), choices: lines.filter(Boolean) }, index)
      .then(() => box.close())
      .catch((error: unknown) => wrong.replaceChildren(problemNotice(error)));
  });
  text.select();
}
