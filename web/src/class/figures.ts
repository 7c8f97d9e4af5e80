// The questions of a lesson in figures, and the small charts that show them: numbers first, bars beside them.

import { api } from "../api/client";
import type { AssignedLesson, LessonFigures, QuestionFigures } from "../api/types";
import { h } from "../core/dom";
import { t } from "../core/texts";

import { problemNotice, skeleton } from "../ui/notice";

/** A share in percent, or that there is none yet. */
export const percent = (share: number | null | undefined): string =>
  share == null ? "·" : `${Math.round(100 * share)} %`;

/** A correlation, with two decimals. */
export const correlation = (value: number | null | undefined): string =>
  value == null ? "·" : (Math.round(100 * value) / 100 + 0).toFixed(2).replace("-", "−");

/** A bar for a number that stands beside it. */
export function shareBar(share: number | null | undefined): HTMLElement {
  const part = Math.max(0, Math.min(1, share ?? 0));
  return h(
    "span",
    { class: "share", "aria-hidden": "true" },
    h("span", { style: `inline-size:${100 * part}%` }),
  );
}

/** The name of a mistake in words. */
export const mistakeName = (name: string): string => (name ? name.replaceAll("-", " ") : t("not recognised"));

const FLAGS = {
  easy: (): [string, string] => [t("easy"), t("easy: first answers earn more than 80 %")],
  hard: (): [string, string] => [t("hard"), t("hard: first answers earn less than 30 %")],
  weak: (): [string, string] => [t("weak"), t("weak: it tells little about who is good at the rest")],
};

export function flags(figures: QuestionFigures): HTMLElement[] {
  return figures.flags.map((flag) => {
    const [word, title] = FLAGS[flag]();
    return h("span", { class: "flag", title }, word);
  });
}

export function questionHref(slug: string, question: string): string {
  return `/class/lessons/${encodeURIComponent(slug)}/questions/${encodeURIComponent(question)}`;
}

export function figuresSection(lesson: AssignedLesson): HTMLElement {
  const place = h("div", null, skeleton(4));
  const load = (): void =>
    void api
      .figures(lesson.slug)
      .then((figures) => place.replaceChildren(table(figures)))
      .catch((error: unknown) =>
        place.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: load }])),
      );
  load();
  return h(
    "section",
    { class: "student-lesson" },
    h(
      "div",
      { class: "section-head" },
      h("h2", null, t("The questions")),
      h(
        "div",
        { class: "row wrap" },
        h(
          "a",
          { class: "button small", href: api.figuresUrl(lesson.slug, "csv"), download: "questions.csv" },
          "CSV",
        ),
        h(
          "a",
          { class: "button small", href: api.figuresUrl(lesson.slug, "json"), download: "questions.json" },
          "JSON",
        ),
      ),
    ),
    place,
  );
}

function table(figures: LessonFigures): HTMLElement {
  const rows = figures.questions.map((one) => {
    const worst = one.mistakes.find((mistake) => mistake.name !== "");
    return h(
      "tr",
      null,
      h("th", { scope: "row" }, h("a", { href: questionHref(figures.slug, one.id) }, one.id)),
      h("td", { class: "number" }, t("{answered} of {asked}", { answered: one.answered, asked: one.asked })),
      h("td", { class: "number" }, shareBar(one.facility), percent(one.facility)),
      h("td", { class: "number" }, percent(one.facility_best)),
      h("td", { class: "number" }, correlation(one.discrimination)),
      h("td", null, worst ? `${worst.students} × ${mistakeName(worst.name)}` : ""),
      h("td", null, ...flags(one)),
    );
  });
  const head: [string, string][] = [
    [t("Question"), ""],
    [t("Answered"), "number"],
    [t("First"), "number"],
    [t("Best"), "number"],
    [t("Discrimination"), "number"],
    [t("Most frequent mistake"), ""],
    ["", ""],
  ];
  return h(
    "div",
    { class: "table-scroll", tabindex: "0", role: "region", "aria-label": t("Questions in figures") },
    h(
      "table",
      { class: "data" },
      h(
        "caption",
        null,
        t(
          "{students} handed in. First and best: the share of the points that first and best answers earn. Discrimination: the correlation of first answers with those to the other questions.",
          { students: t("{n} student | {n} students", { n: figures.students }) },
        ),
      ),
      h(
        "thead",
        null,
        h(
          "tr",
          null,
          ...head.map(([text, kind]) =>
            text
              ? h("th", { scope: "col", class: kind }, text)
              : h("td", null, h("span", { class: "visually-hidden" }, t("To look at"))),
          ),
        ),
      ),
      h("tbody", null, ...rows),
    ),
  );
}
