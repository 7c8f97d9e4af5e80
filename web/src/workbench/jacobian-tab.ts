// Φ_q: picture, the value under the pointer, and the same as a table.
import { api } from "../core/api";
import { h } from "../core/dom";
import { num, plural, seconds } from "../core/format";
import type { Jacobian } from "../core/types";
import { empty, problemNotice } from "../ui/notice";
import { liveTable } from "../ui/table";
import { fetched } from "./fetched";
import type { InspectorTab } from "./inspector";
import { jacobianPicture, type Cell } from "./jacobian-picture";
import type { Session } from "./session";

const MOST_TABLE_ROWS = 600;

export function jacobianTab(session: Session): InspectorTab {
  let jacobian: Jacobian | undefined;
  let values = new Map<string, { value: number; constant: boolean }>();
  let cell: Cell | undefined;

  const readout = h("output", { class: "readout", "aria-live": "polite" });
  const about = h("p", { class: "when" });
  const trouble = h("div");
  const picture = jacobianPicture((at) => {
    cell = at;
    read();
  });
  const table = liveTable("Entries of the Jacobian that are not structurally zero", "Row (constraint)", [
    { label: "Column (coordinate)", number: false }, { label: "Value", number: true }, { label: "Kind", number: false },
  ], true);
  const list = h("details", { class: "as-table" }, h("summary", null, "The same as a table"), table.root);
  list.addEventListener("toggle", () => fillTable());

  const read = (): void => {
    if (!jacobian) return;
    if (!cell) {
      readout.replaceChildren("Point at a cell, or walk with the arrow keys.");
      return;
    }
    const row = jacobian.rows[cell.row] ?? "";
    const column = jacobian.columns[cell.column] ?? "";
    const entry = values.get(`${cell.row},${cell.column}`);
    readout.replaceChildren(
      h("span", null, "∂ ", h("b", null, row), " / ∂ ", h("b", null, column)), " = ",
      h("b", { class: "readout-value" }, entry ? num(entry.value, 7) : "0"),
      h("span", { class: "readout-kind" }, entry ? (entry.constant ? "constant" : "changes with q") : "always zero"));
  };

  const fillTable = (): void => {
    if (!jacobian || !list.open) return;
    const { rows, columns, entries } = jacobian;
    table.update(entries.slice(0, MOST_TABLE_ROWS).map(([row, column, value, constant]) => ({
      head: rows[row] ?? String(row),
      cells: [columns[column] ?? String(column), num(value, 7), constant ? "constant" : "changes"],
    })));
  };

  const source = fetched(session, api.jacobian, (value, state) => {
    jacobian = value;
    values = new Map(value.entries.map(([row, column, entry, constant]) => [`${row},${column}`, { value: entry, constant }]));
    const rows = constantRows(value);
    const filled = value.rows.length * value.columns.length;
    trouble.replaceChildren(...(value.rows.length === 0 ? [empty("No constraints", "This scene has no constraint rows, so there is no Jacobian to show.")] : []));
    about.textContent = `${plural(value.rows.length, "row")} (${rows.filter(Boolean).length} constant), ${plural(value.columns.length, "column")}, ${value.entries.length} entries, ${num(filled > 0 ? (100 * value.entries.length) / filled : 0, 3)} % filled, at ${seconds(state.time)}.`;
    picture.show(value, rows, session.joint);
    read();
    fillTable();
  }, (error) => trouble.replaceChildren(problemNotice(error)));

  const root = h("div", { class: "stack" },
    h("div", { class: "matrix-head" }, about,
      h("ul", { class: "legend" },
        h("li", null, h("span", { class: "swatch is-plus", "aria-hidden": "true" }), "positive"),
        h("li", null, h("span", { class: "swatch is-minus", "aria-hidden": "true" }), "negative"),
        h("li", null, h("span", { class: "swatch is-framed", "aria-hidden": "true" }), "framed: constant"),
        h("li", null, h("span", { class: "swatch is-row", "aria-hidden": "true" }), "constant row"))),
    trouble, picture.root, readout, list);
  read();
  return {
    root,
    refresh: () => {
      if (jacobian) picture.show(jacobian, constantRows(jacobian), session.joint);
      source.refresh();
    },
  };
}

/** A row is constant when none of its entries changes. */
export function constantRows(jacobian: Jacobian): boolean[] {
  const constant = new Array<boolean>(jacobian.rows.length).fill(true);
  const filled = new Array<boolean>(jacobian.rows.length).fill(false);
  for (const [row, , , fixed] of jacobian.entries) {
    filled[row] = true;
    if (!fixed) constant[row] = false;
  }
  return constant.map((yes, row) => yes && filled[row] === true);
}
