// Notices: a problem, an empty list, text that is still loading, the banner over the page.

import { problemOf } from "../api/client";
import type { Problem } from "../api/types";
import { type Child, h } from "../core/dom";
import { t } from "../core/texts";
import { told } from "../core/told";
import { icon } from "./icons";

export interface Action {
  label: string;
  run: () => void;
}

export interface PointerLink {
  /** Called with a JSON pointer such as /joints/0/axis. */
  open: (pointer: string) => void;
}

/** A problem with words of the page's own in it, which are in the reader's language already. */
export interface SaidProblem extends Problem {
  said?: ("title" | "detail" | "hint")[];
}

/** A problem as the server reports it: what, where, and what to try. */
export function problemNotice(error: unknown, actions: Action[] = [], link?: PointerLink): HTMLElement {
  const problem: SaidProblem = problemOf(error);
  // What has no code is the page's own.
  const words = (which: "title" | "detail" | "hint", text: string): Node =>
    problem.code && !problem.said?.includes(which) ? told(text) : document.createTextNode(text);
  const places = (problem.errors ?? []).filter((place) => place.detail !== problem.detail || place.pointer);
  return h(
    "section",
    { class: "notice is-problem", role: "alert" },
    icon("warn"),
    h(
      "div",
      { class: "notice-body" },
      h("p", { class: "notice-title" }, words("title", problem.title)),
      problem.detail && problem.detail !== problem.title
        ? h("p", null, words("detail", problem.detail))
        : null,
      places.length > 0
        ? h(
            "ul",
            { class: "places" },
            ...places.map((place) =>
              h(
                "li",
                null,
                pointer(place.pointer, link),
                ...(place.detail === problem.detail ? [] : [" ", words("detail", place.detail)]),
              ),
            ),
          )
        : null,
      problem.hint
        ? h(
            "p",
            { class: "notice-hint" },
            h("strong", null, t("What to try:")),
            " ",
            words("hint", problem.hint),
          )
        : null,
      actions.length > 0
        ? h(
            "div",
            { class: "notice-actions" },
            ...actions.map((action) =>
              h("button", { type: "button", class: "button", onclick: action.run }, action.label),
            ),
          )
        : null,
      // It helps whoever runs the server to find what failed there.
      problem.trace_id && (problem.status ?? 500) >= 500
        ? h("p", { class: "notice-trace" }, t("Trace {trace_id}", { trace_id: problem.trace_id }))
        : null,
    ),
  );
}

function pointer(path: string | undefined, link?: PointerLink): Child {
  if (!path) return null;
  const shown = path.replace(/^#/, "") || "/";
  if (!link) return h("code", null, shown);
  return h(
    "button",
    {
      type: "button",
      class: "pointer",
      title: t("Show this place in the scene"),
      onclick: () => link.open(shown),
    },
    shown,
  );
}

export function note(...children: Child[]): HTMLElement {
  return h(
    "section",
    { class: "notice is-note" },
    icon("info"),
    h("div", { class: "notice-body" }, ...children),
  );
}

export function empty(title: string, text: string, ...more: Child[]): HTMLElement {
  return h("div", { class: "empty" }, h("p", { class: "empty-title" }, title), h("p", null, text), ...more);
}

/** Grey lines in place of text that is still loading. */
export function skeleton(lines: number): HTMLElement {
  const widths = [92, 100, 97, 64, 99, 88, 95, 52];
  return h(
    "div",
    { class: "skeleton", "aria-hidden": "true" },
    ...Array.from({ length: lines }, (_, k) =>
      h("span", { style: `inline-size:${widths[k % widths.length]}%` }),
    ),
  );
}

const slot = (): HTMLElement | null => document.getElementById("banner");

/** Shows a line over everything; null removes it. */
export function banner(text: string | null, ...actions: Action[]): void {
  const place = slot();
  if (!place) return;
  if (text === null) {
    place.replaceChildren();
    return;
  }
  place.replaceChildren(
    h(
      "div",
      { class: "banner", role: "status" },
      icon("warn"),
      h("span", null, text),
      ...actions.map((action) =>
        h("button", { type: "button", class: "button small", onclick: action.run }, action.label),
      ),
    ),
  );
}
