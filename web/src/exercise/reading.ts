// How the grader reads what is typed, beside the field, before it is handed in.

import { api } from "../api/client";
import type { Question } from "../api/types";
import { h } from "../core/dom";
import { t } from "../core/texts";
import type { Inputs } from "./field";

/** Quiet time after a key, in ms, before the answer is read. */
const QUIET = 350;
const READ = new Set(["number", "vector", "matrix", "formula"]);

/** The line below a typed answer: "Read as 29.4 N", or what to change. */
export function readingLine(slug: string, question: Question, inputs: Inputs): HTMLElement | null {
  if (!READ.has(question.kind)) return null;
  const line = h("p", { class: "read-as", "aria-live": "polite" });
  let asked: AbortController | undefined;
  let timer = 0;
  const show = (text: string, unread: boolean): void => {
    line.textContent = text;
    line.classList.toggle("is-unread", unread);
  };
  const read = async (): Promise<void> => {
    const { value, unit } = inputs.answer();
    const typed = [value].flat(2);
    if (value == null || typed.some((text) => text === "" || text == null)) return show("", false);
    asked = new AbortController();
    try {
      const answer = unit ? { value, unit } : { value };
      const understood = await api.reading(slug, question.id, answer, asked.signal);
      if (understood.text) show(t("Read as {text}", { text: understood.text }), false);
      else show(understood.problem ?? "", true);
    } catch {
      // Without the server nothing can be handed in either, which the page tells elsewhere.
    }
  };
  inputs.root.addEventListener("input", () => {
    asked?.abort();
    clearTimeout(timer);
    timer = window.setTimeout(() => void read(), QUIET);
  });
  void read();
  return line;
}
