// A question to all followers: how one of them answers it, and how everybody sees the result.

import { api } from "../api/client";
import type { LectureQuestion } from "../api/types";
import { h } from "../core/dom";
import { recall, remember } from "../core/prefs";
import { t } from "../core/texts";
import { problemNotice } from "../ui/notice";
import { histogram } from "./histogram";

/** A random name, kept in the browser: a second answer replaces the first and is not counted twice. */
export function voter(): string {
  const known = recall("voter");
  if (known) return known;
  const bytes = crypto.getRandomValues(new Uint8Array(12));
  const made = Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
  remember("voter", made);
  return made;
}

export function ballot(code: string): {
  root: HTMLElement;
  show: (question: LectureQuestion | null) => void;
} {
  const root = h("section", {
    class: "ballot",
    hidden: true,
    "aria-label": t("Question"),
    "aria-live": "polite",
  });
  let shown = "";
  let chosen: number | undefined;

  const show = (question: LectureQuestion | null): void => {
    const key = JSON.stringify(question);
    if (key === shown) return;
    if (!question || JSON.parse(shown || "null")?.number !== question.number) chosen = undefined;
    shown = key;
    root.hidden = !question;
    if (!question) return;
    if (question.result) {
      root.replaceChildren(
        h("h2", null, question.text),
        histogram(question.choices, question.result, chosen),
      );
      return;
    }
    const said = h(
      "p",
      { class: "help", role: "status" },
      t("Your answer can be changed until the result is shown."),
    );
    const buttons = question.choices.map((choice, k) =>
      h(
        "button",
        {
          type: "button",
          class: "button choice",
          "aria-pressed": String(chosen === k),
          onclick: () => {
            api
              .answer(code, { question: question.number, voter: voter(), choice: k })
              .then(() => {
                chosen = k;
                for (const [at, button] of buttons.entries())
                  button.setAttribute("aria-pressed", String(at === k));
                said.textContent = t("Counted: {choice}. It can be changed until the result is shown.", {
                  choice,
                });
              })
              .catch((error: unknown) => said.replaceChildren(problemNotice(error)));
          },
        },
        choice,
      ),
    );
    root.replaceChildren(
      h("h2", null, question.text),
      question.again
        ? h("p", { class: "help" }, t("Asked again: talk it over with your neighbour, then vote anew."))
        : "",
      h("div", { class: "row wrap" }, ...buttons),
      said,
    );
  };
  return { root, show };
}
