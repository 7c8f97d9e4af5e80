// Every number of the scene, and the choices that are words: for those who want to change what the author did not offer.

import { at, leaves } from "../api/numbers";
import type { AfterChange } from "../api/types";
import { h, setText } from "../core/dom";
import { plural } from "../core/format";
import type { Session } from "../session/session";

const MAX_ROWS = 120;
const INTEGRATORS = [
  ["auto", "Chosen by the engine"],
  ["taylor", "Taylor series"],
  ["dop853", "Dormand and Prince, order 8"],
  ["dopri5", "Dormand and Prince, order 5"],
  ["ode45", "Step control of MATLAB's ode45"],
  ["radau", "Radau IIA, order 5: stiff"],
  ["rattle", "RATTLE, order 6: long runs"],
];
const TREATMENTS: Record<string, Record<string, unknown>> = {
  projection: { kind: "projection" },
  baumgarte: { kind: "baumgarte", alpha: 10, beta: 10 },
  partitioning: { kind: "partitioning" },
  penalty: { kind: "penalty", alpha: 1e7, omega: 10, mu: 1 },
  "augmented-lagrangian": { kind: "augmented-lagrangian", alpha: 1e9 },
};

type Set = (pointer: string, value: unknown, then: AfterChange) => void;

export function expertPanel(session: Session, set: Set): { root: HTMLElement; refresh: () => void } {
  const filter = h("input", {
    type: "search",
    class: "field compact",
    placeholder: "Find, such as bob mass",
    "aria-label": "Find a number of the scene",
  });
  const then = h(
    "select",
    { class: "field compact" },
    h("option", { value: "restart" }, "start over"),
    h("option", { value: "continue" }, "go on"),
  );
  const choices = h("div", { class: "expert-choices" });
  const body = h("tbody");
  const said = h("p", { class: "help", role: "status" });
  const after = (): AfterChange => then.value as AfterChange;
  let shown: unknown;

  const paint = (): void => {
    const scene = session.view?.scene;
    if (!scene || !root.open) return;
    shown = scene;
    choices.replaceChildren(
      choice("Integrator", INTEGRATORS, String(at(scene, "/simulation/integrator")), (value) =>
        set("/simulation/integrator", value, after()),
      ),
      choice(
        "Coordinates",
        [
          ["full", "12 a body (full)"],
          ["reduced", "9 a body (reduced)"],
          ["shared", "shared at revolute joints"],
        ],
        String(at(scene, "/coordinates")),
        (value) => set("/coordinates", value, "restart"),
      ),
      choice(
        "Constraints kept by",
        [
          ["projection", "projection"],
          ["baumgarte", "Baumgarte"],
          ["partitioning", "partitioning of the coordinates"],
          ["penalty", "penalties"],
          ["augmented-lagrangian", "augmented Lagrangian"],
        ],
        String(at(scene, "/simulation/stabilization/kind")),
        (value) => set("/simulation/stabilization", TREATMENTS[value] ?? { kind: "projection" }, after()),
      ),
    );
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const all = leaves(scene).filter((leaf) =>
      words.every((word) => leaf.label.toLowerCase().includes(word)),
    );
    body.replaceChildren(
      ...all.slice(0, MAX_ROWS).map((leaf) => {
        const changed = at(session.view?.original, leaf.pointer) !== leaf.value;
        const field = h("input", {
          type: "text",
          inputmode: "decimal",
          autocomplete: "off",
          class: "field number compact",
          value: String(leaf.value),
          "aria-label": leaf.label,
        });
        field.addEventListener("change", () => {
          const value = Number(field.value.trim().replace(",", ".").replace("−", "-"));
          const good = field.value.trim() !== "" && Number.isFinite(value);
          field.setAttribute("aria-invalid", String(!good));
          if (good) set(leaf.pointer, value, after());
        });
        return h(
          "tr",
          { class: changed ? "is-changed" : "" },
          h("th", { scope: "row", title: leaf.pointer }, leaf.label),
          h("td", null, field),
        );
      }),
    );
    setText(
      said,
      all.length > MAX_ROWS
        ? `The first ${MAX_ROWS} of ${all.length} numbers: find others by their names.`
        : plural(all.length, "number"),
    );
  };
  filter.addEventListener("input", paint);
  const root = h(
    "details",
    { class: "expert" },
    h("summary", null, "All numbers of this scene"),
    h(
      "div",
      { class: "stack" },
      choices,
      h(
        "div",
        { class: "row wrap" },
        filter,
        h("label", { class: "switch" }, h("span", null, "After a change the run should"), then),
      ),
      said,
      h(
        "div",
        { class: "table-scroll", tabindex: "0", role: "region", "aria-label": "All numbers of this scene" },
        h(
          "table",
          { class: "data expert-table" },
          h(
            "thead",
            { class: "visually-hidden" },
            h("tr", null, h("th", { scope: "col" }, "Number"), h("th", { scope: "col" }, "Value")),
          ),
          body,
        ),
      ),
    ),
  );
  root.addEventListener("toggle", paint);

  return {
    root,
    refresh: () => {
      if (session.view?.scene !== shown) paintKeeping(body, paint);
    },
  };
}

/** The rows are made anew after a change; whoever stands in one with the keyboard stays there. */
function paintKeeping(body: HTMLElement, paint: () => void): void {
  const label =
    document.activeElement instanceof HTMLInputElement && body.contains(document.activeElement)
      ? document.activeElement.getAttribute("aria-label")
      : null;
  paint();
  if (label === null) return;
  for (const field of body.querySelectorAll("input"))
    if (field.getAttribute("aria-label") === label) field.focus({ preventScroll: true });
}

function choice(
  label: string,
  options: string[][],
  value: string,
  changed: (value: string) => void,
): HTMLElement {
  const select = h(
    "select",
    { class: "field compact" },
    ...options.map(([key, text]) => h("option", { value: key ?? "", selected: key === value }, text ?? "")),
  );
  select.addEventListener("change", () => changed(select.value));
  return h("label", { class: "switch" }, h("span", null, label), select);
}
