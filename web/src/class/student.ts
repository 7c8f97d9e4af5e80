// One student, for those who teach: every attempt with its verdict, and decisions about what counts.

import { api } from "../api/client";
import type { GradeTable, KeptSubmission, PersonRecord, Reached } from "../api/types";
import { h } from "../core/dom";
import { dateTime, points } from "../core/format";
import { setMaths } from "../core/maths";
import type { Page } from "../core/router";
import { t } from "../core/texts";
import { pointsOf, verdictLine } from "../exercise/verdict";
import { dialog } from "../ui/dialog";
import { empty, problemNotice, skeleton } from "../ui/notice";
import { remarksList } from "./record";
import { renewWords } from "./words";

export function studentPage(outlet: HTMLElement, params: string[]): Page {
  const id = params[0] ?? "";
  const root = h("div", { class: "page" }, skeleton(6));
  outlet.append(root);
  const load = async (): Promise<void> => {
    try {
      const [grades, submissions, record] = await Promise.all([
        api.standings(),
        api.submissionsOf(id),
        api.recordOf(id),
      ]);
      paint(root, id, grades, submissions, record, () => void load());
      await setMaths(root);
    } catch (error) {
      root.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
  return { title: t("Student") };
}

function paint(
  root: HTMLElement,
  id: string,
  grades: GradeTable,
  submissions: KeptSubmission[],
  record: PersonRecord,
  again: () => void,
): void {
  const student = grades.students.find((row) => row.id === id);
  const words = h("button", { type: "button", class: "button small" }, t("New words"));
  words.addEventListener("click", () => renewWords(id, student?.name ?? ""));
  const touched = grades.lessons.filter(
    (lesson) => student?.lessons[lesson.slug] || submissions.some((one) => one.lesson === lesson.slug),
  );
  root.replaceChildren(
    h("p", null, h("a", { href: "/class" }, t("← Class"))),
    h(
      "header",
      { class: "page-head row between" },
      h("h1", null, student?.name ?? t("Somebody of the class")),
      words,
    ),
    touched.length === 0
      ? empty(t("Nothing handed in yet"), t("Attempts appear here as soon as there are any."))
      : h("div"),
    ...touched.map((lesson) => {
      const reached = student?.lessons[lesson.slug];
      const change = h("button", { type: "button", class: "button small" }, t("Change what counts"));
      change.addEventListener("click", () => decide(id, lesson, reached, again));
      const remark = h("button", { type: "button", class: "button small" }, t("Write to the student"));
      remark.addEventListener("click", () => write(id, lesson, again));
      const own = submissions.filter((one) => one.lesson === lesson.slug);
      return h(
        "section",
        { class: "student-lesson" },
        h(
          "div",
          { class: "section-head" },
          h("h2", null, `${lesson.number} ${lesson.title}`),
          h("p", null, standing(reached, lesson.possible), " ", change, " ", remark),
        ),
        told(record, lesson.slug),
        h("ol", { class: "history-list", reversed: true }, ...own.map(attempt)),
      );
    }),
  );
}

/** What was allowed, decided, said and regraded. */
function told(record: PersonRecord, slug: string): HTMLElement | null {
  const own = record.lessons.find((lesson) => lesson.slug === slug);
  return own ? remarksList(own) : null;
}

function write(id: string, lesson: GradeTable["lessons"][number], again: () => void): void {
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

const standing = (reached: Reached | undefined, possible: number): string =>
  reached
    ? t("{points} of {possible}{earned}, {attempts}", {
        points: points(reached.points),
        possible: points(possible),
        earned: reached.decided ? ` (${t("earned {earned}", { earned: points(reached.earned) })})` : "",
        attempts: t("{n} attempt | {n} attempts", { n: reached.attempts }),
      })
    : t("nothing counts yet");

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
          h("p", { class: "help" }, t("Answer:"), " ", shown(one, question.id)),
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
  const value =
    answer.choice ?? (typeof answer.value === "object" ? JSON.stringify(answer.value) : answer.value);
  return [value, answer.unit].filter((part) => part !== undefined && part !== null).join(" ") || t("none");
}

function decide(
  id: string,
  lesson: GradeTable["lessons"][number],
  reached: Reached | undefined,
  again: () => void,
): void {
  const amount = h("input", {
    id: "decide-points",
    class: "field number",
    type: "number",
    min: "0",
    max: String(lesson.possible),
    step: "any",
    value: String(reached?.points ?? 0),
  });
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
      reached?.decided ? back : null,
    ),
  );
  const box = dialog(lesson.title, form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    send(Number(amount.value));
  });
}
