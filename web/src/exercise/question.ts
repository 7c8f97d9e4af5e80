// One question as form fields, its hints one at a time, and its verdict.

import { api } from "../api/client";
import type { Answer, Lesson, Question, QuestionVerdict } from "../api/types";
import { AUTHORED, announce, authored, h } from "../core/dom";
import { setMaths } from "../core/maths";
import { t } from "../core/texts";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import type { Inputs, OwnRun } from "./field";
import { inputsOf } from "./inputs";
import { readingLine } from "./reading";
import { verdictLine } from "./verdict";

export interface QuestionField {
  id: string;
  root: HTMLElement;
  answer: () => Answer;
  draft: () => string[];
  /** How many hints are open. */
  hints: () => number;
  /** Shows a verdict of an answer; beside another answer it stands as that of the earlier one. */
  show: (verdict: QuestionVerdict | undefined, of: Answer) => void;
}

/** What was filled in before, and how many hints were opened. */
export interface Draft {
  draft: string[] | undefined;
  hints: number;
}

export function questionField(
  lesson: Lesson,
  question: Question,
  number: number,
  before: Draft,
  changed: () => void,
  run: () => OwnRun | undefined,
): QuestionField {
  const base = `q-${question.id}`;
  const ruleId = `${base}-rule`;
  const verdictId = `${base}-verdict`;
  const named = (what: string): string => t("Question {number}: {what}", { number, what });
  const described = `${ruleId} ${verdictId}`;
  const context = { slug: lesson.slug, seed: lesson.seed, base, described, named, run };
  const inputs = inputsOf(question, context, before.draft);
  const opened = hints(lesson, question, before.hints, changed);
  const slot = h("div", { id: verdictId, class: "verdict-slot" });

  const root = h(
    "fieldset",
    { class: "question", id: base, "aria-describedby": ruleId },
    h(
      "legend",
      null,
      h("span", { class: "question-number" }, `${number}`),
      authored(h("span", { class: "question-prompt" }), question.prompt_html),
      h("span", { class: "question-points" }, t("{n} point | {n} points", { n: question.points })),
    ),
    inputs.root,
    readingLine(lesson.slug, question, inputs),
    h("p", { class: "rule", id: ruleId, lang: AUTHORED }, question.rule),
    // On paper alone.
    h("div", { class: "handout-space", "aria-hidden": "true" }),
    question.hints_available > 0 ? opened.root : null,
    slot,
  );
  const judged = verdictOf(root, slot, inputs);
  for (const event of ["input", "change"]) {
    inputs.root.addEventListener(event, changed);
    inputs.root.addEventListener(event, judged.paint);
  }

  return {
    id: question.id,
    root,
    answer: inputs.answer,
    draft: inputs.draft,
    hints: opened.shown,
    show: judged.show,
  };
}

const MARKS = ["is-right", "is-wrong", "is-blank", "is-invalid", "is-waiting", "is-kept"];

/** The verdict of a question, in its slot and as marks of the whole. */
function verdictOf(
  root: HTMLElement,
  slot: HTMLElement,
  inputs: Inputs,
): Pick<QuestionField, "show"> & { paint: () => void } {
  const earlier = h(
    "p",
    { class: "verdict-earlier" },
    t("This was said of your earlier answer: check again to have the new one judged."),
  );
  let shown: { result: QuestionVerdict; line: HTMLElement; of: string } | undefined;
  const paint = (): void => {
    root.classList.remove(...MARKS);
    for (const input of root.querySelectorAll("input, textarea, select"))
      input.removeAttribute("aria-invalid");
    if (!shown) {
      slot.replaceChildren();
      return;
    }
    const stands = JSON.stringify(inputs.answer()) === shown.of;
    slot.classList.toggle("is-earlier", !stands);
    slot.replaceChildren(...(stands ? [] : [earlier]), shown.line);
    if (!stands) return;
    const { verdict } = shown.result;
    root.classList.add(`is-${verdict}`);
    if (verdict === "invalid" || verdict === "wrong")
      for (const input of root.querySelectorAll("input:not([type=radio], [type=file]), textarea"))
        input.setAttribute("aria-invalid", "true");
  };
  const show: QuestionField["show"] = (result, of) => {
    shown = result && { result, line: verdictLine(result), of: JSON.stringify(of) };
    paint();
  };
  return { show, paint };
}

/** Hints one at a time; those that were open before are open again. */
function hints(
  lesson: Lesson,
  question: Question,
  before: number,
  changed: () => void,
): { root: HTMLElement; shown: () => number } {
  let shown = 0;
  const list = h("ol", { class: "hints" });
  const more = h("button", { type: "button", class: "button quiet small" });
  const paint = (): void => {
    const left = question.hints_available - shown;
    more.replaceChildren(
      icon("bulb"),
      shown === 0 ? t("Show a hint") : t("Another hint ({left} left)", { left }),
    );
    more.hidden = left <= 0;
  };
  const open = async (aloud: boolean): Promise<void> => {
    more.disabled = true;
    try {
      const hint = await api.hint(lesson.slug, question.id, shown + 1, lesson.seed);
      shown += 1;
      const line = authored(h("li"), hint.html);
      list.append(line);
      await setMaths(line);
      if (aloud) announce(t("Hint {shown}: {hint}", { shown, hint: line.textContent ?? "" }));
      paint();
      changed();
    } catch (error) {
      list.append(h("li", null, problemNotice(error)));
    } finally {
      more.disabled = false;
    }
  };
  more.addEventListener("click", () => void open(true));
  paint();
  const reopen = async (): Promise<void> => {
    for (let k = 0; k < Math.min(before, question.hints_available); k += 1) await open(false);
  };
  void reopen();
  return { root: h("div", { class: "hint-block" }, list, more), shown: () => shown };
}
