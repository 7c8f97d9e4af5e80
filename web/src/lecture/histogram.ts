// How the answers to a question stand.

import type { Tally } from "../api/types";
import { h } from "../core/dom";
import { t } from "../core/texts";

/** The counts of the answers as bars with numbers; the right one is marked by a word too. */
export function histogram(
  choices: string[],
  tally: Pick<Tally, "counts" | "right" | "revealed"> & Partial<Pick<Tally, "before">>,
  mine?: number,
  counted = (n: number): string => t("{n} answer | {n} answers", { n }),
): HTMLElement {
  const sum = (counts: number[]): number => counts.reduce((all, count) => all + count, 0);
  const all = sum(tally.counts);
  const { before } = tally;
  const most = Math.max(1, ...tally.counts, ...(before ?? []));
  const bar = (count: number, past = false): HTMLElement =>
    h("span", { class: past ? "bar is-before" : "bar", style: `inline-size:${(100 * count) / most}%` });
  return h(
    "table",
    { class: "histogram" },
    h(
      "caption",
      null,
      counted(all),
      before
        ? `; ${t("the thin bars are the first vote, {n} answer | the thin bars are the first vote, {n} answers", { n: sum(before) })}`
        : null,
    ),
    before
      ? h(
          "thead",
          null,
          h(
            "tr",
            null,
            h("td"),
            h("td"),
            h("th", { scope: "col", class: "number" }, t("first")),
            h("th", { scope: "col", class: "number" }, t("now")),
          ),
        )
      : null,
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
          h("td", { class: "bar-cell" }, before ? bar(before[k] ?? 0, true) : null, bar(count)),
          before ? h("td", { class: "number" }, String(before[k] ?? 0)) : null,
          h("td", { class: "number" }, String(count)),
        );
      }),
    ),
  );
}
