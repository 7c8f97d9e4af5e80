// A lesson of the class, for those who teach: when it is handed in and what is told, looked at before it counts; more
// time for one person; regrades.

import { api } from "../api/client";
import type { AssignedLesson, Policy, PolicyPreview, Somebody } from "../api/types";
import { h } from "../core/dom";
import { dateTime, points, typedNumber } from "../core/format";
import type { Page } from "../core/router";
import { t } from "../core/texts";
import { pointsOf } from "../exercise/verdict";
import { problemNotice, skeleton } from "../ui/notice";
import { saidSection } from "./explanations";
import { figuresSection } from "./figures";
import { local, moment, numberField, percent, shares, sharesField } from "./policy-fields";
import { regradeSection } from "./regrade";

export function assignmentPage(outlet: HTMLElement, params: string[]): Page {
  const slug = params[0] ?? "";
  const root = h("div", { class: "page" }, skeleton(6));
  outlet.append(root);
  const load = async (): Promise<void> => {
    try {
      const [all, people] = await Promise.all([api.assignments(), api.people()]);
      const lesson = all.find((one) => one.slug === slug);
      if (!lesson) throw new Error(t("There is no lesson {slug} in this class.", { slug }));
      const students = people.filter((person) => person.role === "student");
      root.replaceChildren(
        h("p", null, h("a", { href: "/class" }, t("← Class"))),
        h("header", { class: "page-head" }, h("h1", null, `${lesson.number} ${lesson.title}`)),
        figuresSection(lesson),
        saidSection(slug),
        policySection(lesson, students, () => void load()),
        extensionSection(lesson, students, () => void load()),
        regradeSection(lesson),
      );
    } catch (error) {
      root.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
  return { title: t("Lesson of the class") };
}

function labelled(label: string, input: HTMLElement, id: string): HTMLElement {
  input.id = id;
  return h("div", { class: "stack tight" }, h("label", { for: id }, label), input);
}

/** A field for a moment, and the moment in it: to the last digit that of before, where nobody touched it. */
const when = (
  id: string,
  label: string,
  value: string | null | undefined,
): [HTMLElement, () => string | undefined] => {
  const shown = local(value);
  // A browser shows and takes seconds only where it is told to.
  const step = shown.length > "0000-00-00T00:00".length ? "1" : null;
  const input = h("input", { type: "datetime-local", class: "field", value: shown, step });
  const read = (): string | undefined =>
    input.value === input.defaultValue ? (value ?? undefined) : moment(input);
  return [labelled(label, input, id), read];
};

const REVEAL = {
  at_once: () => t("at once"),
  after_due: () => t("after the due date"),
  when_released: () => t("when released"),
  never: () => t("never"),
};
type When = keyof typeof REVEAL;

function choice(id: string, label: string, value: When): [HTMLElement, HTMLSelectElement] {
  const select = h(
    "select",
    { class: "field" },
    ...Object.entries(REVEAL).map(([word, text]) =>
      h("option", { value: word, selected: word === value }, text()),
    ),
  );
  return [labelled(label, select, id), select];
}

/** What is told when. */
function revealFields(now: Policy["reveal"]): {
  rows: HTMLElement[];
  read: () => NonNullable<Policy["reveal"]>;
} {
  const [pointsRow, told] = choice("reveal-points", t("Points are told"), now?.points ?? "at_once");
  const [messagesRow, messages] = choice(
    "reveal-messages",
    t("Remarks are told"),
    now?.messages ?? "at_once",
  );
  const [referenceRow, reference] = choice(
    "reveal-reference",
    t("Right answers are told"),
    now?.reference ?? "at_once",
  );
  return {
    rows: [pointsRow, messagesRow, referenceRow],
    read: () => ({
      points: told.value as When,
      messages: messages.value as When,
      reference: reference.value as When,
    }),
  };
}

/** The fields of a policy, and what stands in them. */
function policyFields(policy: Policy): { rows: HTMLElement[]; read: () => Policy } {
  const [opensRow, opens] = when("opens", t("Opens"), policy.opens);
  const [dueRow, due] = when("due", t("Due"), policy.due);
  const [closesRow, closes] = when("closes", t("Closes"), policy.closes);
  const [lateRow, late] = when("late", t("Then, until"), policy.late?.at(-1)?.until);
  const share = numberField(percent(policy.late?.at(-1)?.share ?? 0.5), { low: 0, high: 100 });
  const most = numberField(String(policy.most_attempts ?? ""), { low: 1, whole: true, empty: true });
  const falling = sharesField(policy.falling ?? []);
  const pause = numberField(String(policy.cooldown_minutes ?? 0), { low: 0, whole: true });
  const reveal = revealFields(policy.reveal);
  const read = (): Policy => {
    const until = late();
    // Steps before the last are set by the interface; the page keeps them.
    const steps = (policy.late ?? []).slice(0, -1);
    return {
      opens: opens(),
      due: due(),
      closes: closes(),
      late: until ? [...steps, { until, share: typedNumber(share.value) / 100 }] : [],
      most_attempts: most.value.trim() ? typedNumber(most.value) : undefined,
      falling: shares(falling.value),
      cooldown_minutes: typedNumber(pause.value),
      reveal: reveal.read(),
    };
  };
  const rows = [
    h("div", { class: "policy-grid" }, opensRow, dueRow, closesRow),
    h("div", { class: "policy-grid" }, lateRow, labelled(t("counts, %"), share, "late-share")),
    h(
      "div",
      { class: "policy-grid" },
      labelled(t("Attempts (empty: any number)"), most, "most-attempts"),
      labelled(t("What the attempts count, %"), falling, "falling"),
      labelled(t("Minutes between attempts"), pause, "cooldown"),
    ),
    h("div", { class: "policy-grid" }, ...reveal.rows),
  ];
  return { rows, read };
}

function policySection(lesson: AssignedLesson, students: Somebody[], again: () => void): HTMLElement {
  const { rows, read } = policyFields(lesson.policy);
  const said = h("div", { "aria-live": "polite" });
  const form = h(
    "form",
    { class: "stack" },
    ...rows,
    said,
    h(
      "div",
      { class: "row wrap" },
      h("button", { class: "button primary" }, t("Set")),
      releaseButton(lesson, said, again),
    ),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    api
      .setPolicy(lesson.slug, read())
      .then(() => said.replaceChildren(h("p", { role: "status" }, t("It counts from now on."))))
      .catch((error: unknown) => said.replaceChildren(problemNotice(error)));
  });
  return h(
    "section",
    { class: "student-lesson" },
    h("h2", null, t("When it is handed in, and what is told")),
    form,
    previewForm(lesson, students, () => (form.reportValidity() ? read() : undefined)),
  );
}

function releaseButton(lesson: AssignedLesson, said: HTMLElement, again: () => void): HTMLElement {
  const button = h(
    "button",
    { type: "button", class: "button" },
    lesson.released ? t("Hold the results back") : t("Release the results"),
  );
  button.addEventListener("click", () => {
    api
      .releaseResults(lesson.slug, !lesson.released)
      .then(again)
      .catch((error: unknown) => said.replaceChildren(problemNotice(error)));
  });
  return button;
}

/** What the policy above makes of somebody's work at some time, before it is set; `read` gives none while a field of it is wrong. */
function previewForm(
  lesson: AssignedLesson,
  students: Somebody[],
  read: () => Policy | undefined,
): HTMLElement {
  const who = personChoice(students, t("Somebody new"));
  const at = h("input", { type: "datetime-local", class: "field" });
  const seen = h("div", { "aria-live": "polite" });
  const form = h(
    "form",
    { class: "stack" },
    h("h3", null, t("Look at it for a student, before it counts")),
    h(
      "div",
      { class: "policy-grid" },
      labelled(t("Student"), who, "preview-person"),
      labelled(t("At (empty: now)"), at, "preview-at"),
      h("div", { class: "row end" }, h("button", { class: "button" }, t("Preview"))),
    ),
    seen,
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const policy = read();
    if (!policy) return;
    api
      .previewPolicy(lesson.slug, { policy, person: who.value || undefined, at: moment(at) })
      .then((preview) => seen.replaceChildren(previewed(preview)))
      .catch((error: unknown) => seen.replaceChildren(problemNotice(error)));
  });
  return form;
}

