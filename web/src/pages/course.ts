// What each lesson of the course needs from which other, as arcs beside the list of lessons and in words; and a course of
// one's own: some of them, in another order, as the file that a server is started with.
import { api } from "../api/client";
import type { NotionGraph } from "../api/types";
import { AUTHORED, announce, h, saveFile, setText, svg } from "../core/dom";
import type { Page } from "../core/router";
import { parts, t } from "../core/texts";
import { problemNotice, skeleton } from "../ui/notice";
import { completed, courseFile, moved, type Row, rowsOf, unready, uses } from "./course-plan";

/** Height of a row and width of the picture beside it, px. */
const ROW = 44;
const WIDTH = 190;
/** What a course is made of: see the guide for authors. */
const FILE = "course.toml";

export function coursePage(outlet: HTMLElement): Page {
  const root = h("div", { class: "page" }, skeleton(8));
  outlet.append(root);
  const load = async (): Promise<void> => {
    try {
      root.replaceChildren(...new CoursePlan(await api.notions()).parts());
    } catch (error) {
      root.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
  return { title: t("The course") };
}

class CoursePlan {
  private rows: Row[];
  /** The row whose arcs stand out. */
  private chosen = 0;
  private readonly picture = svg("svg", { class: "course-arcs", "aria-hidden": "true", width: WIDTH });
  private readonly list = h("ol", { class: "course-rows" });
  private readonly details = h("section", { class: "course-details", "aria-live": "polite" });
  private readonly state = h("p", { class: "course-state", role: "status" });
  private readonly complete = h("button", { type: "button", class: "button" }, t("Take what is needed"));

  constructor(private readonly graph: NotionGraph) {
    this.rows = rowsOf(graph);
    this.complete.addEventListener("click", () => {
      this.change(completed(this.rows, this.graph.assumes));
      announce(t("What was needed is taken, before it is used."));
    });
    this.paint();
  }

  parts(): HTMLElement[] {
    const save = h(
      "button",
      { type: "button", class: "button primary" },
      t("Save as {file}", { file: FILE }),
    );
    save.addEventListener("click", () => {
      const text = courseFile(this.graph, this.rows);
      saveFile(new Blob([text], { type: "application/toml" }), FILE);
    });
    const back = h("button", { type: "button", class: "button quiet" }, t("As it was"));
    back.addEventListener("click", () => this.change(rowsOf(this.graph)));
    return [
      h(
        "header",
        { class: "page-head" },
        h("h1", null, t("What needs what")),
        h(
          "p",
          { class: "lead" },
          t(
            "An arc leads from the lesson that introduces a notion to each that uses it. Take some lessons and put them in another order: what would be used before it is introduced is told at once.",
          ),
        ),
      ),
      h("div", { class: "row wrap" }, this.state, this.complete, save, back),
      h(
        "p",
        { class: "help" },
        ...parts(
          "Put the file into a folder, with lessons of your own beside it if you have some, and start the server with {command}.",
          { command: h("code", null, t("triad --course FOLDER serve")) },
        ),
      ),
      h(
        "div",
        { class: "course-plan" },
        h("div", { class: "course-graph" }, this.picture, this.list),
        this.details,
      ),
    ];
  }

  private change(rows: Row[], chosen = this.chosen): void {
    this.rows = rows;
    this.chosen = chosen;
    this.paint();
  }

  private paint(): void {
    const { assumes } = this.graph;
    const wanting = new Set(unready(this.rows, assumes));
    const taken = this.rows.filter((row) => row.taken);
    const hours = taken.reduce((sum, row) => sum + row.lesson.minutes, 0) / 60;
    const ready =
      wanting.size === 0
        ? t("Nothing is used before it is introduced.")
        : t("{n} lesson uses what was not introduced. | {n} lessons use what was not introduced.", {
            n: wanting.size,
          });
    const all = t("{n} lesson, about {hours} hours. | {n} lessons, about {hours} hours.", {
      n: taken.length,
      hours: hours.toFixed(0),
    });
    setText(this.state, `${all} ${ready}`);
    this.state.classList.toggle("is-wanting", wanting.size > 0);
    this.complete.hidden = wanting.size === 0;
    this.list.replaceChildren(...this.rows.map((row, at) => this.row(row, at, wanting.has(at))));
    this.draw();
    this.tell();
  }

  private row(row: Row, at: number, isWanting: boolean): HTMLElement {
    const { lesson, taken } = row;
    const take = h("input", { type: "checkbox", id: `take-${lesson.slug}`, checked: taken });
    take.addEventListener("change", () => {
      const next = this.rows.map((one, place) => (place === at ? { ...one, taken: take.checked } : one));
      this.change(next, at);
      this.focus(`#take-${lesson.slug}`);
    });
    const step = (by: -1 | 1, name: string, sign: string, label: string): HTMLElement => {
      const id = `${name}-${lesson.slug}`;
      const button = h(
        "button",
        {
          type: "button",
          class: "button quiet small icon-only",
          id,
          "aria-label": label,
          disabled: !this.rows[at + by],
        },
        sign,
      );
      button.addEventListener("click", () => {
        this.change(moved(this.rows, at, by), at + by);
        announce(t("{title} is lesson {place} now.", { title: lesson.title, place: this.placeOf(at + by) }));
        this.focus(`#${id}`);
      });
      return button;
    };
    const item = h(
      "li",
      {
        class: `course-row ${taken ? "" : "is-left-out"} ${isWanting ? "is-wanting" : ""}`,
        "data-place": at,
      },
      take,
      h(
        "label",
        { for: `take-${lesson.slug}` },
        h("span", { class: "course-place" }, taken ? String(this.placeOf(at)) : ""),
        h("span", { lang: AUTHORED }, lesson.title),
        isWanting ? h("span", { class: "flag" }, t("too early")) : null,
      ),
      step(-1, "earlier", "↑", t("{title}: earlier", { title: lesson.title })),
      step(1, "later", "↓", t("{title}: later", { title: lesson.title })),
    );
    const choose = (): void => {
      if (this.chosen === at) return;
      this.chosen = at;
      this.draw();
      this.tell();
    };
    item.addEventListener("focusin", choose);
    item.addEventListener("pointerenter", choose);
    return item;
  }

  /** The number of a lesson in the course: those that are left out have none. */
  private placeOf(at: number): number {
    return this.rows.slice(0, at + 1).filter((row) => row.taken).length;
  }

  /** Keeps the place of who works by keyboard: the rows were made anew. */
  private focus(selector: string): void {
    this.list.querySelector<HTMLElement>(selector)?.focus();
  }

  private draw(): void {
    const height = this.rows.length * ROW;
    this.picture.setAttribute("height", String(height));
    this.picture.setAttribute("viewBox", `0 0 ${WIDTH} ${height}`);
    const arcs = this.rows.flatMap((row, at) =>
      row.taken
        ? uses(this.rows, this.graph.assumes, at).flatMap((use) =>
            use.from === undefined ? [] : [{ from: use.from, to: at, met: use.met }],
          )
        : [],
    );
    const drawn = new Map(arcs.map((arc) => [`${arc.from} ${arc.to} ${arc.met}`, arc]));
    const middle = (at: number): number => (at + 0.5) * ROW;
    const isChosen = (arc: { from: number; to: number }): boolean =>
      arc.from === this.chosen || arc.to === this.chosen;
    const paths = [...drawn.values()]
      .sort((a, b) => Number(isChosen(a)) - Number(isChosen(b)))
      .map((arc) => {
        const [y1, y2] = [middle(arc.from), middle(arc.to)];
        // The further it reaches, the further out it runs.
        const out = WIDTH - 10 - (WIDTH - 20) * Math.sqrt(Math.abs(arc.to - arc.from) / this.rows.length);
        const kind = `${arc.met ? "" : "is-missing"} ${isChosen(arc) ? "is-chosen" : ""}`;
        const d = `M ${WIDTH - 8} ${y1} C ${out} ${y1}, ${out} ${y2}, ${WIDTH - 8} ${y2}`;
        return svg("path", { class: `course-arc ${kind}`, d });
      });
    const dots = this.rows.map((row, at) =>
      svg("circle", {
        class: `course-dot ${row.taken ? "" : "is-left-out"} ${at === this.chosen ? "is-chosen" : ""}`,
        cx: WIDTH - 8,
        cy: middle(at),
        r: 4,
      }),
    );
    this.picture.replaceChildren(...paths, ...dots);
  }

  /** The chosen lesson in words: what the arcs say. */
  private tell(): void {
    const row = this.rows[this.chosen];
    if (!row) return;
    const { lesson } = row;
    const words = (notion: string): string => notion.replaceAll("-", " ");
    const name = (place: number | undefined): string => {
      const other = place === undefined ? undefined : this.rows[place];
      if (!other) return t("no lesson");
      const { title } = other.lesson;
      return other.taken
        ? `${this.placeOf(place ?? 0)} ${title}`
        : t("{title}, which is not taken", { title });
    };
    const needs = uses(this.rows, this.graph.assumes, this.chosen).map((use) => {
      const brought = use.met && this.graph.assumes.includes(use.notion);
      return h(
        "li",
        { class: use.met ? "" : "is-wanting" },
        h("b", null, words(use.notion)),
        ": ",
        brought ? t("students bring it along") : name(use.from),
        use.met ? "" : ` (${t("too late")})`,
      );
    });
    const users = this.rows.flatMap((other, at) =>
      other.taken && uses(this.rows, this.graph.assumes, at).some((use) => use.from === this.chosen)
        ? [h("li", null, `${this.placeOf(at)} ${other.lesson.title}`)]
        : [],
    );
    this.details.replaceChildren(
      h(
        "h2",
        null,
        h("a", { href: `/lessons/${encodeURIComponent(lesson.slug)}`, lang: AUTHORED }, lesson.title),
      ),
      h("p", { class: "help" }, t("About {minutes} minutes.", { minutes: lesson.minutes })),
      h("h3", null, t("Introduces")),
      h("p", null, lesson.introduces.map(words).join(", ") || t("nothing new")),
      h("h3", null, t("Needs")),
      needs.length > 0 ? h("ul", null, ...needs) : h("p", null, t("nothing that comes before")),
      h("h3", null, t("Is needed by")),
      users.length > 0 ? h("ul", null, ...users) : h("p", null, t("no lesson that is taken")),
    );
  }
}
