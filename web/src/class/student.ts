// One student, for those who teach: every attempt with its verdict, and decisions about what counts.

import { api } from "../api/client";
import type { KeptSubmission, LessonRecord, PersonRecord } from "../api/types";
import { h } from "../core/dom";
import { dateTime, points, typedNumber } from "../core/format";
import { setMaths } from "../core/maths";
import type { Page } from "../core/router";
import { t } from "../core/texts";
import { pointsOf, verdictLine } from "../exercise/verdict";
import { dialog } from "../ui/dialog";
import { empty, problemNotice, skeleton } from "../ui/notice";
import { numberField } from "./policy-fields";
import { remarksList } from "./record";
import { renewWords } from "./words";

export function studentPage(outlet: HTMLElement, params: string[]): Page {
  const id = params[0] ?? "";
  const root = h("div", { class: "page" }, skeleton(6));
  outlet.append(root);
  const load = async (): Promise<void> => {
    try {
      const [submissions, record] = await Promise.all([api.submissionsOf(id), api.recordOf(id)]);
      paint(root, submissions, record, () => void load());
      await setMaths(root);
      if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
    } catch (error) {
      root.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
  return { title: t("Student") };
}

function paint(
  root: HTMLElement,
  submissions: KeptSubmission[],
  record: PersonRecord,
  again: () => void,
): void {
  const { id, name } = record;
  const words = h("button", { type: "button", class: "button small" }, t("New words"));
  words.addEventListener("click", () => renewWords(id, name));
  const touched = record.lessons.filter(
    (lesson) =>
      has(lesson) ||
      lesson.remarks.length > 0 ||
      lesson.extension ||
      submissions.some((one) => one.lesson === lesson.slug),
  );
  root.replaceChildren(
    h("p", null, h("a", { href: "/class" }, t("← Class"))),
    h("header", { class: "page-head row between" }, h("h1", null, name), words),
    touched.length === 0
      ? empty(t("Nothing handed in yet"), t("Attempts appear here as soon as there are any."))
      : h("div"),
    ...touched.map((lesson) => {
      const change = h("button", { type: "button", class: "button small" }, t("Change what counts"));
      change.addEventListener("click", () => decide(id, lesson, again));
      const remark = h("button", { type: "button", class: "button small" }, t("Write to the student"));
      remark.addEventListener("click", () => write(id, lesson, again));
      const own = submissions.filter((one) => one.lesson === lesson.slug);
      return h(
        "section",
        { class: "student-lesson", id: lesson.slug },
        h(
          "div",
          { class: "section-head is-stacked" },
          h("h2", null, `${lesson.number} ${lesson.title}`),
          h("p", null, standing(lesson), " ", change, " ", remark),
        ),
        remarksList(lesson),
        h("ol", { class: "history-list", reversed: true }, ...own.map(attempt)),
      );
    }),
  );
}

function write(id: string, lesson: LessonRecord, again: () => void): void {
  const text = h("textarea", { id: "remark", class: "field", required: true, maxlength: "2000", rows: "4" });
  const wrong = h("div", { "aria-live": "polite" });
  const form = h(
    "form",
    { class: "stack" },
    h("label", { for: "remark" }, t("What the student reads")),
    text,
    wrong,
    h("div", { class: "row" }, h("button", { class: "button primary" }, t("Send"))),
  );
  const box = dialog(lesson.title, form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    api
      .comment(id, lesson.slug, text.value)
      .then(() => {
        box.close();
        again();
      })
      .catch((error: unknown) => wrong.replaceChildren(problemNotice(error)));
  });
}

/** Whether anything counts, or could. */
const has = ({ standing: { attempts, points: score } }: LessonRecord): boolean =>
  attempts > 0 || score?.decided != null || (score?.points ?? 0) > 0;

function standing(lesson: LessonRecord): string {
  const { attempts, points: score } = lesson.standing;
  if (!score || !has(lesson)) return t("nothing counts yet");
  return t("{points} of {possible}{earned}, {attempts}", {
    points: points(score.points),
    possible: points(lesson.possible),
    earned: score.decided ? ` (${t("earned {earned}", { earned: points(score.earned) })})` : "",
    attempts: t("{n} attempt | {n} attempts", { n: attempts }),
  });
}

function attempt(one: KeptSubmission): HTMLElement {
  const head = one.gradable ? pointsOf(one) : t("Kept, not judged");
  return h(
    "li",
    null,
    h(
      "details",
      { class: "history-entry" },
      h(
        "summary",
        null,
        h("span", { class: "standing" }, head),
        h("time", { datetime: one.submitted_at }, dateTime(one.submitted_at)),
      ),
      ...one.questions.map((question) =>
        h(
          "div",
          { class: "history-question" },
          h("p", { class: "history-label" }, question.id),
          h("p", { class: "help answer" }, t("Answer:"), " ", shown(one, question.id)),
          verdictLine(question),
        ),
      ),
    ),
  );
}

function shown(one: KeptSubmission, question: string): HTMLElement | string {
  const answer = one.answers[question];
  if (!answer) return t("none");
  if (answer.file)
    return h(
      "a",
      { href: api.fileUrl(one.id, question), download: "answer.txt" },
      t("a file of {bytes} bytes", { bytes: answer.file.bytes }),
    );
  if (answer.settings) return JSON.stringify(answer.settings);
  const value = answer.choice ?? (answer.value == null ? answer.value : typed(answer.value));
  return [value, answer.unit].filter((part) => part !== undefined && part !== null).join(" ") || t("none");
}

/** What was typed: components in brackets, the rows of a matrix in brackets of their own. */
function typed(value: unknown): string {
  return Array.isArray(value) ? `(${value.map(typed).join(", ")})` : String(value);
}

function decide(id: string, lesson: LessonRecord, again: () => void): void {
  const score = lesson.standing.points;
  // Without the last digits that doubles add.
  const now = String(Number((score?.points ?? 0).toPrecision(15)));
  const amount = numberField(now, { low: 0, high: lesson.possible });
  amount.id = "decide-points";
  amount.required = true;
  const reason = h("textarea", {
    id: "decide-reason",
    class: "field",
    required: true,
    maxlength: "2000",
    rows: "3",
  });
  const wrong = h("div", { "aria-live": "polite" });
  const send = (value: number | null): void => {
    api
      .decide(id, { lesson: lesson.slug, points: value, reason: reason.value })
      .then(() => {
        box.close();
        again();
      })
      .catch((error: unknown) => wrong.replaceChildren(problemNotice(error)));
  };
  const back = h("button", { type: "button", class: "button" }, t("Count what was earned"));
  back.addEventListener("click", () => send(null));
  const form = h(
    "form",
    { class: "stack" },
    h(
      "label",
      { for: "decide-points" },
      t("Points that count, of {possible}", { possible: points(lesson.possible) }),
    ),
    amount,
    h("label", { for: "decide-reason" }, t("Why")),
    reason,
    wrong,
    h(
      "div",
      { class: "row" },
      h("button", { class: "button primary" }, t("Save")),
      score?.decided ? back : null,
    ),
  );
  const box = dialog(lesson.title, form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    send(typedNumber(amount.value));
  });
}
