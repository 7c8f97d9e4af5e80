// The fields of one question, by kind: what is typed, pasted, chosen or uploaded becomes an answer.

import { api } from "../api/client";
import type { Answer, Question } from "../api/types";
import { authored, h } from "../core/dom";
import { t } from "../core/texts";
import { diagramInput } from "./diagram";
import { explanationInput } from "./explanation";
import { type Inputs, type QuestionContext, textInput } from "./field";
import { fileInput } from "./file";
import { tuningInput } from "./tuning";

export function inputsOf(question: Question, place: QuestionContext, draft: string[] | undefined): Inputs {
  switch (question.kind) {
    case "choice":
      return choice(question, place, draft);
    case "vector":
      return grid(question, place, draft);
    case "matrix":
      return grid(question, place, draft);
    case "diagram":
      return diagramInput(question, place, draft);
    case "implement":
    case "trajectory":
    case "model":
      return fileInput(question, place, draft);
    case "tuning":
      return tuningInput(question, place, draft);
    case "explanation":
      return explanationInput(question, place, draft);
    default:
      return single(question, place, draft);
  }
}

function unitInput(
  question: Question,
  place: QuestionContext,
  draft: string | undefined,
): HTMLInputElement | null {
  if (!question.asks_unit) return null;
  return textInput(`${place.base}-unit`, place.named(t("unit")), place.described, draft ?? "", "unit-field");
}

/** A unit that is not asked for stands behind the field. */
function givenUnit(question: Question): HTMLElement | null {
  return question.unit ? h("span", { class: "given-unit" }, question.unit) : null;
}

function single(question: Question, place: QuestionContext, draft: string[] | undefined): Inputs {
  const formula = question.kind === "formula";
  const asked = question.unit ? t("value in {unit}", { unit: question.unit }) : t("value");
  const label = place.named(formula ? t("formula") : asked);
  const value = textInput(`${place.base}-value`, label, place.described, draft?.[0] ?? "");
  if (formula) {
    value.inputMode = "text";
    value.maxLength = 400;
  }
  const unit = unitInput(question, place, draft?.[1]);
  return {
    root: h("div", { class: "answer" }, value, unit ?? givenUnit(question)),
    answer: () => withUnit({ value: value.value.trim() }, unit),
    draft: () => [value.value, ...(unit ? [unit.value] : [])],
  };
}

/** A vector in one line, a matrix in lines. Numbers that were copied elsewhere can be pasted into any cell. */
function grid(question: Question, place: QuestionContext, draft: string[] | undefined): Inputs {
  const [rows, columns] = question.size ?? [3, 1];
  const matrix = question.kind === "matrix";
  const axes = question.components ?? Array.from({ length: rows }, (_, k) => String(k + 1));
  const cells = Array.from({ length: rows * columns }, (_, k) => {
    const row = Math.floor(k / columns);
    const label = matrix
      ? t("row {row}, column {column}", { row: row + 1, column: (k % columns) + 1 })
      : t("{axis} component", { axis: axes[row] ?? "" });
    const suffix = matrix ? `${row + 1}-${(k % columns) + 1}` : axes[row];
    return textInput(`${place.base}-${suffix}`, place.named(label), place.described, draft?.[k] ?? "");
  });
  for (const [at, cell] of cells.entries())
    cell.addEventListener("paste", (event) => {
      const text = event.clipboardData?.getData("text") ?? "";
      if (!/\d\D+\d|[ijk]/.test(text.trim())) return;
      event.preventDefault();
      void spread(question, place.slug, text, cells, at);
    });
  const unit = unitInput(question, place, draft?.[cells.length]);
  const after = unit ?? givenUnit(question);
  const root = matrix
    ? h(
        "div",
        { class: "answer is-matrix" },
        h(
          "div",
          {
            class: "matrix-field",
            role: "group",
            "aria-label": t("{rows} rows, {columns} columns", { rows, columns }),
            style: `--columns:${columns}`,
          },
          ...cells,
        ),
        after,
      )
    : h(
        "div",
        { class: "answer is-vector" },
        ...cells.map((cell, k) =>
          h("span", { class: "component" }, h("span", { "aria-hidden": "true" }, axes[k] ?? ""), cell),
        ),
        after,
      );
  const lines = (): string[][] =>
    Array.from({ length: rows }, (_, r) =>
      cells.slice(r * columns, (r + 1) * columns).map((cell) => cell.value.trim()),
    );
  return {
    root,
    answer: () => withUnit({ value: matrix ? lines() : cells.map((cell) => cell.value.trim()) }, unit),
    draft: () => [...cells.map((cell) => cell.value), ...(unit ? [unit.value] : [])],
  };
}

/** Puts the entries of a pasted vector or matrix into its cells; what is none goes into the one cell. */
async function spread(
  question: Question,
  slug: string,
  text: string,
  cells: HTMLInputElement[],
  at: number,
): Promise<void> {
  const read = await api.reading(slug, question.id, { value: text }).catch(() => undefined);
  const entries = read?.cells ?? [];
  if (entries.length === cells.length) for (const [k, cell] of cells.entries()) cell.value = entries[k] ?? "";
  else {
    const cell = cells[at];
    cell?.setRangeText(text.trim(), cell.selectionStart ?? 0, cell.selectionEnd ?? 0, "end");
  }
  cells[at]?.dispatchEvent(new Event("input", { bubbles: true }));
}

function withUnit<T extends { value: string | string[] | string[][] }>(
  answer: T,
  unit: HTMLInputElement | null,
): Answer {
  return unit ? { ...answer, unit: unit.value.trim() } : answer;
}

function choice(question: Question, { base }: QuestionContext, draft: string[] | undefined): Inputs {
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
