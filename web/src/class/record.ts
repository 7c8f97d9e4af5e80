// Everything that is kept of a student's own work: what counts and why, every verdict, what was decided and regraded.
import { api } from "../api/client";
import type { GradedSubmission, LessonRecord } from "../api/types";
import { h } from "../core/dom";
import { dateTime, plural, points } from "../core/format";
import { setMaths } from "../core/maths";
import type { Page } from "../core/router";
import { pointsOf, verdictLine } from "../exercise/verdict";
import { dialog } from "../ui/dialog";
import { empty, problemNotice, skeleton } from "../ui/notice";

export function recordPage(outlet: HTMLElement): Page {
  const root = h("div", { class: "page" }, skeleton(6));
  outlet.append(root);
  const load = async (): Promise<void> => {
    try {
      const [record, submissions] = await Promise.all([
        api.record(),
        api.submissions({ student: "", limit: 1000 }),
      ]);
      root.replaceChildren(
        h("header", { class: "page-head" }, h("h1", null, "Your work")),
        record.lessons.length === 0
          ? empty("Nothing yet", "What you hand in appears here, with what it counts and why.")
          : h("div"),
        ...record.lessons.map((lesson) => ofLesson(lesson, submissions, () => void load())),
        h(
          "p",
          null,
          h("a", { href: "/api/v1/me/data", download: "my-data.json" }, "A copy of all your data"),
        ),
      );
      await setMaths(root);
    } catch (error) {
      root.replaceChildren(problemNotice(error, [{ label: "Try again", run: () => void load() }]));
    }
  };
  void load();
  return { title: "Your work" };
}

function ofLesson(lesson: LessonRecord, submissions: GradedSubmission[], again: () => void): HTMLElement {
  const own = submissions.filter((one) => one.lesson === lesson.slug);
  const ask = h("button", { type: "button", class: "button small" }, "Ask for a look again");
  ask.addEventListener("click", () => askAgain(lesson, again));
  return h(
    "section",
    { class: "student-lesson" },
    h(
      "div",
      { class: "section-head" },
      h(
        "h2",
        null,
        h("a", { href: `/lessons/${encodeURIComponent(lesson.slug)}` }, `${lesson.number} ${lesson.title}`),
      ),
      lesson.asked ? h("p", { class: "help" }, "You asked for a look again.") : own.length > 0 ? ask : null,
    ),
    standingText(lesson),
    remarksList(lesson),
    h("ol", { class: "history-list", reversed: true }, ...own.map((one) => attempt(one, lesson))),
  );
}

const PHASES: Record<LessonRecord["standing"]["phase"], string> = {
  not_open: "Not open yet",
  open: "Open",
  late: "Late",
  practice: "For practice: it earns nothing any more",
  closed: "Closed",
};

const percent = (share: number): string => `${points(100 * share)} %`;

/** Dates, attempts and points in words. */
export function standingText(lesson: LessonRecord): HTMLElement {
  const { standing, possible } = lesson;
  const score = standing.points;
  const parts = [
    score
      ? `${points(score.points)} of ${points(possible)} points count${score.passed ? ", passed" : ""}${score.late ? ", handed in late" : ""}`
      : "Results are told later",
    PHASES[standing.phase],
    standing.phase === "not_open" && lesson.opens ? `opens ${dateTime(lesson.opens)}` : "",
    standing.due ? `due ${dateTime(standing.due)}` : "",
    standing.closes ? `closes ${dateTime(standing.closes)}` : "",
    plural(standing.attempts, "attempt"),
    standing.attempts_left == null ? "" : `${standing.attempts_left} left`,
    standing.worth < 1 && standing.phase !== "closed" ? `the next counts ${percent(standing.worth)}` : "",
    standing.next_attempt ? `the next from ${dateTime(standing.next_attempt)}` : "",
  ];
  return h("p", null, `${parts.filter(Boolean).join(" · ")}.`);
}

/** What was allowed, decided, said and regraded. */
export function remarksList(lesson: LessonRecord): HTMLElement {
  const line = (when: string, who: string, text: string): HTMLElement =>
    h("li", null, h("time", { datetime: when }, dateTime(when)), ` ${who}: ${text}`);
  const { extension } = lesson;
  const allowed = extension
    ? [
        extension.until ? `until ${dateTime(extension.until)}` : "",
        extension.attempts ? plural(extension.attempts, "more attempt") : "",
      ]
    : [];
  const kinds = { points: "decided", comment: "wrote", request: "asked" } as Record<string, string>;
  const items = [
    extension
      ? line(
          extension.at,
          extension.by,
          `allowed ${allowed.filter(Boolean).join(" and ")}. ${extension.reason}`,
        )
      : null,
    ...lesson.remarks.map((one) =>
      line(
        one.at,
        `${one.by} ${kinds[one.kind] ?? ""}`,
        `${one.points == null ? "" : `${points(one.points)} points count. `}${one.text}`,
      ),
    ),
    ...lesson.regrades.map((one) =>
      line(
        one.at,
        `${one.by} regraded`,
        `${one.reason}${one.points ? ` (${points(one.points[0])} → ${points(one.points[1])} points)` : ""}${one.undone ? `; taken back ${dateTime(one.undone)}` : ""}`,
      ),
    ),
  ].filter((item) => item !== null);
  return h("ul", { class: "remarks", hidden: items.length === 0 }, ...items);
}

function attempt(one: GradedSubmission, lesson: LessonRecord): HTMLElement {
  const credit = lesson.standing.points?.credits.find((credit) => credit.id === one.id);
  const counts =
    credit && credit.points !== credit.earned
      ? `counts ${points(credit.points)}: ${percent(credit.on_time)} at that time, ${percent(credit.of_attempt)} as attempt ${credit.attempt}`
      : "";
  const before = h("div");
  const details = h(
    "details",
    { class: "history-entry" },
    h(
      "summary",
      null,
      h("span", { class: "standing" }, one.gradable ? pointsOf(one) : "Kept, not judged"),
      h("time", { datetime: one.submitted_at }, dateTime(one.submitted_at)),
      h("span", { class: "history-right" }, counts),
    ),
    ...one.questions.map((question) =>
      h(
        "div",
        { class: "history-question" },
        h("p", { class: "history-label" }, question.id),
        verdictLine(question),
      ),
    ),
    before,
  );
  details.addEventListener("toggle", () => {
    if (!details.open || lesson.regrades.length === 0 || before.childElementCount > 0) return;
    void api.verdicts(one.id).then((all) => {
      const earlier = all.slice(0, -1);
      if (earlier.length === 0) return;
      before.append(
        h("h3", null, "As it was told before"),
        ...earlier.map((given) => h("p", null, `${dateTime(given.at)}: ${pointsOf(given.verdict)}`)),
      );
    });
    void setMaths(details);
  });
  return h("li", null, details);
}

function askAgain(lesson: LessonRecord, again: () => void): void {
  const text = h("textarea", {
    id: "ask-text",
    class: "field",
    required: true,
    maxlength: "2000",
    rows: "4",
  });
  const wrong = h("div", { "aria-live": "polite" });
  const form = h(
    "form",
    { class: "stack" },
    h("label", { for: "ask-text" }, "What should your teacher look at?"),
    text,
    wrong,
    h("div", { class: "row" }, h("button", { class: "button primary" }, "Ask")),
  );
  const box = dialog(lesson.title, form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    api
      .askAgain(lesson.slug, text.value)
      .then(() => {
        box.close();
        again();
      })
      .catch((error: unknown) => wrong.replaceChildren(problemNotice(error)));
  });
}
