// A question to all followers: how one of them answers it, and how everybody sees the result.

import { api } from "../api/client";
import type { LectureQuestion, Tally } from "../api/types";
import { h } from "../core/dom";
import { recall, remember } from "../core/prefs";
import { t } from "../core/texts";
import { problemNotice } from "../ui/notice";

/** A random name, kept in the browser: a second answer replaces the first and is not counted twice. */
function voter(): string {
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
    root.replaceChildren(h("h2", null, question.text), h("div", { class: "row wrap" }, ...buttons), said);
  };
  return { root, show };
}

/** The counts of the answers as bars with numbers; the right one is marked by a word too. */
export function histogram(
  choices: string[],
  tally: Pick<Tally, "counts" | "right" | "revealed">,
  mine?: number,
  counted = (n: number): string => t("{n} answer | {n} answers", { n }),
): HTMLElement {
  const all = tally.counts.reduce((sum, count) => sum + count, 0);
  const most = Math.max(1, ...tally.counts);
  return h(
    "table",
    { class: "histogram" },
    h("caption", null, counted(all)),
    h(
      "tbody",
      null,
      ...choices.map((choice, k) => {
        const count = tally.counts[k] ?? 0;
        const right = tally.right === k && tally.revealed;
        return h(
          "tr",
          { class: right ? "is-right" : "" },
          h(
            "th",
            { scope: "row" },
            choice,
            right ? h("span", { class: "mark" }, " ", t("right")) : null,
            mine === k ? h("span", { class: "mark" }, " ", t("yours")) : null,
          ),
          h(
            "td",
            { class: "bar-cell" },
            h("span", { class: "bar", style: `inline-size:${(100 * count) / most}%` }),
          ),
          h("td", { class: "number" }, String(count)),
        );
      }),
    ),
  );
}
