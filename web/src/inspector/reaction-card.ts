// The reaction of one joint, stated completely: on which body, about which point, in which frame, unique or not; and the
// multipliers that it is made of.
import type { Reaction, ReactionComponent, Vec3 } from "../api/types";
import { h } from "../core/dom";
import { num } from "../core/format";
import { norm } from "../mechanics/vec";

/** A reaction with its multipliers. */
export interface JointReaction extends Reaction {
  rows: { label: string; value: number }[];
}

export function card(entry: JointReaction, selected: boolean, toggle: () => void): HTMLElement {
  const axes = entry.expressed_in.includes("world")
    ? ["x", "y", "z"]
    : entry.expressed_in.includes("joint")
      ? ["1", "2", "3"]
      : ["u", "v", "w"];
  // A moment beside the force, with an arm of a metre: less is rounding.
  const all = values([...entry.force, ...entry.moment]);
  const row = (label: string, symbol: string, parts: ReactionComponent[], unit: string): HTMLElement =>
    h(
      "tr",
      null,
      h("th", { scope: "row" }, label),
      ...parts.map((part, k) =>
        h(
          "td",
          { class: part.unique ? "number" : "number is-shared", title: part.unique ? "" : "Not unique" },
          h("span", { class: "component-name" }, `${symbol}${axes[k]} `),
          part.unique ? "" : "≈ ",
          num(tidy(part.value, all), 6),
          part.unique ? null : h("span", { class: "visually-hidden" }, " not unique"),
        ),
      ),
      h(
        "td",
        { class: "number strong" },
        `${num(tidy(norm(parts.map((part) => part.value) as Vec3), all), 6)} `,
        h("span", { class: "unit" }, unit),
      ),
    );

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
          title: "Draw its force, mark its rows in the Jacobian",
          onclick: toggle,
        },
        entry.joint,
      ),
      entry.driver ? h("span", { class: "help" }, " driver") : null,
    ),
    h(
      "p",
      { class: "said" },
      `On ${entry.on}, from ${entry.by}; moment about ${entry.about} at (${entry.about_at.map((part) => num(tidy(part, entry.about_at), 4)).join(", ")}) m; components in ${entry.expressed_in}.`,
    ),
    h(
      "div",
      { class: "table-scroll", tabindex: "0", role: "region", "aria-label": `Reaction of ${entry.joint}` },
      h(
        "table",
        { class: "data" },
        h(
          "thead",
          { class: "visually-hidden" },
          h(
            "tr",
            null,
            h("th", { scope: "col" }, "Quantity"),
            ...axes.map((axis) => h("th", { scope: "col" }, axis)),
            h("th", { scope: "col" }, "Size"),
          ),
        ),
        h("tbody", null, row("Force", "F", entry.force, "N"), row("Moment", "M", entry.moment, "N m")),
      ),
    ),
    entry.rows.length > 0
      ? h(
          "ul",
          { class: "lambdas", "aria-label": `Multipliers of ${entry.joint}` },
          ...entry.rows.map((one) =>
            h(
              "li",
              null,
              h("span", null, one.label),
              h("b", null, `λ = ${num(tidy(one.value, values(entry.rows)), 6)}`),
            ),
          ),
        )
      : null,
  );
}

const values = (parts: { value: number }[]): number[] => parts.map((part) => part.value);

/** Rounding beside the other components is nothing. */
function tidy(value: number, beside: number[]): number {
  const largest = Math.max(...beside.map(Math.abs));
  return Math.abs(value) < 1e-14 * largest ? 0 : value;
}
