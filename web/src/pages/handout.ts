// A lesson on paper: the button that prints it, and the head that only the paper has.

import type { Lesson } from "../api/types";
import { h } from "../core/dom";
import { t } from "../core/texts";
import { onPrint } from "../core/theme";

export const printButton = (): HTMLElement =>
  h(
    "button",
    { type: "button", class: "button quiet small print-button", onclick: () => print() },
    t("Print a handout"),
  );

/** The head of the paper: whose numbers, a line for the name, the way back; filled when it is printed. */
export function handoutHead(lesson: Lesson): { root: HTMLElement; dispose: () => void } {
  const code = h("span");
  const numbers = lesson.has_variants
    ? lesson.seed
      ? t("With the numbers of {seed}.", { seed: lesson.seed })
      : t("With the numbers that everybody sees.")
    : "";
  const root = h(
    "div",
    { class: "handout-head", "aria-hidden": "true" },
    h("div", null, h("p", null, t("Name: ______________________________")), h("p", null, numbers)),
    code,
  );
  const address = location.origin + location.pathname;
  // It is small, and ready when somebody prints.
  void import("../lecture/qr").then(({ qr }) => code.append(qr(address)));
  return { root, dispose: onPrint(() => undefined) };
}