function previewed({ at, standing, told }: PolicyPreview): HTMLElement {
  const phase = {
    not_open: t("not open"),
    open: t("open"),
    late: t("late"),
    practice: t("practice only"),
    closed: t("closed"),
  }[standing.phase];
  const rows = standing.credits.map((credit) =>
    h(
      "tr",
      null,
      h("td", { class: "number" }, String(credit.attempt)),
      h("td", null, dateTime(credit.at)),
      h("td", { class: "number" }, points(credit.earned)),
      h("td", { class: "number" }, `${points(100 * credit.on_time)} %`),
      h("td", { class: "number" }, `${points(100 * credit.of_attempt)} %`),
      h("td", { class: "number" }, points(credit.points)),
    ),
  );
  const head = [t("Attempt"), t("Handed in"), t("Earned"), t("On time"), t("As attempt"), t("Counts")].map(
    (text, k) => h("th", { scope: "col", class: k === 1 ? "" : "number" }, text),
  );
  return h(
    "div",
    { class: "stack" },
    h(
      "p",
      null,
      t("{at}: {phase}; an attempt would count {worth} %. {points} points count.", {
        at: dateTime(at),
        phase,
        worth: points(100 * standing.worth),
        points: points(standing.points),
      }),
      told
        ? ` ${t("The student is told of the last submission: {told}.", {
            told: told.earned == null ? t("nothing yet") : pointsOf(told),
          })}`
        : "",
    ),
    rows.length === 0
      ? h("p", { class: "help" }, t("No attempts by then."))
      : h(
          "div",
          { class: "table-scroll", tabindex: "0", role: "region", "aria-label": t("Attempts") },
          h("table", { class: "data" }, h("thead", null, h("tr", null, ...head)), h("tbody", null, ...rows)),
        ),
  );
}

