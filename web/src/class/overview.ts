// The class, for those who teach it: how students join, and what everybody has reached.

import { api } from "../api/client";
import { me } from "../api/identity";
import type { ClassView, Filled, GradeTable, Reached, StudentRow } from "../api/types";
import { addressOf } from "../core/address";
import { h, saveFile } from "../core/dom";
import { dateTime, points } from "../core/format";
import type { Page } from "../core/router";
import { parts, t } from "../core/texts";
import { inviteTo } from "../lecture/invite";
import { qr } from "../lecture/qr";
import { empty, problemNotice, skeleton } from "../ui/notice";
import { showPlatforms } from "./platform";

/** Milliseconds between two looks at who has joined. */
const PAUSE = 5_000;
/** Names of the machine for itself. */
const LOOPBACK = /^(localhost|127\.[\d.]+|\[::1\])$/;

export function classPage(outlet: HTMLElement): Page {
  const door = h("section", { class: "class-way-in" });
  const table = h("section", { "aria-label": t("What everybody has reached") }, skeleton(6));
  const lessons = h("section", { class: "student-lesson", hidden: true });
  const platforms = h("section", { "aria-label": t("Learning platform") });
  outlet.append(
    h(
      "div",
      { class: "page wide" },
      h(
        "header",
        { class: "page-head row between wrap" },
        h("h1", null, me().course ?? t("Class")),
        h(
          "nav",
          { class: "row", "aria-label": t("The class") },
          h("a", { class: "button", href: "/class/now" }, t("At a glance")),
          h("a", { class: "button", href: "/class/people" }, t("People")),
        ),
      ),
      door,
      table,
      lessons,
      platforms,
    ),
  );
  let timer = 0;
  let shown = 0;
  /** Whoever joins while somebody looks is in the table a moment later; else the page stays as it is read. */
  const look = async (): Promise<void> => {
    clearTimeout(timer);
    // Nobody looks at a page in the background, and what goes wrong is told by the next thing that is pressed.
    const people = document.hidden ? undefined : await api.people().catch(() => undefined);
    if (!table.isConnected) return;
    if (people && people.length !== shown) void load();
    else timer = window.setTimeout(() => void look(), PAUSE);
  };
  const load = async (): Promise<void> => {
    try {
      const [view, people, grades] = await Promise.all([api.class(), api.people(), api.standings()]);
      shown = people.length;
      paintDoor(door, view);
      paintTable(table, grades);
      paintLessons(lessons, grades);
      if (view.join_open) timer = window.setTimeout(() => void look(), PAUSE);
    } catch (error) {
      table.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
  void showPlatforms(platforms);
  return { title: t("Class"), dispose: () => clearTimeout(timer) };
}

function paintDoor(root: HTMLElement, view: ClassView): void {
  const address = `${location.origin}${addressOf("/join")}?code=${view.join_code}`;
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
  const large = h("button", { type: "button", class: "button small" }, t("For the whole hall"));
  large.addEventListener("click", () => {
    const linked = `/join?code=${view.join_code}`;
    void inviteTo(t("Join the class"), { typed: "/join", linked, code: view.join_code });
  });
  root.replaceChildren(
    view.join_open ? qr(address) : h("div", { class: "qr is-closed" }, t("Joining is closed")),
    h(
      "div",
      { class: "stack" },
      h(
        "p",
        null,
        ...parts("Students open {address} and type", {
          address: h("code", null, `${location.host}${addressOf("/join")}`),
        }),
      ),
      h("p", { class: "class-code" }, view.join_code),
      LOOPBACK.test(location.hostname)
        ? h(
            "p",
            { class: "help" },
            t("Only this machine reaches that address. For others start the server with --host 0.0.0.0."),
          )
        : null,
      h(
        "div",
        { class: "row wrap" },
        view.join_open
          ? change(t("Close joining"), { join_open: false })
          : change(t("Open joining"), { join_open: true }),
        change(t("Another code"), { new_code: true }),
        view.join_open ? large : null,
      ),
    ),
  );
}

/** Every lesson, also before anybody has joined. */
function paintLessons(root: HTMLElement, grades: GradeTable): void {
  root.hidden = false;
  root.replaceChildren(
    h("h2", null, t("Lessons")),
    h(
      "p",
      { class: "help" },
      t("Dates, what is told when, what the class said, questions in figures, regrades."),
      " ",
      h("a", { href: "/course" }, t("Other lessons, or another order")),
    ),
    h(
      "ol",
      { class: "lesson-links" },
      ...grades.lessons.map((lesson) =>
        h(
          "li",
          { value: lesson.number },
          h("a", { href: `/class/lessons/${encodeURIComponent(lesson.slug)}` }, lesson.title),
        ),
      ),
    ),
  );
}

function paintTable(root: HTMLElement, grades: GradeTable): void {
  const files = (["plain", "canvas", "moodle"] as const).map((format) =>
    h(
      "a",
      { class: "button small", href: api.standingsUrl(format), download: "grades.csv" },
      { plain: "CSV", canvas: t("CSV for Canvas"), moodle: t("CSV for Moodle") }[format],
    ),
  );
  const said = h("div", { "aria-live": "polite" });
  root.replaceChildren(
    h(
      "div",
      { class: "section-head" },
      h("h2", null, t("{n} student | {n} students", { n: grades.students.length })),
      h(
        "div",
        { class: "row wrap" },
        ...files,
        h(
          "a",
          { class: "button small", href: api.standingsLinesUrl, download: "grades.jsonl" },
          t("JSON lines"),
        ),
        canvasButton(said),
      ),
    ),
    said,
    ...askers(grades),
    grades.students.length === 0
      ? empty(t("Nobody has joined yet"), t("Show the code above: whoever joins appears here."))
      : sheet(grades),
  );
}

/** Who asks for a look again: one mark among ten thousand cells is found by nobody. */
function askers(grades: GradeTable): HTMLElement[] {
  const items = grades.students.flatMap((student) =>
    grades.lessons
      .filter((lesson) => student.lessons[lesson.slug]?.asked)
      .map((lesson) =>
        h(
          "li",
          null,
          h("a", { href: `/class/${encodeURIComponent(student.id)}#${lesson.slug}` }, student.name),
          `: ${lesson.number} ${lesson.title}`,
        ),
      ),
  );
  if (items.length === 0) return [];
  return [
    h(
      "details",
      { class: "askers", open: items.length <= 5 },
      h("summary", null, t("{n} asks for a look again | {n} ask for a look again", { n: items.length })),
      h("ul", { class: "remarks" }, ...items),
    ),
  ];
}

/** Takes a gradebook that Canvas exported, and gives it back with the grades that changed. */
function canvasButton(said: HTMLElement): HTMLElement {
  const input = h("input", {
    type: "file",
    accept: ".csv,text/csv",
    hidden: true,
    "aria-label": t("File of Canvas"),
  });
  const button = h("button", { type: "button", class: "button small" }, t("Fill in a file of Canvas…"));
  button.addEventListener("click", () => input.click());
  input.addEventListener("change", async () => {
    const file = input.files?.[0];
    input.value = "";
    if (!file) return;
    try {
      const filled = await api.fillCanvas(await file.text());
      if (filled.changed > 0) saveFile(new Blob([filled.csv], { type: "text/csv" }), "canvas.csv");
      said.replaceChildren(...filledIn(filled));
    } catch (error) {
      said.replaceChildren(problemNotice(error));
    }
  });
  return h("span", null, input, button);
}

function filledIn(filled: Filled): HTMLElement[] {
  const line = (what: string, names: string[]): HTMLElement | null =>
    names.length > 0 ? h("p", { class: "help" }, `${what}: ${names.join(", ")}.`) : null;
  const lines = [
    h(
      "p",
      null,
      filled.changed > 0
        ? t("{grades} changed: import the file in Canvas.", {
            grades: t("{n} grade | {n} grades", { n: filled.changed }),
          })
        : t("Canvas has all of these grades already."),
    ),
    line(t("Lessons without a column in the file"), filled.without_column),
    line(t("In the file, and not in this class"), filled.unknown),
    line(t("In this class, and not in the file"), filled.missing),
    line(
      t("Other points in Canvas than here"),
      filled.other_points.map((one) =>
        t("{column}: {there} there, {here} here", {
          column: one.column,
          there: points(one.there),
          here: points(one.here),
        }),
      ),
    ),
  ];
  return lines.filter((one) => one !== null);
}

function sheet(grades: GradeTable): HTMLElement {
  const head = grades.lessons.map((lesson) =>
    h(
      "th",
      {
        scope: "col",
        class: "number",
        title: t("{title}, {possible} points", { title: lesson.title, possible: points(lesson.possible) }),
      },
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
    {
      class: "table-scroll grade-sheet",
      tabindex: "0",
      role: "region",
      "aria-label": t("Students by lessons"),
    },
    h(
      "table",
      { class: "data grade-table" },
      h(
        "caption",
        null,
        t(
          "Points that count (* decided, ? asks for a look again); below them the attempts. The numbers above lead to each lesson’s dates and regrades.",
        ),
      ),
      h(
        "thead",
        null,
        h(
          "tr",
          null,
          h("th", { scope: "col" }, t("Student")),
          h("th", { scope: "col", class: "number" }, t("Sum")),
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
  const last = reached.last ? t("last {last}", { last: dateTime(reached.last) }) : t("nothing handed in");
  const marks = `${reached.decided ? "*" : ""}${reached.late ? ` ${t("late")}` : ""}${reached.asked ? " ?" : ""}`;
  const asked = reached.asked ? `; ${t("asks for a look again")}` : "";
  const decided = reached.decided
    ? `; ${t("decided by {by}: {reason}", { by: reached.decided.by, reason: reached.decided.reason })}`
    : "";
  return h(
    "td",
    { class: `number ${reached.passed ? "is-passed" : "is-open"}`, title: `${last}${decided}${asked}` },
    h("span", null, `${points(reached.points)}${marks}`),
    h(
      "span",
      { class: "attempts", "aria-label": t("{n} attempt | {n} attempts", { n: reached.attempts }) },
      `${reached.attempts}×`,
    ),
  );
}
