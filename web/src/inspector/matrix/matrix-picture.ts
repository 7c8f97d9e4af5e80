// A sparse matrix as a picture that is pointed at, or walked through by arrow keys.

import { h } from "../../core/dom";
import { t } from "../../core/texts";
import { onTheme } from "../../core/theme";
import { cellAt, type Layout, layout, type Matrix } from "./matrix";
import { type Cell, Painter } from "./painter";

export type { Cell };

/** Rows and columns by which a key moves. */
const MOVES: Record<string, [number, number]> = {
  ArrowUp: [-1, 0],
  ArrowDown: [1, 0],
  ArrowLeft: [0, -1],
  ArrowRight: [0, 1],
};
/** From this width on the names of rows have a wide margin, px. */
const WIDE = 620;

export class MatrixPicture {
  private readonly canvas = h("canvas", {
    class: "matrix",
    tabindex: "0",
    "data-keys": "own",
    role: "application",
    "aria-roledescription": t("matrix picture"),
    "aria-label": t(
      "Matrix: arrow keys move from cell to cell, the value is read out above; Enter selects the joint of a row",
    ),
  });
  readonly root = h("div", { class: "matrix-holder" }, this.canvas);
  private matrix: Matrix | undefined;
  private marked: string | null = null;
  private grid: Layout | undefined;
  private at: Cell | undefined;

  /** `read` hears of the cell that is pointed at, `choose` of a row that is clicked or entered. */
  constructor(
    private readonly read: (cell: Cell | undefined) => void,
    private readonly choose: (row: number) => void,
  ) {
    const { canvas } = this;
    canvas.addEventListener("pointermove", (event) => this.pointAt(event));
    canvas.addEventListener("pointerleave", () => this.moveTo(undefined));
    canvas.addEventListener("click", () => this.at && this.choose(this.at.row));
    canvas.addEventListener("keydown", (event) => this.press(event));
    new ResizeObserver(() => this.draw()).observe(this.root);
    onTheme(() => requestAnimationFrame(() => this.draw()));
  }

  /** Shows a matrix; the rows of `marked` are framed. */
  show(matrix: Matrix, marked: string | null): void {
    this.matrix = matrix;
    this.marked = marked;
    this.draw();
  }

  private draw(): void {
    const { canvas, matrix } = this;
    const context = canvas.getContext("2d");
    const width = this.root.clientWidth;
    if (!matrix || !context || width === 0) return;
    this.grid = layout(matrix.rows.length, matrix.columns.length, width, width > WIDE);
    const sharp = devicePixelRatio || 1;
    canvas.width = Math.round(this.grid.width * sharp);
    canvas.height = Math.round(this.grid.height * sharp);
    canvas.style.inlineSize = `${this.grid.width}px`;
    canvas.style.blockSize = `${this.grid.height}px`;
    context.scale(sharp, sharp);
    new Painter(context, matrix, this.grid).paint(this.marked, this.at);
  }

  private moveTo(cell: Cell | undefined): void {
    if (this.at?.row === cell?.row && this.at?.column === cell?.column) return;
    this.at = cell;
    this.read(cell);
    this.draw();
  }

  private pointAt(event: PointerEvent): void {
    const { matrix, grid } = this;
    if (!matrix || !grid) return;
    const box = this.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    this.moveTo(cellAt(grid, matrix.rows.length, matrix.columns.length, x, y));
  }

  private press(event: KeyboardEvent): void {
    const { at, matrix } = this;
    if (event.key === "Enter" && at) {
      event.preventDefault();
      this.choose(at.row);
    }
    const move = MOVES[event.key];
    if (!move || !matrix) return;
    event.preventDefault();
    const clamp = (value: number, count: number): number => Math.max(0, Math.min(count - 1, value));
    this.moveTo(
      at
        ? {
            row: clamp(at.row + move[0], matrix.rows.length),
            column: clamp(at.column + move[1], matrix.columns.length),
          }
        : { row: 0, column: 0 },
    );
  }
}
