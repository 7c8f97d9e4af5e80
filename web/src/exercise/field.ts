// What every kind of answer field has in common.
import type { Answer, Scene } from "../api/types";
import { h } from "../core/dom";

export interface Inputs {
  root: HTMLElement;
  answer: () => Answer;
  draft: () => string[];
}

/** The run beside the questions: its scene with the numbers that it has now. */
export interface OwnRun {
  scene: Scene;
  /** Something was changed on its way: from its start it moves differently. */
  altered: boolean;
}

/** Where a question belongs: its lesson, whose numbers it asks about, and the ids of what describes it. */
export interface QuestionContext {
  slug: string;
  seed: string;
  base: string;
  described: string;
  /** The name of one of its fields for screen readers, which list them without the question around them. */
  named: (what: string) => string;
  /** The run beside the questions, once there is one. */
  run: () => OwnRun | undefined;
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
