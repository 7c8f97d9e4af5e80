// Everything that is kept of a student's own work: what counts and why, every verdict, what was decided and regraded.

import { api } from "../api/client";
import type { GradedSubmission, LessonRecord } from "../api/types";
import { h } from "../core/dom";
import { dateTime, points } from "../core/format";
import { setMaths } from "../core/maths";
import type { Page } from "../core/router";
import { listed, t } from "../core/texts";
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
        h("header", { class: "page-head" }, h("h1", null, t("Your work"))),
        record.lessons.length === 0
          ? empty(t("Nothing yet"), t("What you hand in appears here, with what it counts and why."))
          : h("div"),
        ...record.lessons.map((lesson) => ofLesson(lesson, submissions, () => void load())),
        h(
          "p",
          null,
          h("a", { href: "/api/v1/me/data", download: "my-data.json" }, t("A copy of all your data")),
        ),
      );
      await setMaths(root);
    } catch (error) {
      root.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
  return { title: t("Your work") };
}

function ofLesson(lesson: LessonRecord, submissions: GradedSubmission[], again: () => void): HTMLElement {
  const own = submissions.filter((one) => one.lesson === lesson.slug);
  const ask = h("button", { type: "button", class: "button small" }, t("Ask for a look again"));
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
      lesson.asked
        ? h("p", { class: "help" }, t("You asked for a look again."))
        : own.length > 0
          ? ask
          : null,
    ),
    standingText(lesson),
    remarksList(lesson),
    h("ol", { class: "history-list", reversed: true }, ...own.map((one) => attempt(one, lesson))),
  );
}

const PHASES: Record<LessonRecord["standing"]["phase"], () => string> = {
  not_open: () => t("Not open yet"),
  open: () => t("Open"),
  late: () => t("Late"),
  practice: () => t("For practice: it earns nothing any more"),
  closed: () => t("Closed"),
};

const percent = (share: number): string => `${points(100 * share)} %`;

/** Dates, attempts and points in words. */
export function standingText(lesson: LessonRecord): HTMLElement {
  const { standing, possible } = lesson;
  const score = standing.points;
  const parts = [
    score
      ? [
          t("{points} of {possible} points count", {
            points: points(score.points),
            possible: points(possible),
          }),
          score.passed ? t("passed") : "",
          score.late ? t("handed in late") : "",
        ]
          .filter(Boolean)
          .join(", ")
      : t("Results are told later"),
    PHASES[standing.phase](),
    standing.phase === "not_open" && lesson.opens
      ? t("opens {opens}", { opens: dateTime(lesson.opens) })
      : "",
    standing.due ? t("due {due}", { due: dateTime(standing.due) }) : "",
    standing.closes ? t("closes {closes}", { closes: dateTime(standing.closes) }) : "",
    t("{n} attempt | {n} attempts", { n: standing.attempts }),
    standing.attempts_left == null
      ? ""
      : t("{attempts_left} left", { attempts_left: standing.attempts_left }),
    standing.worth < 1 && standing.phase !== "closed"
      ? t("the next counts {worth}", { worth: percent(standing.worth) })
      : "",
    standing.next_attempt
      ? t("the next from {next_attempt}", { next_attempt: dateTime(standing.next_attempt) })
      : "",
  ];
  return h("p", null, `${parts.filter(Boolean).join(" · ")}.`);
}

/** What was allowed, decided, said and regraded. */
export function remarksList(lesson: LessonRecord): HTMLElement {
  const line = (when: string, who: string, text: string): { when: number; item: HTMLElement } => ({
    when: Date.parse(when),
    item: h("li", null, h("time", { datetime: when }, dateTime(when)), ` ${who}: ${text}`),
  });
  const { extension } = lesson;
  const allowed = extension
    ? [
        extension.until ? t("until {until}", { until: dateTime(extension.until) }) : "",
        extension.attempts ? t("{n} more attempt | {n} more attempts", { n: extension.attempts }) : "",
      ]
    : [];
  const kinds = {
    points: t("decided"),
    mark: t("read"),
    comment: t("wrote"),
    request: t("asked"),
  } as Record<string, string>;
  const items = [
    extension
      ? line(
          extension.at,
          extension.by,
          t("allowed {allowed}. {reason}", {
            allowed: listed(allowed.filter(Boolean)),
            reason: extension.reason,
          }),
        )
      : null,
    ...lesson.remarks.map((one) =>
      line(one.at, `${one.by} ${kinds[one.kind] ?? ""}`, `${counts(one)}${one.text}`),
    ),
    ...lesson.regrades.map((one) =>
      line(
        one.at,
        t("{by} regraded", { by: one.by }),
        `${one.reason}${one.points ? ` (${t("{before} → {after} points", { before: points(one.points[0]), after: points(one.points[1]) })})` : ""}${one.undone ? `; ${t("taken back {undone}", { undone: dateTime(one.undone) })}` : ""}`,
      ),
    ),
  ].filter((item) => item !== null);
  // In the order in which it was said: what was decided after a regrade stands after it.
  items.sort((a, b) => a.when - b.when);
  return h("ul", { class: "remarks", hidden: items.length === 0 }, ...items.map(({ item }) => item));
}

/** What a remark decides, before its words. */
function counts({ question, points: given }: LessonRecord["remarks"][number]): string {
  if (question == null)
    return given == null ? "" : `${t("{points} points count.", { points: points(given) })} `;
  return given == null
    ? `${t("The explanation {question} waits again.", { question })} `
    : `${t("{points} points for the explanation {question}.", { points: points(given), question })} `;
}

function attempt(one: GradedSubmission, lesson: LessonRecord): HTMLElement {
  const credit = lesson.standing.points?.credits.find((credit) => credit.id === one.id);
  const counts =
    credit && credit.points !== credit.earned
      ? t("counts {points}: {on_time} at that time, {of_attempt} as attempt {attempt}", {
          points: points(credit.points),
          on_time: percent(credit.on_time),
          of_attempt: percent(credit.of_attempt),
          attempt: credit.attempt,
        })
      : "";
  const before = h("div");
  const details = h(
    "details",
    { class: "history-entry" },
    h(
      "summary",
      null,
      h("span", { class: "standing" }, one.gradable ? pointsOf(one) : t("Kept, not judged")),
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
        h("h3", null, t("As it was told before")),
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
    h("label", { for: "ask-text" }, t("What should your teacher look at?")),
    text,
    wrong,
    h("div", { class: "row" }, h("button", { class: "button primary" }, t("Ask"))),
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
