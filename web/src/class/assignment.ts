// A lesson of the class, for those who teach: when it is handed in and what is told; more time for one person; regrades.

import { api } from "../api/client";
import type { AssignedLesson, Somebody } from "../api/types";
import { h } from "../core/dom";
import { dateTime, typedNumber } from "../core/format";
import type { Page } from "../core/router";
import { t } from "../core/texts";
import { problemNotice, skeleton } from "../ui/notice";
import { saidSection } from "./explanations";
import { figuresSection } from "./figures";
import { policySection } from "./policy";
import { labelled, moment, numberField, personChoice } from "./policy-fields";
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
