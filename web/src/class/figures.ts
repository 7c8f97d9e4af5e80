// The questions of a lesson in figures, and the small charts that show them: numbers first, bars beside them.
import { api } from "../api/client";
import type { AssignedLesson, LessonFigures, QuestionFigures } from "../api/types";
import { h } from "../core/dom";
import { plural } from "../core/format";
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
export const mistakeName = (name: string): string => (name ? name.replaceAll("-", " ") : "not recognised");

const FLAGS = {
  easy: "easy: first answers earn more than 80 %",
  hard: "hard: first answers earn less than 30 %",
  weak: "weak: it tells little about who is good at the rest",
};

export function flags(figures: QuestionFigures): HTMLElement[] {
  return figures.flags.map((flag) => h("span", { class: "flag", title: FLAGS[flag] }, flag));
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
        place.replaceChildren(problemNotice(error, [{ label: "Try again", run: load }])),
      );
  load();
  return h(
    "section",
    { class: "student-lesson" },
    h(
      "div",
      { class: "section-head" },
      h("h2", null, "The questions"),
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
      h("td", { class: "number" }, `${one.answered} of ${one.asked}`),
      h("td", { class: "number" }, shareBar(one.facility), percent(one.facility)),
      h("td", { class: "number" }, percent(one.facility_best)),
      h("td", { class: "number" }, correlation(one.discrimination)),
      h("td", null, worst ? `${worst.students} × ${mistakeName(worst.name)}` : ""),
      h("td", null, ...flags(one)),
    );
  });
  const head: [string, string][] = [
    ["Question", ""],
    ["Answered", "number"],
    ["First", "number"],
    ["Best", "number"],
    ["Discrimination", "number"],
    ["Most frequent mistake", ""],
    ["", ""],
  ];
  return h(
    "div",
    { class: "table-scroll", tabindex: "0", role: "region", "aria-label": "Questions in figures" },
    h(
      "table",
      { class: "data" },
      h(
        "caption",
        null,
        `${plural(figures.students, "student")} handed in. First and best: the share of the points that first and best answers earn. Discrimination: the correlation of first answers with those to the other questions.`,
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
              : h("td", null, h("span", { class: "visually-hidden" }, "To look at")),
          ),
        ),
      ),
      h("tbody", null, ...rows),
    ),
  );
}
