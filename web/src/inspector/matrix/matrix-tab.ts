// Φ_q, the augmented matrix and S: picture, the value under the pointer, redundant rows, and the same as a table.

import { api } from "../../api/client";
import type { Jacobian, SymmetricMatrix } from "../../api/types";
import { h } from "../../core/dom";
import { num, seconds } from "../../core/format";
import { parts, t } from "../../core/texts";
import { type LiveQuery, liveQuery } from "../../session/live-query";
import type { Session } from "../../session/session";
import { empty, problemNotice } from "../../ui/notice";
import type { Panel } from "../../ui/panel";
import { liveTable } from "../../ui/table";
import { constantRows, groupOf, type Matrix, ofJacobian, ofSymmetric } from "./matrix";
import { type Cell, MatrixPicture } from "./matrix-picture";

/** Entries that the table shows at most. */
const MAX_TABLE_ROWS = 600;
type Which = "jacobian" | "augmented" | "schur";

const ABOUT: Record<Which, () => string> = {
  jacobian: () => t("Every constraint row, differentiated by every coordinate."),
  augmented: () =>
    t(
      "M and Φ_q as the equations of motion join them. Marked places are zero here, and filled when the coordinates are eliminated.",
    ),
  schur: () =>
    t(
      "What is left when the bodies are eliminated, joint by joint in the order in which the solver takes them. Marked places are zero here, and filled in its factor.",
    ),
};

const KINDS = {
  own: () => t("changes with q"),
  constant: () => t("constant"),
  changing: () => t("changes with q"),
  fill: () => t("zero here, filled in the factor"),
};

export class MatrixTab implements Panel {
  readonly root: HTMLElement;
  private readonly select = h(
    "select",
    { class: "field compact" },
    h("option", { value: "jacobian" }, t("Jacobian Φ_q")),
    h("option", { value: "augmented" }, t("augmented matrix, with fill")),
    h("option", { value: "schur" }, t("solver’s matrix S, with fill")),
  );
  private readonly explained = h("p", { class: "help" });
  private readonly about = h("p", { class: "when" });
  private readonly redundant = h("ul", { class: "when redundant-rows", hidden: true });
  private readonly trouble = h("div");
  private readonly readout = h("output", { class: "readout stays", "aria-live": "polite" });
  private readonly picture = new MatrixPicture(
    (cell) => {
      this.cell = cell;
      this.read();
    },
    (row) => this.selectJointOf(row),
  );
  private readonly table = liveTable(
    t("Entries that are not zero by structure"),
    t("Row"),
    [
      { label: t("Column"), number: false },
      { label: t("Value"), number: true },
      { label: t("Kind"), number: false },
    ],
    true,
  );
  private readonly list = h(
    "details",
    { class: "as-table" },
    h("summary", null, t("The same as a table")),
    this.table.root,
  );
  private readonly source: LiveQuery;

  private which: Which = "jacobian";
  private matrix: Matrix | undefined;
  /** The cell that is pointed at. */
  private cell: Cell | undefined;

  constructor(private readonly session: Session) {
    this.source = liveQuery<Jacobian | SymmetricMatrix>(
      session,
      (run, at) => (this.which === "jacobian" ? api.jacobian(run, at) : api.symmetric(run, this.which, at)),
      (value) => this.show(value),
      (error) => this.trouble.replaceChildren(problemNotice(error)),
      () => this.which,
    );
    this.list.addEventListener("toggle", () => this.fillTable());
    this.select.addEventListener("change", () => this.change(this.select.value as Which));
    this.explained.textContent = ABOUT[this.which]();
    this.root = this.layout();
    this.read();
  }

  refresh(): void {
    this.draw();
    this.source.refresh();
  }

  private layout(): HTMLElement {
    return h(
      "div",
      { class: "stack" },
      h(
        "div",
        { class: "switches" },
        h("label", { class: "switch" }, h("span", null, t("Matrix")), this.select),
        this.about,
      ),
      this.trouble,
      this.picture.root,
      // Stays in sight while the matrix is; what explains it stands below, so that both are seen with the mechanism.
      this.readout,
      this.redundant,
      h(
        "div",
        { class: "matrix-head" },
        this.explained,
        h(
          "ul",
          { class: "legend" },
          swatch("is-plus", t("positive")),
          swatch("is-minus", t("negative")),
          swatch("is-framed", t("framed: constant")),
          swatch("is-row", t("constant row")),
          swatch("is-fill", t("fill")),
          swatch("is-redundant", t("too many rows")),
        ),
      ),
      this.list,
    );
  }

  private change(which: Which): void {
    this.which = which;
    this.explained.textContent = ABOUT[which]();
    this.cell = undefined;
    this.source.refresh();
  }

