// A verdict in words and a mark: never by colour alone.

import { inClass } from "../api/identity";
import type { GradedSubmission, Mark, QuestionVerdict } from "../api/types";
import { authored, h } from "../core/dom";
import { points } from "../core/format";
import { t } from "../core/texts";
import { type IconName, icon } from "../ui/icons";

const WORDS: Record<Mark, { word: () => string; mark: IconName }> = {
  right: { word: () => t("Right"), mark: "check" },
  wrong: { word: () => t("Not yet"), mark: "cross" },
  blank: { word: () => t("No answer"), mark: "dash" },
  invalid: { word: () => t("Sent back"), mark: "warn" },
  kept: { word: () => t("Kept"), mark: "check" },
  waiting: { word: () => t("Waiting"), mark: "dash" },
};

/** What is kept and judged, and not told yet. */
const HELD: { word: () => string; mark: IconName } = { word: () => t("Handed in"), mark: "dash" };

/** What the heading says already, in the words of the server. */
const SAID = new Set(["Right.", "Not right.", "Not answered."]);
const unknownMistake = (): string =>
  t("This mistake is not one that we know. Go through your steps once more, or open a hint.");

export function verdictLine(result: QuestionVerdict): HTMLElement {
  const { word, mark } = result.verdict ? (WORDS[result.verdict] ?? WORDS.invalid) : HELD;
  const text = authored(h("div", { class: "verdict-text" }), result.message_html ?? "");
  // The heading says it already.
  const first = text.firstElementChild;
  if (first && SAID.has(first.textContent ?? "")) first.remove();
  if (result.verdict === "wrong" && result.message_html != null && !text.textContent)
    text.append(h("p", null, unknownMistake()));
  return h(
    "div",
    { class: `verdict is-${result.verdict ?? "waiting"}` },
    h(
      "p",
      { class: "verdict-head" },
      icon(mark),
      h("strong", null, word()),
      result.earned == null ? null : h("span", { class: "verdict-points" }, earned(result)),
    ),
    text.textContent ? text : null,
    result.mark?.remark
      ? h("p", { class: "verdict-text" }, `${result.mark.by}: ${result.mark.remark}`)
      : null,
    standingLine(result),
    result.reference_html
      ? h(
          "details",
          { class: "reference" },
          h(
            "summary",
            null,
            result.verdict === "kept" ? t("A good explanation, to compare") : t("The reference answer"),
          ),
          authored(h("div", { class: "verdict-text" }), result.reference_html),
        )
      : null,
    result.figure_svg
      ? authored(
          h("div", {
            class: "verdict-figure",
            tabindex: "0",
            role: "region",
            "aria-label": t("The picture to this answer"),
          }),
          result.figure_svg,
        )
      : null,
  );
}

/** The points of a question in words; those of an explanation are given by people. */
function earned({ verdict, earned, possible, mark }: QuestionVerdict): string {
  if (verdict === "kept") {
    if (mark?.points != null)
      return t("{points} points by {name}", { points: points(mark.points), name: mark.by });
    return inClass() ? t("waits for your teacher") : "";
  }
  // What was not judged has no points to tell.
  if (possible === 0 || verdict === "invalid" || verdict === "waiting") return "";
  return t("{earned} of {possible} points", { earned: points(earned ?? 0), possible: points(possible) });
}

/** Where the student stands with the question: tries that are left, or that its points stay as they are. */
function standingLine({ verdict, standing, possible }: QuestionVerdict): HTMLElement | null {
  if (!standing || possible === 0) return null;
  const { attempts, best, open, left } = standing;
  if (open && best >= possible) {
    // Full points beside a wrong answer want a word.
    const once = t("You have had it right: your points for this question stay at {possible}.", {
      possible: points(possible),
    });
    return verdict === "right" ? null : h("p", { class: "standing-line is-open" }, once);
  }
  const text = open
    ? t("The right answer is open. Your points for this question stay at {best} of {possible}.", {
        best: points(best),
        possible: points(possible),
      })
    : left != null && attempts > 0
      ? t(
          "{answers} so far. After {left} more the right answer is shown, and your points stay at the best before it: {best} of {possible}.",
          {
            answers: t("{n} different answer | {n} different answers", { n: attempts }),
            left,
            best: points(best),
            possible: points(possible),
          },
        )
      : null;
  return text ? h("p", { class: `standing-line ${open ? "is-open" : ""}` }, text) : null;
}

/** The points of a verdict in words, or that they are told later. */
export function pointsOf(verdict: GradedSubmission): string {
  return verdict.earned == null
    ? t("Results are told later")
    : t("{earned} of {possible} points", {
        earned: points(verdict.earned),
        possible: points(verdict.possible),
      });
}

export function verdictSummary(verdict: GradedSubmission): HTMLElement {
  const score = pointsOf(verdict);
  const [cls, mark, title, text]: [string, IconName, string, string] = !verdict.gradable
    ? [
        "is-invalid",
        "warn",
        t("Not counted yet"),
        t(
          "An answer was sent back, so nothing is judged and no attempt is used. Put it right and check again.",
        ),
      ]
    : verdict.earned == null
      ? [
          "is-held",
          "check",
          t("Handed in"),
          t("It is kept and judged. Your teacher tells the results later."),
        ]
      : verdict.passed
        ? [
            "is-right",
            "check",
            t("Passed: {score}", { score }),
            t("The result is stored. You can still change an answer and check again."),
          ]
        : [
            "is-wrong",
            "dash",
            t("{score} so far", { score }),
            t("Read the remarks at the questions, change what needs it, and check again."),
          ];
  return h(
    "div",
    { class: `summary ${cls}`, role: "status" },
    icon(mark),
    h("div", null, h("p", { class: "summary-title" }, title), h("p", null, text)),
  );
}
