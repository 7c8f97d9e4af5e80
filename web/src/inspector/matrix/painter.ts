// Paints a sparse matrix on a canvas: filled where a value changes, framed where it is constant, hatched where a factor
// fills, with the names of its rows and columns.
import { type Entry, groupOf, groups, type Layout, type Matrix } from "./matrix";

export interface Cell {
  row: number;
  column: number;
}

/** Cells from this size on show frames and gaps, px. */
const MIN_FRAMED = 8;
/** Cells from this size on show the sign of their value, px. */
const MIN_SIGNED = 16;
/** The smallest value is painted as opaque as this; the largest is solid. */
const MIN_OPACITY = 0.35;
/** Opacity of the row and the column of the cell that is pointed at. */
const CROSSHAIR_OPACITY = 0.35;
/** Width of the bar that marks a constant row or a redundant one, px. */
const BAR = 3;
/** Side of the little square in place of a zero, px. */
const ZERO = 3;
/** Smaller than any entry that matters: keeps a matrix of zeros from a division by zero. */
const TINY = 1e-12;
/** Size of the names of groups, px. */
const GROUP_TYPE = 12;
/** Size of the names of single rows and columns, px. */
const NAME_TYPE = 11;

export class Painter {
  private readonly css: CSSStyleDeclaration;
  private readonly right: number;
  private readonly bottom: number;

  constructor(
    private readonly context: CanvasRenderingContext2D,
    private readonly matrix: Matrix,
    private readonly grid: Layout,
  ) {
    this.css = getComputedStyle(context.canvas);
    this.right = grid.left + grid.cell * matrix.columns.length;
    this.bottom = grid.top + grid.cell * matrix.rows.length;
  }

  /** `marked` is the group of rows that is selected, `pointed` the cell that is pointed at. */
  paint(marked: string | null, pointed: Cell | undefined): void {
    this.background();
    this.redundantRows();
    this.entries();
    this.rowGroups(marked);
    this.columnGroups();
    if (this.grid.named) this.names();
    if (pointed) this.crosshair(pointed);
  }

  private color(name: string): string {
    return this.css.getPropertyValue(name).trim();
  }

  private setFont(size: number): void {
    this.context.font = `${size}px ${this.css.fontFamily}`;
  }

  private background(): void {
    const { context, right, bottom } = this;
    const { cell, left, top } = this.grid;
    context.fillStyle = this.color("--surface-2");
    context.fillRect(left, top, right - left, bottom - top);
    this.matrix.constantRows.forEach((constant, row) => {
      if (!constant) return;
      context.fillStyle = this.color("--constant-band");
      context.fillRect(left, top + row * cell, right - left, cell);
      context.fillStyle = this.color("--constant");
      context.fillRect(left - BAR - 2, top + row * cell + 1, BAR, cell - 2);
    });
  }

  private redundantRows(): void {
    const { cell, top } = this.grid;
    this.context.fillStyle = this.color("--warn");
    for (const row of this.matrix.redundant)
      this.context.fillRect(this.right - 1, top + row * cell + 1, BAR, cell - 2);
  }

  private entries(): void {
    const { entries } = this.matrix;
    const largest = entries.reduce((most, entry) => Math.max(most, Math.abs(entry.value)), TINY);
    for (const entry of entries) this.entry(entry, largest);
  }

  private entry({ row, column, value, kind }: Entry, largest: number): void {
    const { context } = this;
    const { cell, left, top } = this.grid;
    const gap = cell >= MIN_FRAMED ? 1.5 : 0.25;
    const x = left + column * cell + gap;
    const y = top + row * cell + gap;
    const size = cell - 2 * gap;
    if (kind === "fill") {
      context.fillStyle = this.color("--fill");
      context.fillRect(x, y, size, size);
      return;
    }
    if (value === 0) {
      context.strokeStyle = this.color("--ink-3");
      context.lineWidth = 1;
      context.strokeRect(x + (size - ZERO) / 2, y + (size - ZERO) / 2, ZERO, ZERO);
      return;
    }
    const framed = kind === "constant" && cell >= MIN_FRAMED;
    const tone = this.color(value > 0 ? "--plus" : "--minus");
    if (framed) {
      context.strokeStyle = tone;
      context.lineWidth = 2;
      context.strokeRect(x + 1, y + 1, size - 2, size - 2);
    } else {
      context.globalAlpha = MIN_OPACITY + (1 - MIN_OPACITY) * Math.sqrt(Math.abs(value) / largest);
      context.fillStyle = tone;
      context.fillRect(x, y, size, size);
      context.globalAlpha = 1;
    }
    if (cell < MIN_SIGNED) return;
    context.fillStyle = kind === "constant" ? tone : this.color("--surface");
    this.setFont(GROUP_TYPE);
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillText(value > 0 ? "+" : "−", x + size / 2, y + size / 2 + 0.5);
  }