  private show(value: Jacobian | SymmetricMatrix): void {
    this.matrix = "columns" in value ? ofJacobian(value) : ofSymmetric(value);
    this.trouble.replaceChildren();
    if (this.matrix.rows.length === 0)
      this.trouble.replaceChildren(
        empty(t("No constraints"), t("This scene has no constraint rows, so there is no matrix to show.")),
      );
    this.about.textContent = "columns" in value ? aboutJacobian(value) : aboutSymmetric(value);
    showRedundant(this.redundant, value);
    this.draw();
    this.read();
    this.fillTable();
  }

  private draw(): void {
    if (this.matrix) this.picture.show(this.matrix, this.session.joint);
  }

  private selectJointOf(row: number): void {
    const joint = jointOf(this.session, this.matrix?.rows[row] ?? "");
    if (joint) this.session.select(this.session.joint === joint ? null : joint);
  }

  /** Reads out the cell that is pointed at. */
  private read(): void {
    const { matrix, cell } = this;
    if (!matrix || !cell) {
      this.readout.replaceChildren(
        t(
          "Point at a cell, or walk with the arrow keys. A click, or Enter, marks the joint that the row belongs to, here and in the view.",
        ),
      );
      return;
    }
    const [row, column] = [matrix.rows[cell.row] ?? "", matrix.columns[cell.column] ?? ""];
    const entry = matrix.at(cell.row, cell.column);
    const name =
      this.which === "jacobian"
        ? [h("span", null, "∂ ", h("b", null, row), " / ∂ ", h("b", null, column))]
        : parts("{row} with {column}", { row: h("b", null, row), column: h("b", null, column) });
    this.readout.replaceChildren(
      h("span", null, ...name),
      " = ",
      h("b", { class: "readout-value" }, entry && entry.kind !== "fill" ? num(entry.value, 7) : "0"),
      h("span", { class: "readout-kind" }, entry ? KINDS[entry.kind]() : t("always zero")),
    );
  }

  private fillTable(): void {
    if (!this.matrix || !this.list.open) return;
    const { rows, columns, entries } = this.matrix;
    this.table.update(
      entries.slice(0, MAX_TABLE_ROWS).map((entry) => ({
        head: rows[entry.row] ?? "",
        cells: [columns[entry.column] ?? "", num(entry.value, 7), KINDS[entry.kind]()],
      })),
    );
  }
}

/** The joint that a row of Φ_q, or a multiplier, belongs to. */
function jointOf(session: Session, row: string): string | undefined {
  const group = groupOf(row).group.replace(/^λ /, "");
  return session.latest?.forces.find((entry) => entry.joint === group)?.joint;
}

const swatch = (kind: string, words: string): HTMLElement =>
  h("li", null, h("span", { class: `swatch ${kind}`, "aria-hidden": "true" }), words);

function aboutJacobian(value: Jacobian): string {
  const places = value.rows.length * value.columns.length;
  const constant = constantRows(value).filter(Boolean).length;
  const filled = places > 0 ? (100 * value.entries.length) / places : 0;
  return [
    t("{rows} ({constant} constant)", { rows: t("{n} row | {n} rows", { n: value.rows.length }), constant }),
    t("rank {rank}", { rank: value.rank }),
    t("{n} column | {n} columns", { n: value.columns.length }),
    t("{entries} entries", { entries: value.entries.length }),
    t("{filled} % filled", { filled: num(filled, 3) }),
    t("at {time}.", { time: seconds(value.time) }),
  ].join(", ");
}

function aboutSymmetric(value: SymmetricMatrix): string {
  const own = value.places.length - value.fill;
  return [
    t("{n} row | {n} rows", { n: value.names.length }),
    t("{own} entries on and below the diagonal", { own }),
    t("{fill} more by fill", { fill: value.fill }),
    t("at {time}.", { time: seconds(value.time) }),
  ].join(", ");
}

function showRedundant(place: HTMLElement, value: Jacobian | SymmetricMatrix): void {
  const sets = "redundant" in value ? value.redundant : [];
  place.hidden = sets.length === 0;
  if (!("columns" in value)) return;
  place.replaceChildren(
    ...sets.map(({ rows, dependent: n }) => {
      const names = rows.map((row) => value.rows[row] ?? "").join(", ");
      return h(
        "li",
        null,
        rows.length === n
          ? t("This row is redundant: {names}. | These {n} rows are redundant: {names}.", { n, names })
          : t(
              "One of these {rows} rows is redundant: {names}. | {n} of these {rows} rows are redundant: {names}.",
              { n, rows: rows.length, names },
            ),
      );
    }),
  );
}
