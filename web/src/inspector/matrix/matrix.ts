// Layout of a sparse matrix on paper: sizes, groups of names, which cell is under a point.

import type { Jacobian, MatrixPart, SymmetricMatrix } from "../../api/types";

export interface Group {
  name: string;
  from: number;
  count: number;
}

/** Names such as "pin: x" or "bob.u_x" share what stands before the separator. */
export function groupOf(name: string): { group: string; rest: string } {
  if (name.startsWith("λ ")) {
    const of = groupOf(name.slice(2));
    return { ...of, group: `λ ${of.group}` };
  }
  const match = /^(.+?)(?::\s*|\s+·\s+|\.|\/|\s+)(.+)$/.exec(name);
  return match ? { group: match[1] ?? name, rest: match[2] ?? "" } : { group: name, rest: "" };
}

export function groups(names: string[]): Group[] {
  const found: Group[] = [];
  names.forEach((name, at) => {
    const { group } = groupOf(name);
    const last = found.at(-1);
    if (last?.name === group) last.count += 1;
    else found.push({ name: group, from: at, count: 1 });
  });
  return found;
}

export interface Layout {
  cell: number;
  left: number;
  top: number;
  width: number;
  height: number;
  /** Single names fit beside the cells. */
  named: boolean;
}

/** Largest side of a cell, px. */
const MAX_CELL = 26;
/** Smallest side of a cell, px. */
const MIN_CELL = 3;
/** Cells from this side on have their own names beside them, px. */
const MIN_NAMED = 13;
/** Margin for the names of rows, px. */
const LEFT = { wide: 168, narrow: 92 };
/** Margin for the names of columns, px. */
const TOP = { named: 78, groups: 26 };

/** Fits the matrix to a width; single names are drawn where cells are large enough for them. */
export function layout(rows: number, columns: number, width: number, wide: boolean): Layout {
  const left = wide ? LEFT.wide : LEFT.narrow;
  const fit = Math.floor((width - left - 2) / Math.max(1, columns));
  const cell = Math.max(MIN_CELL, Math.min(MAX_CELL, fit));
  const named = cell >= MIN_NAMED;
  const top = named ? TOP.named : TOP.groups;
  return { cell, left, top, named, width: left + cell * columns + 2, height: top + cell * rows + 2 };
}

export function cellAt(
  grid: Layout,
  rows: number,
  columns: number,
  x: number,
  y: number,
): { row: number; column: number } | undefined {
  const column = Math.floor((x - grid.left) / grid.cell);
  const row = Math.floor((y - grid.top) / grid.cell);
  if (row < 0 || column < 0 || row >= rows || column >= columns) return undefined;
  return { row, column };
}

export interface Entry {
  row: number;
  column: number;
  value: number;
  kind: MatrixPart;
}

/** A sparse matrix as it is drawn. */
export interface Matrix {
  rows: string[];
  columns: string[];
  entries: Entry[];
  constantRows: boolean[];
  /** Rows that belong to a set of which some are too many. */
  redundant: Set<number>;
  at: (row: number, column: number) => Entry | undefined;
}

function indexed(
  rows: string[],
  columns: string[],
  entries: Entry[],
  constantRows: boolean[],
  redundant: Set<number>,
): Matrix {
  const places = new Map(entries.map((entry) => [entry.row * columns.length + entry.column, entry]));
  return {
    rows,
    columns,
    entries,
    constantRows,
    redundant,
    at: (row, column) => places.get(row * columns.length + column),
  };
}

export function ofJacobian(jacobian: Jacobian): Matrix {
  const entries = jacobian.entries.map(
    ([row, column, value, constant]): Entry => ({
      row,
      column,
      value,
      kind: constant ? "constant" : "changing",
    }),
  );
  return indexed(
    jacobian.rows,
    jacobian.columns,
    entries,
    constantRows(jacobian),
    new Set(jacobian.redundant.flatMap((set) => set.rows)),
  );
}

/** Both halves of a symmetric matrix. */
export function ofSymmetric(matrix: SymmetricMatrix): Matrix {
  const entries = matrix.places.flatMap(([row, column, value, kind]): Entry[] =>
    row === column
      ? [{ row, column, value, kind }]
      : [
          { row, column, value, kind },
          { row: column, column: row, value, kind },
        ],
  );
  return indexed(
    matrix.names,
    matrix.names,
    entries,
    matrix.names.map(() => false),
    new Set(),
  );
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
