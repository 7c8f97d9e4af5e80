// Φ_q, the augmented matrix and S: picture, the value under the pointer, what is redundant, and the same as a table.
import { api } from "../../api/client";
import type { Jacobian, SymmetricMatrix } from "../../api/types";
import { h } from "../../core/dom";
import { num, plural, seconds } from "../../core/format";
import { liveQuery } from "../../session/live-query";
import type { Session } from "../../session/session";
import { empty, problemNotice } from "../../ui/notice";
import type { Panel } from "../../ui/panel";
import { liveTable } from "../../ui/table";
import { constantRows, groupOf, type Matrix, ofJacobian, ofSymmetric } from "./matrix";
import { type Cell, matrixPicture } from "./matrix-picture";

const MOST_TABLE_ROWS = 600;
type Which = "jacobian" | "augmented" | "schur";

const ABOUT: Record<Which, string> = {
  jacobian: "Every constraint row, differentiated by every coordinate.",
  augmented:
    "M and Φ_q as the equations of motion join them. Marked places are zero here, and filled when the coordinates are eliminated.",
  schur:
    "What is left when the bodies are eliminated, joint by joint in the order in which the solver takes them. Marked places are zero here, and filled in its factor.",
};

export function matrixTab(session: Session): Panel {
  let which: Which = "jacobian";
  let matrix: Matrix | undefined;
  let cell: Cell | undefined;

  const readout = h("output", { class: "readout", "aria-live": "polite" });
  const about = h("p", { class: "when" });
  const trouble = h("div");
  const redundant = h("p", { class: "when", hidden: true });
  const select = h(
    "select",
    { class: "field compact" },
    h("option", { value: "jacobian" }, "Jacobian Φ_q"),
    h("option", { value: "augmented" }, "augmented matrix, with fill"),
    h("option", { value: "schur" }, "solver’s matrix S, with fill"),
  );
  const explained = h("p", { class: "help" });
  const picture = matrixPicture(
    (at) => {
      cell = at;
      read();
    },
    (row) => {
      const joint = jointOf(session, matrix?.rows[row] ?? "");
      if (joint) session.select(session.joint === joint ? null : joint);
    },
  );
  const table = liveTable(
    "Entries that are not zero by structure",
    "Row",
    [
      { label: "Column", number: false },
      { label: "Value", number: true },
      { label: "Kind", number: false },
    ],
    true,
  );
  const list = h("details", { class: "as-table" }, h("summary", null, "The same as a table"), table.root);
  list.addEventListener("toggle", () => fillTable());

  const read = (): void => {
    if (!matrix || !cell) {
      readout.replaceChildren(
        "Point at a cell, or walk with the arrow keys. A click, or Enter, marks the joint that the row belongs to, here and in the view.",
      );
      return;
    }
    const [row, column] = [matrix.rows[cell.row] ?? "", matrix.columns[cell.column] ?? ""];
    const entry = matrix.at(cell.row, cell.column);
    const name =
      which === "jacobian"
        ? [h("span", null, "∂ ", h("b", null, row), " / ∂ ", h("b", null, column))]
        : [h("b", null, row), " with ", h("b", null, column)];
    readout.replaceChildren(
      ...name,
      " = ",
      h("b", { class: "readout-value" }, entry && entry.kind !== "fill" ? num(entry.value, 7) : "0"),
      h("span", { class: "readout-kind" }, entry ? KINDS[entry.kind] : "always zero"),
    );
  };

  const fillTable = (): void => {
    if (!matrix || !list.open) return;
    const { rows, columns, entries } = matrix;
    table.update(
      entries.slice(0, MOST_TABLE_ROWS).map((entry) => ({
        head: rows[entry.row] ?? "",
        cells: [columns[entry.column] ?? "", num(entry.value, 7), KINDS[entry.kind]],
      })),
    );
  };

  const show = (): void => {
    if (matrix) picture.show(matrix, session.joint);
  };
  const source = liveQuery<Jacobian | SymmetricMatrix>(
    session,
    (run, at) => (which === "jacobian" ? api.jacobian(run, at) : api.symmetric(run, which, at)),
    (value) => {
      matrix = "columns" in value ? ofJacobian(value) : ofSymmetric(value);
      const none = matrix.rows.length === 0;
      trouble.replaceChildren(
        ...(none
          ? [empty("No constraints", "This scene has no constraint rows, so there is no matrix to show.")]
          : []),
      );
      about.textContent = "columns" in value ? aboutJacobian(value) : aboutSymmetric(value);
      sayRedundant(redundant, value);
      show();
      read();
      fillTable();
    },
    (error) => trouble.replaceChildren(problemNotice(error)),
    () => which,
  );
  select.addEventListener("change", () => {
    which = select.value as Which;
    explained.textContent = ABOUT[which];
    cell = undefined;
    source.refresh();
  });
  explained.textContent = ABOUT[which];

  const root = h(
    "div",
    { class: "stack" },
    h("div", { class: "switches" }, h("label", { class: "switch" }, h("span", null, "Matrix"), select)),
    h(
      "div",
      { class: "matrix-head" },
      explained,
      about,
      h(
        "ul",
        { class: "legend" },
        swatch("is-plus", "positive"),
        swatch("is-minus", "negative"),
        swatch("is-framed", "framed: constant"),
        swatch("is-row", "constant row"),
        swatch("is-fill", "fill"),
        swatch("is-redundant", "too many rows"),
      ),
    ),
    redundant,
    trouble,
    picture.root,
    readout,
    list,
  );
  read();
  return {
    root,
    refresh: () => {
      show();
      source.refresh();
    },
  };
}

/** The joint that a row of Φ_q, or a multiplier, belongs to. */
function jointOf(session: Session, row: string): string | undefined {
  const group = groupOf(row).group.replace(/^λ /, "");
  return session.latest?.forces.find((entry) => entry.joint === group)?.joint;
}

const KINDS = {
  own: "changes with q",
  constant: "constant",
  changing: "changes with q",
  fill: "zero here, filled in the factor",
};

const swatch = (kind: string, words: string): HTMLElement =>
  h("li", null, h("span", { class: `swatch ${kind}`, "aria-hidden": "true" }), words);

function aboutJacobian(value: Jacobian): string {
  const places = value.rows.length * value.columns.length;
  const constant = constantRows(value).filter(Boolean).length;
  return `${plural(value.rows.length, "row")} (${constant} constant), rank ${value.rank}, ${plural(value.columns.length, "column")}, ${value.entries.length} entries, ${num(places > 0 ? (100 * value.entries.length) / places : 0, 3)} % filled, at ${seconds(value.time)}.`;
}

function aboutSymmetric(value: SymmetricMatrix): string {
  const own = value.places.length - value.fill;
  return `${plural(value.names.length, "row")}, ${own} entries on and below the diagonal, ${value.fill} more by fill, at ${seconds(value.time)}.`;
}

function sayRedundant(place: HTMLElement, value: Jacobian | SymmetricMatrix): void {
  const sets = "redundant" in value ? value.redundant : [];
  place.hidden = sets.length === 0;
  if (!("columns" in value)) return;
  place.replaceChildren(
    h("b", null, "Too many: "),
    sets
      .map((set) => {
        const names = set.rows.map((row) => value.rows[row] ?? "");
        return set.rows.length === set.dependent
          ? names.join(", ")
          : `${set.dependent} of ${names.join(", ")}`;
      })
      .join("; "),
    ".",
  );
}
