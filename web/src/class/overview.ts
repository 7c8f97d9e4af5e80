// The class, for those who teach it: how students join, and what everybody has reached.
import { api } from "../api/client";
import { me } from "../api/identity";
import type { ClassView, GradeTable, Reached, StudentRow } from "../api/types";
import { h } from "../core/dom";
import { dateTime, plural, points } from "../core/format";
import type { Page } from "../core/router";
import { qr } from "../lecture/qr";
import { empty, problemNotice, skeleton } from "../ui/notice";

export function classPage(outlet: HTMLElement): Page {
  const door = h("section", { class: "class-way-in" });
  const table = h("section", { "aria-label": "What everybody has reached" }, skeleton(6));
  outlet.append(
    h(
      "div",
      { class: "page wide" },
      h("header", { class: "page-head" }, h("h1", null, me().course ?? "Class")),
      door,
      table,
    ),
  );
  const load = async (): Promise<void> => {
    try {
      paintDoor(door, await api.class());
      paintTable(table, await api.standings());
    } catch (error) {
      table.replaceChildren(problemNotice(error, [{ label: "Try again", run: () => void load() }]));
    }
  };
  void load();
  return { title: "Class" };
}

function paintDoor(root: HTMLElement, view: ClassView): void {
  const address = `${location.origin}/join?code=${view.join_code}`;
  const change = (label: string, what: { join_open?: boolean; new_code?: boolean }): HTMLElement => {
    const button = h("button", { type: "button", class: "button small" }, label);
    button.addEventListener("click", () => {
      api
        .changeClass(what)
        .then((next) => paintDoor(root, next))
        .catch((error: unknown) => root.append(problemNotice(error)));
    });
    return button;
  };
  root.replaceChildren(
    view.join_open ? qr(address) : h("div", { class: "qr is-closed" }, "Joining is closed"),
    h(
      "div",
      { class: "stack" },
      h("p", null, "Students open ", h("code", null, `${location.host}/join`), " and type"),
      h("p", { class: "class-code" }, view.join_code),
      h(
        "div",
        { class: "row wrap" },
        view.join_open
          ? change("Close joining", { join_open: false })
          : change("Open joining", { join_open: true }),
        change("Another code", { new_code: true }),
      ),
    ),
  );
}

function paintTable(root: HTMLElement, grades: GradeTable): void {
  const files = (["plain", "canvas", "moodle"] as const).map((format) =>
    h(
      "a",
      { class: "button small", href: api.standingsUrl(format), download: "grades.csv" },
      { plain: "CSV", canvas: "CSV for Canvas", moodle: "CSV for Moodle" }[format],
    ),
  );
  root.replaceChildren(
    h(
      "div",
      { class: "section-head" },
      h("h2", null, plural(grades.students.length, "student")),
      h("div", { class: "row wrap" }, ...files),
    ),
    grades.students.length === 0
      ? empty("Nobody has joined yet", "Show the code above: whoever joins appears here.")
      : sheet(grades),
  );
}

function sheet(grades: GradeTable): HTMLElement {
  const head = grades.lessons.map((lesson) =>
    h(
      "th",
      { scope: "col", class: "number", title: `${lesson.title}, ${points(lesson.possible)} points` },
      h(
        "a",
        {
          href: `/class/lessons/${encodeURIComponent(lesson.slug)}`,
          "aria-label": `${lesson.number} ${lesson.title}`,
        },
        String(lesson.number),
      ),
    ),
  );
  const rows = grades.students.map((student) =>
    h(
      "tr",
      null,
      h("th", { scope: "row" }, h("a", { href: `/class/${encodeURIComponent(student.id)}` }, student.name)),
      h("td", { class: "number" }, points(total(student))),
      ...grades.lessons.map((lesson) => cell(student.lessons[lesson.slug])),
    ),
  );
  return h(
    "div",
    { class: "table-scroll", tabindex: "0", role: "region", "aria-label": "Students by lessons" },
    h(
      "table",
      { class: "data grade-table" },
      h(
        "caption",
        null,
        "Points that count (* decided, ? asks for a look again); below them the attempts. The numbers above lead to each lesson’s dates and regrades.",
      ),
      h(
        "thead",
        null,
        h(
          "tr",
          null,
          h("th", { scope: "col" }, "Student"),
          h("th", { scope: "col", class: "number" }, "Sum"),
          ...head,
        ),
      ),
      h("tbody", null, ...rows),
    ),
  );
}

const total = (student: StudentRow): number =>
  Object.values(student.lessons).reduce((sum, reached) => sum + reached.points, 0);

function cell(reached: Reached | undefined): HTMLElement {
  if (!reached) return h("td", { class: "number is-nothing" }, "·");
  const last = reached.last ? `last ${dateTime(reached.last)}` : "nothing handed in";
  const marks = `${reached.decided ? "*" : ""}${reached.late ? " late" : ""}${reached.asked ? " ?" : ""}`;
  const asked = reached.asked ? "; asks for a look again" : "";
  const decided = reached.decided ? `; decided by ${reached.decided.by}: ${reached.decided.reason}` : "";
  return h(
    "td",
    { class: `number ${reached.passed ? "is-passed" : "is-open"}`, title: `${last}${decided}${asked}` },
    h("span", null, `${points(reached.points)}${marks}`),
    h(
      "span",
      { class: "attempts", "aria-label": plural(reached.attempts, "attempt") },
      `${reached.attempts}×`,
    ),
  );
}
