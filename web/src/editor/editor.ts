// A scene as text: line numbers, checked as one types, errors at their place.
import { ApiError, api } from "../api/client";
import type { CheckReport, Problem } from "../api/types";
import { h } from "../core/dom";
import { plural } from "../core/format";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import { lineOf, locate } from "./pointer";
import { suggestions } from "./suggest";

const CHECK_AFTER_MS = 600;

export interface Editor {
  root: HTMLElement;
  text: () => string;
  set: (text: string) => void;
  dispose: () => void;
}

/** `sound` is called with a text that the server has checked and can run. */
export function sceneEditor(changed: (text: string) => void, sound: (text: string) => void): Editor {
  const area = h("textarea", {
    class: "code",
    spellcheck: "false",
    autocapitalize: "off",
    autocomplete: "off",
    wrap: "off",
    "aria-label": "Scene, JSON",
    rows: "24",
  });
  const gutter = h("div", { class: "gutter", "aria-hidden": "true" });
  const result = h("div", { class: "check", "aria-live": "polite" });
  let timer = 0;
  let asking = new AbortController();

  const number = (): void => {
    const lines = area.value.split("\n").length;
    if (gutter.childElementCount === lines) return;
    gutter.replaceChildren(...Array.from({ length: lines }, (_, k) => h("span", null, String(k + 1))));
  };

  const goTo = (pointer: string): void => {
    const offset = locate(area.value, pointer);
    area.focus();
    area.setSelectionRange(offset, endOfValue(area.value, offset));
    const line = lineOf(area.value, offset);
    area.scrollTop = Math.max(0, (line - 6) * lineHeight(area));
    mark(new Set([line]));
  };
  const mark = (lines: Set<number>): void => {
    for (const [k, child] of [...gutter.children].entries())
      child.classList.toggle("is-marked", lines.has(k + 1));
  };

  const check = async (): Promise<void> => {
    asking.abort();
    asking = new AbortController();
    mark(new Set());
    const text = area.value;
    const broken = syntaxProblem(text);
    if (broken) {
      mark(new Set([broken.line]));
      result.replaceChildren(problemNotice(broken.problem));
      return;
    }
    try {
      const report = await api.check(text, asking.signal);
      result.replaceChildren(reportView(report));
      sound(text);
    } catch (error) {
      if (asking.signal.aborted) return;
      if (error instanceof ApiError) {
        mark(
          new Set(
            (error.problem.errors ?? []).flatMap((place) =>
              place.pointer ? [lineOf(text, locate(text, place.pointer))] : [],
            ),
          ),
        );
      }
      result.replaceChildren(problemNotice(error, [], { open: goTo }));
    }
  };
  const soon = (): void => {
    number();
    clearTimeout(timer);
    timer = window.setTimeout(() => void check(), CHECK_AFTER_MS);
  };

  area.addEventListener("input", () => {
    changed(area.value);
    soon();
  });
  area.addEventListener("scroll", () => {
    gutter.style.transform = `translateY(${-area.scrollTop}px)`;
  });

  return {
    root: h(
      "div",
      { class: "editor" },
      h(
        "div",
        { class: "code-box" },
        h("div", { class: "gutter-box" }, gutter),
        area,
        suggestions(area, () => area.dispatchEvent(new Event("input"))),
      ),
      result,
    ),
    text: () => area.value,
    set: (text) => {
      area.value = text;
      number();
      void check();
    },
    dispose: () => {
      clearTimeout(timer);
      asking.abort();
    },
  };
}

function lineHeight(area: HTMLTextAreaElement): number {
  return Number.parseFloat(getComputedStyle(area).lineHeight) || 20;
}

function endOfValue(text: string, offset: number): number {
  const rest = /^(?:"(?:[^"\\]|\\.)*"|[^,\]}\n]+)/.exec(text.slice(offset));
  return offset + (rest?.[0].trimEnd().length ?? 1);
}

/** Text that is not JSON never leaves the page: the browser knows the place already. */
function syntaxProblem(text: string): { problem: Problem; line: number } | undefined {
  try {
    JSON.parse(text);
    return undefined;
  } catch (error) {
    const message = error instanceof Error ? error.message : String(error);
    const position = /position (\d+)/.exec(message)?.[1];
    const line = position
      ? lineOf(text, Number(position))
      : /line (\d+)/.exec(message)?.[1]
        ? Number(/line (\d+)/.exec(message)?.[1])
        : text.split("\n").length;
    return {
      line,
      problem: {
        title: `Line ${line} is not JSON yet`,
        detail: message.replace(/ in JSON at position.*$/, ""),
        hint: "Look for a missing comma, quote or bracket just before this place.",
      },
    };
  }
}

function reportView(report: CheckReport): HTMLElement {
  const figure = (label: string, value: number): HTMLElement =>
    h("div", { class: "figure" }, h("dt", null, label), h("dd", null, String(value)));
  const redundant = report.redundant.reduce((sum, entry) => sum + entry.rows.length, 0);
  return h(
    "section",
    { class: "report", "aria-label": "Result of the check" },
    h(
      "p",
      { class: "report-title" },
      icon("check"),
      `This scene can run. It has ${plural(report.degrees_of_freedom, "degree")} of freedom.`,
    ),
    h(
      "dl",
      { class: "figures" },
      figure("Bodies", report.bodies),
      figure("Coordinates", report.coordinates),
      figure("Rows", report.rows),
      figure("Rank", report.rank),
      figure("Degrees of freedom", report.degrees_of_freedom),
      figure("Redundant rows", redundant),
    ),
    report.redundant.length > 0
      ? h(
          "div",
          null,
          h("h2", null, "Redundant rows"),
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
            "These rows repeat what others already demand. The run is right, but how their joints share the load is not unique.",
          ),
        )
      : null,
    report.notes.length > 0
      ? h(
          "div",
          null,
          h("h2", null, "Notes of the engine"),
          h("ul", null, ...report.notes.map((note) => h("li", null, note))),
        )
      : null,
  );
}