function personChoice(students: Somebody[], none: string): HTMLSelectElement {
  return h(
    "select",
    { class: "field" },
    h("option", { value: "" }, none),
    ...students.map((person) => h("option", { value: person.id }, person.name)),
  );
}

function extensionSection(lesson: AssignedLesson, students: Somebody[], again: () => void): HTMLElement {
  const who = personChoice(students, t("Choose"));
  const until = h("input", { type: "datetime-local", class: "field" });
  const more = numberField("0", { low: 0, whole: true });
  const reason = h("input", { class: "field", maxlength: "2000", required: true });
  const said = h("div", { "aria-live": "polite" });
  const failed = (error: unknown): void => said.replaceChildren(problemNotice(error));
  const name = (person: string): string => students.find((one) => one.id === person)?.name ?? t("somebody");
  const form = h(
    "form",
    { class: "stack" },
    h(
      "div",
      { class: "policy-grid" },
      labelled(t("Student"), who, "extend-person"),
      labelled(t("Due"), until, "extend-until"),
      labelled(t("More attempts"), more, "extend-attempts"),
    ),
    labelled(t("Why (the student sees it)"), reason, "extend-reason"),
    said,
    h("div", { class: "row" }, h("button", { class: "button" }, t("Allow"))),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const body = { until: moment(until), attempts: typedNumber(more.value), reason: reason.value };
    api.extend(lesson.slug, who.value, body).then(again).catch(failed);
  });
  const given = lesson.extensions.map((one) => {
    const back = h("button", { type: "button", class: "button small" }, t("Take back"));
    back.addEventListener(
      "click",
      () => void api.takeBackExtension(lesson.slug, one.person).then(again).catch(failed),
    );
    const what = [
      one.until ? t("due {until}", { until: dateTime(one.until) }) : "",
      one.attempts ? t("{n} more attempt | {n} more attempts", { n: one.attempts }) : "",
    ];
    return h(
      "li",
      null,
      `${name(one.person)}: ${what.filter(Boolean).join(", ")}. ${one.by}: ${one.reason} `,
      back,
    );
  });
  return h(
    "section",
    { class: "student-lesson" },
    h("h2", null, t("More time for one student")),
    h("ul", { class: "remarks", hidden: given.length === 0 }, ...given),
    form,
  );
}
