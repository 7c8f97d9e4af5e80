// The policy of a lesson: when it is handed in and what is told, looked at before it counts.

import { api, problemOf } from "../api/client";
import type { AssignedLesson, Policy, PolicyPreview, Somebody } from "../api/types";
import { h } from "../core/dom";
import { dateTime, points, typedNumber } from "../core/format";
import { t } from "../core/texts";
import { pointsOf } from "../exercise/verdict";
import { problemNotice } from "../ui/notice";
import {
  labelled,
  local,
  moment,
  numberField,
  percent,
  personChoice,
  shares,
  sharesField,
} from "./policy-fields";

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
  const pause = numberField(String(policy.cooldown_minutes ?? 0), { low: 0, high: 525_600, whole: true });
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

export function policySection(lesson: AssignedLesson, students: Somebody[], again: () => void): HTMLElement {
  const { rows, read } = policyFields(lesson.policy);
  const said = h("div", { "aria-live": "polite" });
  // What the fields are about: nothing that somebody else set since is overwritten in silence.
  let version = lesson.version;
  const set = async (): Promise<void> => {
    try {
      version = await api.setPolicy(lesson.slug, read(), version);
      said.replaceChildren(h("p", { role: "status" }, t("It counts from now on.")));
    } catch (error) {
      const isOther = problemOf(error).code === "policy-changed";
      said.replaceChildren(problemNotice(error, isOther ? [look, replace] : []));
    }
  };
  const look = { label: t("Look at it in another tab"), run: () => void open(location.href) };
  const replace = {
    label: t("Set mine in its place"),
    run: async () => {
      try {
        const all = await api.assignments();
        version = all.find((one) => one.slug === lesson.slug)?.version ?? version;
        await set();
      } catch (error) {
        said.replaceChildren(problemNotice(error));
      }
    },
  };
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
    void set();
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
