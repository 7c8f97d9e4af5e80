// A scene as text: line numbers, checked as one types, errors at their place.

import { ApiError, api } from "../api/client";
import type { CheckReport, Problem } from "../api/types";
import { h } from "../core/dom";
import { t } from "../core/texts";
import { told } from "../core/told";

import { icon } from "../ui/icons";
import { problemNotice, type SaidProblem } from "../ui/notice";
import { firstFault } from "./json";
import { isMarkup } from "./markup";
import { inText, type Meant, meantBy } from "./meant";
import { lineOf, locate } from "./pointer";
import { suggestions } from "./suggest";

/** A text is checked when nothing was typed for this long, ms. */
const CHECK_AFTER_MS = 600;

/** Lines that stay visible above a place that is shown. */
const LINES_ABOVE = 6;

export class SceneEditor {
  readonly root: HTMLElement;
  private readonly area = h("textarea", {
    class: "code",
    spellcheck: "false",
    autocapitalize: "off",
    autocomplete: "off",
    wrap: "off",
    "aria-label": t("Scene, JSON"),
    rows: "24",
  });
  private readonly gutter = h("div", { class: "gutter", "aria-hidden": "true" });
  private readonly result = h("div", { class: "check", "aria-live": "polite" });
  private timer = 0;
  /** Ends a check that a newer text has overtaken. */
  private checking = new AbortController();

  /** `changed` hears of each edit, `sound` of a text that the server has checked and can run, `unsound` of the line of a mistake,
   * `robot` of a URDF that is to be imported. */
  constructor(
    private readonly changed: (text: string) => void,
    private readonly sound: (text: string) => void,
    private readonly unsound: (line: number) => void,
    private readonly robot: (urdf: string) => void,
  ) {
    const { area, gutter } = this;
    const completion = suggestions(area, () => area.dispatchEvent(new Event("input")));
    this.root = h(
      "div",
      { class: "editor" },
      h("div", { class: "code-box" }, h("div", { class: "gutter-box" }, gutter), area, completion),
      this.result,
    );
    area.addEventListener("input", () => {
      this.changed(area.value);
      this.checkSoon();
    });
    area.addEventListener("scroll", () => {
      gutter.style.transform = `translateY(${-area.scrollTop}px)`;
    });
  }

  text(): string {
    return this.area.value;
  }

  set(text: string): void {
    this.area.value = text;
    this.numberLines();
    void this.check();
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.checking.abort();
  }

  private numberLines(): void {
    const count = this.area.value.split("\n").length;
    if (this.gutter.childElementCount === count) return;
    const numbers = Array.from({ length: count }, (_, k) => h("span", null, String(k + 1)));
    this.gutter.replaceChildren(...numbers);
  }

  private mark(lines: number[]): void {
    const [first] = lines;
    if (first !== undefined) this.unsound(first);
    for (const [k, child] of [...this.gutter.children].entries())
      child.classList.toggle("is-marked", lines.includes(k + 1));
  }

  private goTo(pointer: string): void {
    const { area } = this;
    const offset = locate(area.value, pointer);
    area.focus();
    area.setSelectionRange(offset, endOfValue(area.value, offset));
    const line = lineOf(area.value, offset);
    area.scrollTop = Math.max(0, (line - LINES_ABOVE) * lineHeight(area));
    this.mark([line]);
  }

  /** Puts the word that was meant in the place of the one that was written. */
  private offer({ given, meant, from, to }: Meant): { label: string; run: () => void } {
    const { area } = this;
    return {
      label: t("Write “{meant}” in place of “{given}”", { meant, given }),
      run: () => {
        // What was written since is not overwritten.
        if (area.value.slice(from, to) !== JSON.stringify(given)) return;
        area.focus();
        area.setRangeText(JSON.stringify(meant), from, to, "end");
        area.dispatchEvent(new Event("input"));
      },
    };
  }

