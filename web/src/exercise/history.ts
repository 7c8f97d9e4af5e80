// All submissions of one student to one lesson, from the server: they survive a reload.

import { api } from "../api/client";
import type { GradedSubmission, Lesson } from "../api/types";
import { h } from "../core/dom";
import { dateTime } from "../core/format";
import { setMaths } from "../core/maths";
import { student } from "../core/prefs";
import { t } from "../core/texts";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import { pointsOf, verdictLine } from "./verdict";

export interface HistoryList {
  root: HTMLElement;
  load: () => Promise<void>;
  add: (verdict: GradedSubmission) => void;
}

export function historyList(lesson: Lesson): HistoryList {
  const root = h("section", { class: "history", "aria-label": t("Your submissions"), hidden: true });
  let verdicts: GradedSubmission[] = [];

  const paint = (): void => {
    root.hidden = verdicts.length === 0;
    root.replaceChildren(
      h("h3", null, t("Your submissions ({verdicts})", { verdicts: verdicts.length })),
      h(
        "ol",
        { class: "history-list", reversed: true },
        ...verdicts.map((verdict) => entry(lesson, verdict)),
      ),
    );
  };

  return {
    root,
    load: async () => {
      const who = student.get();
      if (!who) {
        verdicts = [];
        paint();
        return;
      }
      try {
        const stored = await api.submissions({ student: who, lesson: lesson.slug });
        if (who !== student.get()) return;
        // A verdict that arrived while the list was on its way is kept.
        const fresh = verdicts.filter(
          (verdict) => verdict.student === who && !stored.some((other) => other.id === verdict.id),
        );
        verdicts = [...fresh, ...stored];
        verdicts.sort((a, b) => b.submitted_at.localeCompare(a.submitted_at));
        paint();
      } catch (error) {
        root.hidden = false;
        root.replaceChildren(h("h3", null, t("Your submissions")), problemNotice(error));
      }
    },
    add: (verdict) => {
      if (verdicts.some((before) => before.id === verdict.id)) return;
      verdicts.unshift(verdict);
      paint();
    },
  };
}

function entry(lesson: Lesson, verdict: GradedSubmission): HTMLElement {
  const right = verdict.questions.filter((question) => question.verdict === "right").length;
  const details = h(
    "details",
    { class: "history-entry" },
    h(
      "summary",
      null,
      h(
        "span",
        { class: `standing ${verdict.passed ? "is-right" : "is-open"}` },
        icon(verdict.passed ? "check" : "dash"),
        verdict.gradable ? pointsOf(verdict) : t("Kept, not judged"),
      ),
      h("time", { datetime: verdict.submitted_at }, dateTime(verdict.submitted_at)),
      h(
        "span",
        { class: "history-right" },
        verdict.earned == null
          ? `${t("{n} question | {n} questions", { n: verdict.questions.length })}`
          : verdict.gradable
            ? t("{right} of {questions} right", {
                right,
                questions: t("{n} question | {n} questions", { n: verdict.questions.length }),
              })
            : t("an answer could not be read; no attempt used"),
      ),
    ),
  );
  details.addEventListener("toggle", () => {
    if (!details.open || details.childElementCount > 1) return;
    const places = new Map(lesson.exercise.questions.map((question, at) => [question.id, at + 1]));
    details.append(
      ...verdict.questions.map((question) =>
        h(
          "div",
          { class: "history-question" },
          h(
            "p",
            { class: "history-label" },
            t("Question {place}", { place: places.get(question.id) ?? question.id }),
          ),
          verdictLine(question),
        ),
      ),
    );
    if (verdict.provenance?.engine) {
      details.append(
        h(
          "p",
          { class: "provenance" },
          t("Graded by engine {engine}", { engine: verdict.provenance.engine }),
          verdict.provenance.lesson_hash
            ? `, ${t("lesson {hash}", { hash: verdict.provenance.lesson_hash.slice(0, 12) })}`
            : "",
        ),
      );
    }
    void setMaths(details);
  });
  return h("li", null, details);
}
