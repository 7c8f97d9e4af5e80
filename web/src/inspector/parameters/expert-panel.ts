// Every number of the scene, its integrator and its coordinates: for what the author offers no parameter.

import { at, type Leaf, leaves } from "../../api/numbers";
import type { AfterChange } from "../../api/types";
import { h, setText } from "../../core/dom";
import { typedNumber, unclearComma } from "../../core/format";
import { t } from "../../core/texts";
import type { Session } from "../../session/session";
import type { Panel } from "../../ui/panel";

/** Numbers that are shown at a time. */
const MAX_ROWS = 120;
/** The word of a scene, and how it is told. */
type Option = [word: string, told: () => string];
const INTEGRATORS: Option[] = [
  ["auto", () => t("Chosen by the engine")],
  ["taylor", () => t("Taylor series")],
  ["dop853", () => t("Dormand and Prince, order 8")],
  ["dopri5", () => t("Dormand and Prince, order 5")],
  ["ode45", () => t("Step control of MATLAB's ode45")],
  ["radau", () => t("Radau IIA, order 5: stiff")],
  ["rattle", () => t("RATTLE, order 6: long runs")],
];
const COORDINATES: Option[] = [
  ["full", () => t("12 a body (full)")],
  ["reduced", () => t("9 a body (reduced)")],
  ["shared", () => t("shared at revolute joints")],
];
const CONSTRAINT_METHODS: Option[] = [
  ["projection", () => t("projection")],
  ["baumgarte", () => "Baumgarte"],
  ["partitioning", () => t("partitioning of the coordinates")],
  ["penalty", () => t("penalties")],
  ["augmented-lagrangian", () => t("augmented Lagrangian")],
];
/** What is written into the scene for each constraint method, with usual parameters. */
const STABILIZATIONS: Record<string, Record<string, unknown>> = {
  projection: { kind: "projection" },
  baumgarte: { kind: "baumgarte", alpha: 10, beta: 10 },
  partitioning: { kind: "partitioning" },
  penalty: { kind: "penalty", alpha: 1e7, omega: 10, mu: 1 },
  "augmented-lagrangian": { kind: "augmented-lagrangian", alpha: 1e9 },
};

type SetPlace = (pointer: string, value: unknown, then: AfterChange) => void;

export class ExpertPanel implements Panel {
  readonly root: HTMLDetailsElement;
  private readonly filter = h("input", {
    type: "search",
    class: "field compact",
    placeholder: t("Find, such as bob mass"),
    "aria-label": t("Find a number of the scene"),
  });
  /** What the run does after a change. */
  private readonly after = h(
    "select",
    { class: "field compact" },
    h("option", { value: "restart" }, t("start over")),
    h("option", { value: "continue" }, t("go on")),
  );
  private readonly choices = h("div", { class: "expert-choices" });
  private readonly status = h("p", { class: "help", role: "status" });
  private readonly body = h("tbody");
  /** The scene whose numbers are in the table. */
  private shown: unknown;

  /** `set` changes a place of the scene. */
  constructor(
    private readonly session: Session,
    private readonly set: SetPlace,
  ) {
    this.root = this.layout();
    this.filter.addEventListener("input", () => this.paint());
    this.root.addEventListener("toggle", () => this.paint());
  }

  refresh(): void {
    if (this.session.view?.scene === this.shown) return;
    // The rows are made anew; whoever stands in one with the keyboard stays there.
    const focused = document.activeElement;
    const label =
      focused instanceof HTMLInputElement && this.body.contains(focused)
        ? focused.getAttribute("aria-label")
        : null;
    this.paint();
    if (label === null) return;
    for (const field of this.body.querySelectorAll("input"))
      if (field.getAttribute("aria-label") === label) field.focus({ preventScroll: true });
  }

  private layout(): HTMLDetailsElement {
    const columns = [h("th", { scope: "col" }, t("Number")), h("th", { scope: "col" }, t("Value"))];
    return h(
      "details",
      { class: "expert", id: "all-numbers" },
      h("summary", null, t("All numbers of this scene")),
      h(
        "div",
        { class: "stack" },
        this.choices,
        h(
          "div",
          { class: "row wrap" },
          this.filter,
          h("label", { class: "switch" }, h("span", null, t("After a change the run should")), this.after),
        ),
        this.status,
        h(
          "div",
          {
            class: "table-scroll",
            tabindex: "0",
            role: "region",
            "aria-label": t("All numbers of this scene"),
          },
          h(
            "table",
            { class: "data expert-table" },
            h("thead", { class: "visually-hidden" }, h("tr", null, ...columns)),
            this.body,
          ),
        ),
      ),
    );
  }

  private paint(): void {
    const scene = this.session.view?.scene;
    if (!scene || !this.root.open) return;
    this.shown = scene;
    this.paintChoices(scene);
    const words = this.filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const found = leaves(scene).filter((leaf) =>
      words.every((word) => leaf.label.toLowerCase().includes(word)),
    );
    this.body.replaceChildren(...found.slice(0, MAX_ROWS).map((leaf) => this.row(leaf)));
    setText(
      this.status,
      found.length > MAX_ROWS
        ? t("The first {shown} of {found} numbers: find others by their names.", {
            shown: MAX_ROWS,
            found: found.length,
          })
        : t("{n} number | {n} numbers", { n: found.length }),
    );
  }

  private paintChoices(scene: unknown): void {
    const then = (): AfterChange => this.after.value as AfterChange;
    this.choices.replaceChildren(
      choice(t("Integrator"), INTEGRATORS, String(at(scene, "/simulation/integrator")), (value) =>
        this.set("/simulation/integrator", value, then()),
      ),
      choice(t("Coordinates"), COORDINATES, String(at(scene, "/coordinates")), (value) =>
        this.set("/coordinates", value, "restart"),
      ),
      choice(
        t("Constraints kept by"),
        CONSTRAINT_METHODS,
        String(at(scene, "/simulation/stabilization/kind")),
        (value) =>
          this.set("/simulation/stabilization", STABILIZATIONS[value] ?? { kind: "projection" }, then()),
      ),
    );
  }

  private row(leaf: Leaf): HTMLElement {
    const changed = at(this.session.view?.original, leaf.pointer) !== leaf.value;
    const field = h("input", {
      type: "text",
      inputmode: "decimal",
      autocomplete: "off",
      class: "field number compact",
      value: String(leaf.value),
      "aria-label": leaf.label,
    });
    field.addEventListener("change", () => {
      const value = typedNumber(field.value);
      field.setAttribute("aria-invalid", String(!Number.isFinite(value)));
      if (Number.isFinite(value)) this.set(leaf.pointer, value, this.after.value as AfterChange);
      else
        setText(
          this.status,
          unclearComma(field.value) ?? t("“{text}” is not a number.", { text: field.value }),
        );
    });
    return h(
      "tr",
      { class: changed ? "is-changed" : "" },
      h("th", { scope: "row", title: leaf.pointer }, leaf.label),
      h("td", null, field),
    );
  }
}

function choice(
  label: string,
  options: Option[],
  value: string,
  changed: (value: string) => void,
): HTMLElement {
  const select = h(
    "select",
    { class: "field compact" },
    ...options.map(([key, text]) => h("option", { value: key, selected: key === value }, text())),
  );
  select.addEventListener("change", () => changed(select.value));
  return h("label", { class: "switch" }, h("span", null, label), select);
}
