// One question as form fields, its hints one at a time, and its verdict.
import { api } from "../core/api";
import { announce, authored, h } from "../core/dom";
import { plural } from "../core/format";
import { setMaths } from "../core/maths";
import type { Answer, Question, QuestionVerdict } from "../core/types";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import { verdictLine } from "./verdict";

export interface QuestionField {
  id: string;
  root: HTMLElement;
  answer: () => Answer;
  draft: () => string[];
  show: (verdict: QuestionVerdict | undefined) => void;
}

interface Inputs {
  root: HTMLElement;
  answer: () => Answer;
  draft: () => string[];
}

export function questionField(slug: string, question: Question, number: number, draft: string[] | undefined, changed: () => void): QuestionField {
  const base = `q-${question.id}`;
  const ruleId = `${base}-rule`;
  const verdictId = `${base}-verdict`;
  const described = `${ruleId} ${verdictId}`;
  const inputs = question.kind === "choice" ? choice(question, base, draft) : question.kind === "vector" ? vector(question, base, described, draft) : number1(question, base, described, draft);
  const verdict = h("div", { id: verdictId, class: "verdict-slot" });
  inputs.root.addEventListener("input", changed);

  const root = h("fieldset", { class: "question", id: base, "aria-describedby": ruleId },
    h("legend", null,
      h("span", { class: "question-number" }, `${number}`),
      authored(h("span", { class: "question-prompt" }), question.prompt_html),
      h("span", { class: "question-points" }, plural(question.points, "point"))),
    inputs.root,
    h("p", { class: "rule", id: ruleId }, question.rule),
    question.hints_available > 0 ? hints(slug, question) : null,
    verdict);

  return {
    id: question.id,
    root,
    answer: inputs.answer,
    draft: inputs.draft,
    show: (result) => {
      root.classList.remove("is-right", "is-wrong", "is-blank", "is-invalid");
      for (const input of root.querySelectorAll("input")) input.removeAttribute("aria-invalid");
      if (!result) {
        verdict.replaceChildren();
        return;
      }
      root.classList.add(`is-${result.verdict}`);
      if (result.verdict === "invalid" || result.verdict === "wrong") {
        for (const input of root.querySelectorAll("input:not([type=radio])")) input.setAttribute("aria-invalid", "true");
      }
      verdict.replaceChildren(verdictLine(result));
    },
  };
}

function textInput(id: string, label: string, described: string, value: string, cls = ""): HTMLInputElement {
  return h("input", {
    id, class: `field number ${cls}`, inputmode: cls.includes("unit") ? "text" : "decimal", autocomplete: "off",
    autocapitalize: "off", spellcheck: "false", "aria-label": label, "aria-describedby": described, value, maxlength: "64",
  });
}

function unitInput(question: Question, base: string, described: string, draft: string | undefined): HTMLInputElement | null {
  if (!question.asks_unit) return null;
  return textInput(`${base}-unit`, "Unit", described, draft ?? "", "unit-field");
}

/** A unit that is not asked for stands behind the field. */
function givenUnit(question: Question): HTMLElement | null {
  return question.unit ? h("span", { class: "given-unit" }, question.unit) : null;
}

function number1(question: Question, base: string, described: string, draft: string[] | undefined): Inputs {
  const value = textInput(`${base}-value`, question.kind === "formula" ? "Formula" : "Value", described, draft?.[0] ?? "");
  if (question.kind === "formula") {
    value.inputMode = "text";
    value.maxLength = 400;
  }
  const unit = unitInput(question, base, described, draft?.[1]);
  return {
    root: h("div", { class: "answer" }, value, unit ?? givenUnit(question)),
    answer: () => withUnit({ value: value.value.trim() }, unit),
    draft: () => [value.value, ...(unit ? [unit.value] : [])],
  };
}

function vector(question: Question, base: string, described: string, draft: string[] | undefined): Inputs {
  const count = question.size ? question.size[0] * question.size[1] : 3;
  const names = count === 3 ? ["x", "y", "z"] : Array.from({ length: count }, (_, k) => String(k + 1));
  const parts = names.map((axis, k) => textInput(`${base}-${axis}`, `${axis} component`, described, draft?.[k] ?? ""));
  const unit = unitInput(question, base, described, draft?.[count]);
  return {
    root: h("div", { class: "answer is-vector" },
      ...parts.map((part, k) => h("span", { class: "component" }, h("span", { "aria-hidden": "true" }, names[k] ?? ""), part)), unit ?? givenUnit(question)),
    answer: () => withUnit({ value: parts.map((part) => part.value.trim()) }, unit),
    draft: () => [...parts.map((part) => part.value), ...(unit ? [unit.value] : [])],
  };
}

function withUnit<T extends { value: string } | { value: string[] }>(answer: T, unit: HTMLInputElement | null): Answer {
  return unit ? { ...answer, unit: unit.value.trim() } : answer;
}

function choice(question: Question, base: string, draft: string[] | undefined): Inputs {
  const radios = (question.options ?? []).map((option) => {
    const radio = h("input", { type: "radio", name: base, value: option.id, id: `${base}-${option.id}` });
    radio.checked = draft?.[0] === option.id;
    const text = authored(h("span"), option.html);
    // An option that is a formula alone is named by its LaTeX, which every screen reader can say.
    if (onlyMaths(text)) radio.setAttribute("aria-label", text.textContent?.trim() ?? option.id);
    return { radio, label: h("label", { class: "option", for: radio.id }, radio, text) };
  });
  const chosen = (): string => radios.find((entry) => entry.radio.checked)?.radio.value ?? "";
  return {
    root: h("div", { class: "answer is-choice" }, ...radios.map((entry) => entry.label)),
    answer: () => ({ choice: chosen() }),
    draft: () => [chosen()],
  };
}

function onlyMaths(text: HTMLElement): boolean {
  const copy = text.cloneNode(true) as HTMLElement;
  for (const formula of copy.querySelectorAll(".math")) formula.remove();
  return !/\p{L}/u.test(copy.textContent ?? "");
}

function hints(slug: string, question: Question): HTMLElement {
  let shown = 0;
  const list = h("ol", { class: "hints" });
  const more = h("button", { type: "button", class: "button quiet small" });
  const paint = (): void => {
    const left = question.hints_available - shown;
    more.replaceChildren(icon("bulb"), shown === 0 ? "Show a hint" : `Another hint (${left} left)`);
    more.hidden = left <= 0;
  };
  more.addEventListener("click", () => {
    more.disabled = true;
    api.hint(slug, question.id, shown + 1)
      .then(async (hint) => {
        shown += 1;
        const line = authored(h("li"), hint.html);
        list.append(line);
        await setMaths(line);
        announce(`Hint ${shown}: ${line.textContent ?? ""}`);
        paint();
      })
      .catch((error: unknown) => list.append(h("li", null, problemNotice(error))))
      .finally(() => {
        more.disabled = false;
      });
  });
  paint();
  return h("div", { class: "hint-block" }, list, more);
}