  private rowGroups(marked: string | null): void {
    const { context, right } = this;
    const { cell, left, top, named } = this.grid;
    const { rows } = this.matrix;
    context.fillStyle = this.color("--ink-2");
    context.textBaseline = "middle";
    context.textAlign = "left";
    this.setFont(GROUP_TYPE);
    for (const group of groups(rows)) {
      const y = top + group.from * cell;
      this.line(0, y, right, y);
      if (group.name === marked || group.name === `λ ${marked ?? ""}`) {
        context.lineWidth = 2;
        context.strokeStyle = this.color("--accent");
        context.strokeRect(1, y + 1, right - 1, group.count * cell - 2);
      }
      const single = group.count === 1;
      if (named && !single) this.text(group.name, 0, y + cell / 2, left * 0.46);
      else {
        const name = single && named ? (rows[group.from] ?? "") : group.name;
        this.text(name, 0, y + (group.count * cell) / 2, left - 10);
      }
    }
  }

  private columnGroups(): void {
    const { cell, left } = this.grid;
    this.context.textAlign = "left";
    this.setFont(GROUP_TYPE);
    for (const group of groups(this.matrix.columns)) {
      const x = left + group.from * cell;
      this.line(x, 0, x, this.bottom);
      this.text(group.name, x + 4, 9, group.count * cell - 6);
    }
  }

  /** The names of single rows and columns, without that of their group. */
  private names(): void {
    const { context } = this;
    const { cell, left, top } = this.grid;
    context.fillStyle = this.color("--ink-3");
    this.setFont(NAME_TYPE);
    context.textAlign = "right";
    this.matrix.rows.forEach((name, row) => {
      const { rest } = groupOf(name);
      if (rest) this.text(rest, left - 9, top + (row + 0.5) * cell, left * 0.5);
    });
    context.textAlign = "left";
    this.matrix.columns.forEach((name, column) => {
      context.save();
      context.translate(left + (column + 0.5) * cell, top - 6);
      context.rotate(-Math.PI / 2);
      this.text(groupOf(name).rest || name, 0, 0, top - 26);
      context.restore();
    });
  }

  private crosshair({ row, column }: Cell): void {
    const { context, right, bottom } = this;
    const { cell, left, top } = this.grid;
    context.strokeStyle = this.color("--focus");
    context.lineWidth = 2;
    context.strokeRect(left + column * cell, top + row * cell, cell, cell);
    context.globalAlpha = CROSSHAIR_OPACITY;
    context.strokeRect(left, top + row * cell, right - left, cell);
    context.strokeRect(left + column * cell, top, cell, bottom - top);
    context.globalAlpha = 1;
  }

  /** A thin line along a row or a column, on whole pixels. */
  private line(x1: number, y1: number, x2: number, y2: number): void {
    const { context } = this;
    context.strokeStyle = this.color("--line-strong");
    context.lineWidth = 1;
    context.beginPath();
    if (x1 === x2) {
      context.moveTo(Math.round(x1) + 0.5, y1);
      context.lineTo(Math.round(x2) + 0.5, y2);
    } else {
      context.moveTo(x1, Math.round(y1) + 0.5);
      context.lineTo(x2, Math.round(y2) + 0.5);
    }
    context.stroke();
  }

  /** Text that ends with … where it does not fit. */
  private text(words: string, x: number, y: number, width: number): void {
    if (width < 8) return;
    let shown = words;
    while (shown.length > 1 && this.context.measureText(shown).width > width)
      shown = `${shown.slice(0, shown.endsWith("…") ? -2 : -1)}…`;
    this.context.fillText(shown, x, y);
  }
}
