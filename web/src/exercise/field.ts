// What every kind of answer field has in common.
import type { Answer } from "../api/types";
import { h } from "../core/dom";

export interface Inputs {
  root: HTMLElement;
  answer: () => Answer;
  draft: () => string[];
}

/** Where a question belongs: its lesson, whose numbers it asks about, and the ids of what describes it. */
export interface QuestionContext {
  slug: string;
  seed: string;
  base: string;
  described: string;
}

export function textInput(
  id: string,
  label: string,
  described: string,
  value: string,
  cls = "",
): HTMLInputElement {
  return h("input", {
    id,
    class: `field number ${cls}`,
    inputmode: cls.includes("unit") ? "text" : "decimal",
    autocomplete: "off",
    autocapitalize: "off",
    spellcheck: "false",
    "aria-label": label,
    "aria-describedby": described,
    value,
    maxlength: "200",
  });
}
