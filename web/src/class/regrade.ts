// Grading again what was handed in to a lesson: look first, then apply, then perhaps take it back.

import { api } from "../api/client";
import type { AppliedRegrade, AssignedLesson, GradedSubmission, RegradePreview } from "../api/types";
import { h } from "../core/dom";
import { dateTime, points } from "../core/format";
import { setMaths } from "../core/maths";
import { listed, t } from "../core/texts";
import { pointsOf, verdictLine } from "../exercise/verdict";
import { dialog } from "../ui/dialog";
import { problemNotice } from "../ui/notice";
import { mistakeName } from "./figures";

/** For whom the new verdicts count. */
const CHOICES: Record<string, () => string> = {
  better: () => t("those who do not lose by it"),
  replace: () => t("everybody"),
};

/** How often the page asks how far a preview is, ms. */
const ASKED_EVERY_MS = 300;

export function regradeSection(lesson: AssignedLesson): HTMLElement {
  const seen = h("div", { class: "regrade-seen", "aria-live": "polite" });
  const before = h("div");
  const look = h("button", { type: "button", class: "button" }, t("Grade again and look"));
  const failed = (error: unknown): void => seen.replaceChildren(problemNotice(error));
  const list = (): void =>
    void api
      .regrades()
      .then((all) => before.replaceChildren(applied(all, lesson, list, failed)))
      .catch(failed);
  look.addEventListener("click", () => {
    look.disabled = true;
    const shown = underWay(lesson.slug);
    seen.replaceChildren(shown.root);
    api
      .previewRegrade(lesson.slug)
      .then((preview) => seen.replaceChildren(result(preview, list, seen)))
      .catch(failed)
      .finally(() => {
        shown.end();
        look.disabled = false;
      });
  });
  list();
  return h(
    "section",
    { class: "student-lesson" },
    h("h2", null, t("Grade again")),
    h(
      "p",
      { class: "help" },
      t("With the lesson as this server has it now. Nothing counts before you apply it."),
    ),
    h("div", { class: "row" }, look),
    seen,
    before,
  );
}

/** How far the preview is, asked for until `end`. */
function underWay(slug: string): { root: HTMLElement; end: () => void } {
  const bar = h("progress", { "aria-label": t("Submissions graded again") });
  const said = h("span", null, t("Reading what was handed in"));
  const ask = (): void =>
    void api
      .regradeProgress(slug)
      .then(({ done, of }) => {
        if (of === 0) return;
        bar.max = of;
        bar.value = done;
        said.textContent = t(
          "{done} of {n} submission graded again | {done} of {n} submissions graded again",
          {
            done,
            n: of,
          },
        );
      })
      // The answer itself says what is wrong.
      .catch(() => undefined);
  const timer = setInterval(ask, ASKED_EVERY_MS);
  return { root: h("p", { class: "row" }, bar, said), end: () => clearInterval(timer) };
}

function applied(
  all: AppliedRegrade[],
  lesson: AssignedLesson,
  again: () => void,
  failed: (error: unknown) => void,
): HTMLElement {
  const items = all
    .filter((one) => one.lesson === lesson.slug)
    .map((one) => {
      const undo = h("button", { type: "button", class: "button small" }, t("Take back"));
      undo.addEventListener("click", () => void api.undoRegrade(one.id).then(again).catch(failed));
      const end = one.undone ? ` ${t("Taken back {undone}.", { undone: dateTime(one.undone) })}` : " ";
      return h(
        "li",
        null,
        `${dateTime(one.at)} ${one.by}: ${one.reason} (${CHOICES[one.choice]?.() ?? one.choice}).${end}`,
        one.undone ? null : undo,
      );
    });
  return h("ul", { class: "remarks", hidden: items.length === 0 }, ...items);
}

function result(preview: RegradePreview, again: () => void, seen: HTMLElement): HTMLElement {
  const { counts } = preview;
  const sum = [
    t("{same} the same", { same: counts.same }),
    counts.words ? t("{words} in other words", { words: counts.words }) : "",
    counts.up ? t("{up} up", { up: counts.up }) : "",
    counts.down ? t("{down} down", { down: counts.down }) : "",
    counts.gradable ? t("{gradable} in what can be judged", { gradable: counts.gradable }) : "",
    counts.failed ? t("{failed} cannot be graded by the lesson as it is", { failed: counts.failed }) : "",
  ];
  return h(
    "div",
    { class: "stack" },
    h(
      "p",
      null,
      t("{submissions}, {of_other_versions} of them graded by another version of the lesson: {sum}.", {
        submissions: t("{n} submission | {n} submissions", { n: preview.submissions }),
        of_other_versions: preview.of_other_versions,
        sum: sum.filter(Boolean).join(", "),
      }),
    ),
    counts.program
      ? h(
          "p",
          null,
          t(
            "{verdicts} differ with the same lesson: this is the program's doing, and no change of the lesson.",
            { verdicts: t("{n} verdict | {n} verdicts", { n: counts.program }) },
          ),
        )
      : null,
    preview.people.length === 0 ? h("p", null, t("Nothing would change.")) : histogram(preview),
    // Before the people, who may be hundreds.
    preview.people.length === 0 ? null : apply(preview, again, seen),
    preview.people.length === 0 ? null : people(preview),
  );
}

