// The reaction of one joint, stated completely: on which body, about which point, in which frame, unique or not; and the
// multipliers that it is made of.

import type { Reaction, Vec3 } from "../../api/types";
import { h } from "../../core/dom";
import { num } from "../../core/format";
import { t } from "../../core/texts";
import { norm } from "../../mechanics/vec";
import { aboutIn, frameIn } from "./wording";

/** A reaction with its multipliers. */
export interface JointReaction extends Reaction {
  rows: { label: string; value: number }[];
}

/** The card of a joint; `toggle` selects it, or no joint. */
export function card(entry: JointReaction, selected: boolean, toggle: () => void): HTMLElement {
  const at = entry.about_at.map((part) => num(tidy(part, entry.about_at), 4)).join(", ");
  const about = t("moment about {about} at ({at}) m", { about: aboutIn(entry.about), at });
  return h(
    "article",
    { class: selected ? "joint is-selected" : "joint" },
    h(
      "h3",
      null,
      h(
        "button",
        {
          type: "button",
          class: "joint-select",
          "aria-pressed": String(selected),
          title: t("Draw its force, mark its rows in the Jacobian"),
          onclick: toggle,
        },
        entry.joint,
      ),
      entry.driver ? h("span", { class: "help" }, " ", t("driver")) : null,
    ),
    h(
      "p",
      { class: "convention" },
      t("On {on}, from {by}; {about}; components in {expressed_in}.", {
        on: entry.on,
        by: entry.by,
        about,
        expressed_in: frameIn(entry.expressed_in),
      }),
    ),
    componentTable(entry),
    entry.rows.length > 0 ? multiplierList(entry) : null,
  );
}

/** Force and moment, component by component. */
function componentTable(entry: JointReaction): HTMLElement {
  const axes = entry.expressed_in.includes("world")
    ? ["x", "y", "z"]
    : entry.expressed_in.includes("joint")
      ? ["1", "2", "3"]
      : ["u", "v", "w"];
  return h(
    "div",
    {
      class: "table-scroll",
      tabindex: "0",
      role: "region",
      "aria-label": t("Reaction of {joint}", { joint: entry.joint }),
    },
    h(
      "table",
      { class: "data" },
      h(
        "thead",
        { class: "visually-hidden" },
        h(
          "tr",
          null,
          h("th", { scope: "col" }, t("Quantity")),
          ...axes.map((axis) => h("th", { scope: "col" }, axis)),
          h("th", { scope: "col" }, t("Size")),
        ),
      ),
      h("tbody", null, componentRow(entry, "force", axes, "N"), componentRow(entry, "moment", axes, "N m")),
    ),
  );
}

function componentRow(
  entry: JointReaction,
  of: "force" | "moment",
  axes: string[],
  unit: string,
): HTMLElement {
  const symbol = of === "force" ? "F" : "M";
  const parts = entry[of];
  // A moment beside the force, with an arm of a metre: less is rounding.
  const all = values([...entry.force, ...entry.moment]);
  const size = norm(values(parts) as Vec3);
  return h(
    "tr",
    null,
    h("th", { scope: "row" }, of === "force" ? t("Force") : t("Moment")),
    ...parts.map((part, k) =>
      h(
        "td",
        { class: part.unique ? "number" : "number is-shared", title: part.unique ? "" : t("Not unique") },
        h("span", { class: "component-name" }, `${symbol}${axes[k]} `),
        part.unique ? "" : "≈ ",
        num(tidy(part.value, all), 6),
        part.unique ? null : h("span", { class: "visually-hidden" }, " ", t("not unique")),
      ),
    ),
    h("td", { class: "number strong" }, `${num(tidy(size, all), 6)} `, h("span", { class: "unit" }, unit)),
  );
}

function multiplierList({ joint, rows }: JointReaction): HTMLElement {
  return h(
    "ul",
    { class: "lambdas", "aria-label": t("Multipliers of {joint}", { joint }) },
    ...rows.map((row) =>
      h("li", null, h("span", null, row.label), h("b", null, `λ = ${num(tidy(row.value, values(rows)), 6)}`)),
    ),
  );
}

export const values = (parts: { value: number }[]): number[] => parts.map((part) => part.value);

/** Values below this part of the largest beside them are rounding: a few times the precision of a double. */
const ROUNDING = 1e-14;

/** Zero where a value is only rounding beside the other ones. */
export function tidy(value: number, beside: number[]): number {
  const largest = Math.max(...beside.map(Math.abs));
  return Math.abs(value) < ROUNDING * largest ? 0 : value;
}
