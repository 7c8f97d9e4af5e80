// How far somebody is with a lesson: not begun, begun, to mend, passed.

import type { GradedSubmission } from "../api/types";
import { h } from "../core/dom";
import { points } from "../core/format";
import { recallsAny } from "../core/prefs";
import { t } from "../core/texts";
import { icon } from "../ui/icons";

export type Standing =
  | { is: "new" | "begun" }
  /** Handed in, and not passed yet; without points where nothing could be judged or points are held back. */
  | { is: "mend"; earned: number | undefined; possible: number }
  | { is: "passed"; earned: number | undefined; possible: number };

/** The standing in each lesson in which something was handed in. */
export function standings(verdicts: GradedSubmission[]): Map<string, Standing> {
  const found = new Map<string, Standing>();
  for (const verdict of verdicts) {
    const before = found.get(verdict.lesson);
    const known = before && "earned" in before ? before.earned : undefined;
    const earned = verdict.gradable ? (verdict.earned ?? undefined) : undefined;
    const best = earned === undefined ? known : Math.max(known ?? 0, earned);
    const is = before?.is === "passed" || verdict.passed ? "passed" : "mend";
    found.set(verdict.lesson, { is, earned: best, possible: verdict.possible });
  }
  return found;
}

/** Whether something is written in this browser and not handed in yet: answers, or notes beside the steps. */
export const begun = (slug: string): boolean => recallsAny(`draft:${slug}`, `said:${slug}`);

export function standingLabel(standing: Standing): HTMLElement {
  switch (standing.is) {
    case "new":
      return h("span", { class: "standing" }, t("Not begun"));
    case "begun":
      return h("span", { class: "standing is-begun" }, icon("dash"), t("Begun"));
    case "mend":
      return h(
        "span",
        { class: "standing is-open" },
        icon("reset"),
        t("To mend{score}", { score: score(standing) }),
      );
    case "passed":
      return h(
        "span",
        { class: "standing is-right" },
        icon("check"),
        t("Passed{score}", { score: score(standing) }),
      );
  }
}

const score = ({ earned, possible }: { earned: number | undefined; possible: number }): string =>
  earned === undefined
    ? ""
    : `, ${t("{earned} of {possible}", { earned: points(earned), possible: points(possible) })}`;
