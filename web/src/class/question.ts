// A question of the class: how hard it is, which mistakes are made, and by whom.

import { api } from "../api/client";
import type { QuestionAnalysis } from "../api/types";
import { authored, h } from "../core/dom";
import { dateTime, num } from "../core/format";
import { setMaths } from "../core/maths";
import type { Page } from "../core/router";
import { t } from "../core/texts";
import { histogram } from "../lecture/histogram";
import { empty, problemNotice, skeleton } from "../ui/notice";
import { correlation, flags, mistakeName, percent, questionHref, shareBar } from "./figures";

export function questionPage(outlet: HTMLElement, params: string[]): Page {
  const [slug = "", id = ""] = params;
  const root = h("div", { class: "page" }, skeleton(6));
  outlet.append(root);
  const load = async (): Promise<void> => {
    try {
      const found = await api.analysis(slug, id);
      root.replaceChildren(...painted(found));
      await setMaths(root);
    } catch (error) {
      root.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
  return { title: t("Question of the class") };
}

function painted(found: QuestionAnalysis): (HTMLElement | string)[] {
  const { figures } = found;
  const beside = (step: number, text: string): HTMLElement | null => {
    const other = found.questions[found.place - 1 + step];
    return other ? h("a", { class: "button small", href: questionHref(found.lesson, other) }, text) : null;
  };
  const head = [
    h(
      "p",
      null,
      h(
        "a",
        { href: `/class/lessons/${encodeURIComponent(found.lesson)}` },
        `← ${found.number} ${found.title}`,
      ),
    ),
    h(
      "header",
      { class: "page-head row between wrap" },
      h("h1", null, t("Question {place}: {id}", { place: found.place, id: figures.id })),
      h("div", { class: "row" }, beside(-1, t("← Before")), beside(1, t("Next →"))),
    ),
    authored(h("div", { class: "prose" }), found.prompt_html),
  ];
  if (figures.asked === 0)
    return [...head, empty(t("Nobody has handed in yet"), t("Figures appear with the first answers."))];
  return [
    ...head,
    numbers(found),
    ...(figures.kind === "explanation"
      ? [toRead(found)]
      : [mistakes(found), ...choices(found), untilRight(found)]),
    ...drawn(found),
    files(found),
  ];
}

function numbers(found: QuestionAnalysis): HTMLElement {
  const { figures } = found;
  const one = (name: string, value: string, help: string): HTMLElement =>
    h("div", null, h("dt", null, name), h("dd", null, value), h("dd", { class: "help" }, help));
  return h(
    "section",
    { class: "student-lesson" },
    h(
      "div",
      { class: "section-head" },
      h("h2", null, t("In figures")),
      h("div", { class: "row" }, ...flags(figures)),
    ),
    h(
      "dl",
      { class: "figures" },
      one(
        t("Answered"),
        t("{answered} of {asked}", { answered: figures.answered, asked: figures.asked }),
        t("{students} right by now", { students: t("{n} student | {n} students", { n: figures.right }) }),
      ),
      one(t("First answers"), percent(figures.facility), t("of the points, on average")),
      one(t("Best answers"), percent(figures.facility_best), t("of the points, on average")),
      one(
        t("Discrimination"),
        correlation(figures.discrimination),
        t("correlation with the other questions"),
      ),
      one(t("Upper less lower"), percent(figures.upper_less_lower), t("best 27 % less worst 27 %")),
      found.almost == null
        ? null
        : one(t("Almost right"), String(found.almost), t("students, within three tolerances")),
      one(t("Sent back"), String(found.sent_back), t("students, with an answer to correct")),
    ),
    figures.answered < 10
      ? h(
          "p",
          { class: "help" },
          t("Fewer than ten students have answered: these figures are mostly chance."),
        )
      : null,
  );
}

function mistakes(found: QuestionAnalysis): HTMLElement {
  const items = found.mistakes.map((mistake) => h("li", null, behind(mistake, found)));
  return h(
    "section",
    { class: "student-lesson" },
    h("h2", null, t("Mistakes")),
    items.length === 0
      ? h("p", { class: "help" }, t("Nobody has answered wrongly."))
      : h("ul", { class: "mistakes" }, ...items),
  );
}

/** A mistake, and at a press what was told and who made it: no name stands on the page before. */
function behind(mistake: QuestionAnalysis["mistakes"][number], found: QuestionAnalysis): HTMLElement {
  const { answered } = found.figures;
  const option = found.choices.find((one) => one.id === mistake.name);
  const name = option ? `${option.id}: ${optionText(option)}` : mistakeName(mistake.name);
  const mended = mistake.students - mistake.still;
  const rows = mistake.answers.map((one) =>
    h(
      "tr",
      null,
      h("th", { scope: "row" }, h("a", { href: `/class/${encodeURIComponent(one.person)}` }, one.name)),
      h("td", null, one.answer || t("none")),
      h("td", null, dateTime(one.at)),
      h("td", null, one.mended ? t("right by now") : ""),
    ),
  );
  const head = [t("Student"), t("Answer"), t("Handed in"), t("Since")];
  return h(
    "details",
    null,
    h(
      "summary",
      null,
      h("span", { class: "count" }, t("{students} of {answered}", { students: mistake.students, answered })),
      h("span", null, name),
      shareBar(mistake.students / Math.max(1, answered)),
    ),
    h(
      "div",
      { class: "stack" },
      h(
        "p",
        { class: "help" },
        t(
          "{n} student has answered otherwise since. The first of them was told: | {n} students have answered otherwise since. The first of them was told:",
          { n: mended },
        ),
      ),
      authored(h("blockquote", { class: "verdict-text" }), mistake.told_html),
      h(
        "div",
        {
          class: "table-scroll",
          tabindex: "0",
          role: "region",
          "aria-label": t("Answers: {name}", { name }),
        },
        h(
          "table",
          { class: "data" },
          h("thead", null, h("tr", null, ...head.map((text) => h("th", { scope: "col" }, text)))),
          h("tbody", null, ...rows),
        ),
      ),
    ),
  );
}

/** Where explanations are read: no program judges them. */
const toRead = (found: QuestionAnalysis): HTMLElement =>
  h(
    "p",
    { class: "student-lesson" },
    t("No program judges explanations."),
    " ",
    h(
      "a",
      { href: `/class/lessons/${encodeURIComponent(found.lesson)}#said` },
      t("Read them and give their points"),
    ),
  );

const optionText = (one: QuestionAnalysis["choices"][number]): string =>
  authored(h("span"), one.html).textContent || one.id;

function choices(found: QuestionAnalysis): HTMLElement[] {
  if (found.choices.length === 0) return [];
  const names = found.choices.map(optionText);
  const right = found.choices.findIndex((one) => one.right);
  const counts = (which: "first" | "last"): HTMLElement =>
    h(
      "div",
      null,
      h("h3", null, which === "first" ? t("First answers") : t("Last answers")),
      histogram(names, { counts: found.choices.map((one) => one[which]), right, revealed: true }),
    );
  return [
    h(
      "section",
      { class: "student-lesson" },
      h("h2", null, t("What was chosen")),
      h("div", { class: "side-by-side" }, counts("first"), counts("last")),
    ),
  ];
}

function untilRight(found: QuestionAnalysis): HTMLElement {
  const { until_right, answered, right } = found.figures;
  const names = [
    t("1 answer"),
    t("2 answers"),
    t("3 answers"),
    t("4 answers"),
    t("5 or more"),
    t("not right yet"),
  ];
  return h(
    "section",
    { class: "student-lesson" },
    h("h2", null, t("Different answers until all points")),
    histogram(
      names,
      { counts: [...until_right, answered - right], right: null, revealed: false },
      undefined,
      (n) => t("{n} student | {n} students", { n }),
    ),
  );
}

function drawn(found: QuestionAnalysis): HTMLElement[] {
  if (found.drawn.length === 0) return [];
  const rows = found.drawn.map((one) =>
    h(
      "tr",
      null,
      h("th", { scope: "row" }, one.name),
      h("td", { class: "number" }, `${percent(one.below[1])} (${one.below[0]})`),
      h("td", { class: "number" }, num(one.border, 4)),
      h("td", { class: "number" }, `${percent(one.above[1])} (${one.above[0]})`),
      h("td", { class: "number" }, correlation(one.deviations)),
      h("td", null, one.unequal ? h("span", { class: "flag" }, t("not equally hard")) : ""),
    ),
  );
  return [
    h(
      "section",
      { class: "student-lesson" },
      h("h2", null, t("Whether all numbers are equally hard")),
      h(
        "div",
        {
          class: "table-scroll",
          tabindex: "0",
          role: "region",
          "aria-label": t("Whether all numbers are equally hard"),
        },
        h(
          "table",
          { class: "data" },
          h(
            "caption",
            null,
            t(
              "Each student has numbers of their own. First answers of those who drew a small one, and of those who drew a large one; more than three standard errors between them are more than chance.",
            ),
          ),
          h(
            "thead",
            null,
            h(
              "tr",
              null,
              h("th", { scope: "col" }, t("Number")),
              ...[t("Below (students)"), t("Border"), t("From there (students)"), t("Standard errors")].map(
                (text) => h("th", { scope: "col", class: "number" }, text),
              ),
              h("td", null, h("span", { class: "visually-hidden" }, t("To look at"))),
            ),
          ),
          h("tbody", null, ...rows),
        ),
      ),
    ),
  ];
}

function files(found: QuestionAnalysis): HTMLElement {
  const { lesson, figures } = found;
  return h(
    "p",
    { class: "row wrap student-lesson" },
    h(
      "a",
      { class: "button small", href: api.answersUrl(lesson, figures.id), download: "answers.csv" },
      t("All answers as CSV"),
    ),
    h(
      "a",
      { class: "button small", href: api.analysisUrl(lesson, figures.id), download: "question.json" },
      t("This page as JSON"),
    ),
  );
}