/** How many students reach which tenth of the points, before and after. */
function histogram({ histogram_before: before, histogram_after: after }: RegradePreview): HTMLElement {
  const most = Math.max(1, ...before, ...after);
  const bar = (count: number, label: string): HTMLElement =>
    h(
      "td",
      { class: "bar", style: `--share:${count / most}` },
      h("span", null, String(count)),
      h("span", { class: "visually-hidden" }, label),
    );
  const table = h(
    "table",
    { class: "data tenths" },
    h("caption", null, t("Students by tenths of the points that count")),
    h(
      "thead",
      null,
      h(
        "tr",
        null,
        h("td"),
        ...before.map((_, k) => h("th", { scope: "col" }, `${10 * k}–${10 * (k + 1)} %`)),
      ),
    ),
    h(
      "tbody",
      null,
      h(
        "tr",
        null,
        h("th", { scope: "row" }, t("Before")),
        ...before.map((count) => bar(count, t("Before"))),
      ),
      h("tr", null, h("th", { scope: "row" }, t("After")), ...after.map((count) => bar(count, t("After")))),
    ),
  );
  const label = t("Students by tenths of the points that count");
  return h("div", { class: "table-scroll", tabindex: "0", role: "region", "aria-label": label }, table);
}

function people(preview: RegradePreview): HTMLElement {
  const rows = preview.people.map((person) =>
    h(
      "tr",
      null,
      h("th", { scope: "row" }, h("a", { href: `/class/${encodeURIComponent(person.person)}` }, person.name)),
      h("td", { class: "number" }, points(person.before)),
      h("td", { class: "number" }, points(person.after), passing(person.passed)),
      h(
        "td",
        { class: "number" },
        person.attempts[0] === person.attempts[1] ? String(person.attempts[0]) : person.attempts.join(" → "),
      ),
      h(
        "td",
        null,
        ...person.submissions.flatMap((one) =>
          Object.entries(one.misconceptions).map(([question, [was, is]]) =>
            h("div", null, `${question}: ${mistake(was)} → ${mistake(is)}`),
          ),
        ),
      ),
      h("td", null, ...person.submissions.map((one) => compare(preview.id, one.id, dateTime(one.at)))),
    ),
  );
  const head = [t("Student"), t("Before"), t("After"), t("Attempts"), t("Misconceptions"), t("Verdicts")].map(
    (text, k) => h("th", { scope: "col", class: k > 0 && k < 4 ? "number" : "" }, text),
  );
  return h(
    "div",
    { class: "table-scroll", tabindex: "0", role: "region", "aria-label": t("What changes for whom") },
    h("table", { class: "data" }, h("thead", null, h("tr", null, ...head)), h("tbody", null, ...rows)),
  );
}

/** What becomes of having passed. */
function passing([was, is]: readonly boolean[]): HTMLElement | null {
  if (was === is) return null;
  return h("div", { class: "help" }, is ? t("passes now") : t("passes no more"));
}

const mistake = (name: string): string => (name ? mistakeName(name) : t("none"));

/** Both verdicts side by side: question by question, those that change before the others. */
function compare(id: string, submission: string, label: string): HTMLElement {
  const button = h("button", { type: "button", class: "button small" }, label);
  button.addEventListener("click", async () => {
    try {
      const both = await api.bothVerdicts(id, submission);
      const box = dialog(t("Both verdicts"), bothSides(both.before, both.after));
      box.classList.add("is-wide");
      await setMaths(box);
    } catch (error) {
      dialog(t("Both verdicts"), problemNotice(error));
    }
  });
  return button;
}

function bothSides(before: GradedSubmission, after: GradedSubmission | null | undefined): HTMLElement {
  const head = (title: string, verdict: typeof after): HTMLElement =>
    h("h3", null, verdict ? `${title}: ${pointsOf(verdict)}` : t("{title}: cannot be graded", { title }));
  const of = (verdict: typeof after, id: string) => verdict?.questions.find((one) => one.id === id);
  const ids = [...new Set([...before.questions, ...(after?.questions ?? [])].map((one) => one.id))];
  const changes = (id: string): boolean => JSON.stringify(of(before, id)) !== JSON.stringify(of(after, id));
  const same = ids.filter((id) => !changes(id));
  const cell = (verdict: typeof after, id: string): HTMLElement => {
    const found = of(verdict, id);
    return h("div", null, h("p", { class: "history-label" }, id), found ? verdictLine(found) : t("none"));
  };
  return h(
    "div",
    { class: "stack" },
    h(
      "div",
      { class: "both-verdicts" },
      head(t("Before"), before),
      head(t("After"), after),
      ...ids.filter(changes).flatMap((id) => [cell(before, id), cell(after, id)]),
    ),
    same.length > 0
      ? h("p", { class: "help" }, t("The same in both: {questions}.", { questions: listed(same) }))
      : null,
  );
}

function apply(preview: RegradePreview, again: () => void, seen: HTMLElement): HTMLElement {
  const reason = h("input", { id: "regrade-reason", class: "field", required: true, maxlength: "2000" });
  const choice = h(
    "select",
    { id: "regrade-choice", class: "field" },
    ...Object.entries(CHOICES).map(([word, text]) => h("option", { value: word }, text())),
  );
  const said = h("div", { "aria-live": "polite" });
  const form = h(
    "form",
    { class: "stack" },
    h("label", { for: "regrade-choice" }, t("Let the new verdicts count for")),
    choice,
    h("label", { for: "regrade-reason" }, t("Why (students see it)")),
    reason,
    said,
    h("div", { class: "row" }, h("button", { class: "button primary" }, t("Apply"))),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    api
      .applyRegrade(preview.id, {
        choice: choice.value === "replace" ? "replace" : "better",
        reason: reason.value,
      })
      .then(() => {
        seen.replaceChildren(h("p", { role: "status" }, t("Applied. Students see it, and why.")));
        again();
      })
      .catch((error: unknown) => said.replaceChildren(problemNotice(error)));
  });
  return form;
}