  private checkSoon(): void {
    this.numberLines();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.check(), CHECK_AFTER_MS);
  }

  /** What is wrong with a text, at its place there. */
  private tell(problem: Problem, text: string): void {
    const lines = linesOf(problem, text);
    this.mark(lines);
    const meant = meantBy(problem, text);
    const told = inText(problem, lines[0], meant !== undefined);
    const offers = meant ? [this.offer(meant)] : [];
    this.result.replaceChildren(problemNotice(told, offers, { open: (pointer) => this.goTo(pointer) }));
  }

  private async check(): Promise<void> {
    this.checking.abort();
    this.checking = new AbortController();
    const { signal } = this.checking;
    this.mark([]);
    const text = this.area.value;
    const broken = syntaxProblem(text);
    if (broken) {
      this.mark([broken.line]);
      const offers = isMarkup(text)
        ? [{ label: t("Import it as a robot (URDF)"), run: () => this.robot(text) }]
        : [];
      this.result.replaceChildren(problemNotice(broken.problem, offers));
      return;
    }
    try {
      const report = await api.check(text, signal);
      this.result.replaceChildren(reportView(report));
      this.sound(text);
    } catch (error) {
      if (signal.aborted) return;
      if (error instanceof ApiError) this.tell(error.problem, text);
      else this.result.replaceChildren(problemNotice(error));
    }
  }
}

/** The lines of the places that a problem names. */
function linesOf(problem: Problem, text: string): number[] {
  return (problem.errors ?? []).flatMap((place) =>
    place.pointer ? [lineOf(text, locate(text, place.pointer))] : [],
  );
}

function lineHeight(area: HTMLTextAreaElement): number {
  return Number.parseFloat(getComputedStyle(area).lineHeight) || 20;
}

function endOfValue(text: string, offset: number): number {
  const rest = /^(?:"(?:[^"\\]|\\.)*"|[^,\]}\n]+)/.exec(text.slice(offset));
  return offset + (rest?.[0].trimEnd().length ?? 1);
}

/** Text that is not JSON never leaves the page. */
function syntaxProblem(text: string): { problem: SaidProblem; line: number } | undefined {
  const fault = firstFault(text);
  if (!fault) return undefined;
  const line = lineOf(text, fault.at);
  return {
    line,
    problem: {
      code: "not-json",
      said: ["title", "detail"],
      title: fault.twice
        ? t("Line {line} has a key that was there before", { line })
        : t("Line {line} is not JSON yet", { line }),
      detail: fault.why,
    },
  };
}

function reportView(report: CheckReport): HTMLElement {
  const figure = (label: string, value: number): HTMLElement =>
    h("div", { class: "figure" }, h("dt", null, label), h("dd", null, String(value)));
  const redundant = report.redundant.reduce((sum, entry) => sum + entry.rows.length, 0);
  return h(
    "section",
    { class: "report", "aria-label": t("Result of the check") },
    h(
      "p",
      { class: "report-title" },
      icon("check"),
      t("This scene can run. It has {degrees} of freedom.", {
        degrees: t("{n} degree | {n} degrees", { n: report.degrees_of_freedom }),
      }),
    ),
    h(
      "dl",
      { class: "figures" },
      figure(t("Bodies"), report.bodies),
      figure(t("Coordinates"), report.coordinates),
      figure(t("Rows"), report.rows),
      figure(t("Rank"), report.rank),
      figure(t("Degrees of freedom"), report.degrees_of_freedom),
      figure(t("Redundant rows"), redundant),
    ),
    report.redundant.length > 0
      ? h(
          "div",
          null,
          h("h2", null, t("Redundant rows")),
          h(
            "ul",
            null,
            ...report.redundant.map((entry) =>
              h("li", null, h("b", null, entry.joint), `: ${entry.rows.join(", ")}`),
            ),
          ),
          h(
            "p",
            { class: "help" },
            t(
              "These rows repeat what others already demand. The run is right, but how their joints share the load is not unique.",
            ),
          ),
        )
      : null,
    report.notes.length > 0
      ? h(
          "div",
          null,
          h("h2", null, t("Notes of the engine")),
          h("ul", null, ...report.notes.map((note) => h("li", null, told(note)))),
        )
      : null,
  );
}
