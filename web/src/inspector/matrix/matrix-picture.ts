// A sparse matrix as a picture: filled where a value changes, framed where it is constant, hatched where a factor fills.
import { h } from "../../core/dom";
import { onTheme } from "../../core/prefs";
import { cellAt, groupOf, groups, type Layout, layout, type Matrix } from "./matrix";

export interface Cell {
  row: number;
  column: number;
}

export interface Picture {
  root: HTMLElement;
  show: (matrix: Matrix, marked: string | null) => void;
  dispose: () => void;
}

const KEYS: Record<string, [number, number]> = {
  ArrowUp: [-1, 0],
  ArrowDown: [1, 0],
  ArrowLeft: [0, -1],
  ArrowRight: [0, 1],
};

/** `read` hears of the cell that is pointed at, `choose` of a row that is clicked or entered. */
export function matrixPicture(
  read: (cell: Cell | undefined) => void,
  choose: (row: number) => void,
): Picture {
  const canvas = h("canvas", {
    class: "matrix",
    tabindex: "0",
    "data-keys": "own",
    role: "application",
    "aria-roledescription": "matrix picture",
    "aria-label":
      "Matrix: arrow keys move from cell to cell, the value is read out below; Enter selects the joint of a row",
  });
  const holder = h("div", { class: "matrix-holder" }, canvas);
  let matrix: Matrix | undefined;
  let marked: string | null = null;
  let grid: Layout | undefined;
  let at: Cell | undefined;

  const draw = (): void => {
    const context = canvas.getContext("2d");
    const room = holder.clientWidth;
    if (!matrix || !context || room === 0) return;
    const { rows, columns, entries, constantRows, redundant } = matrix;
    grid = layout(rows.length, columns.length, room, room > 620);
    const sharp = devicePixelRatio || 1;
    canvas.width = Math.round(grid.width * sharp);
    canvas.height = Math.round(grid.height * sharp);
    canvas.style.inlineSize = `${grid.width}px`;
    canvas.style.blockSize = `${grid.height}px`;
    context.scale(sharp, sharp);
    const css = getComputedStyle(canvas);
    const color = (name: string): string => css.getPropertyValue(name).trim();
    const font = (size: number): string => `${size}px ${css.fontFamily}`;
    const { cell, left, top } = grid;

    context.fillStyle = color("--surface-2");
    context.fillRect(left, top, cell * columns.length, cell * rows.length);
    constantRows.forEach((yes, row) => {
      if (!yes) return;
      context.fillStyle = color("--constant-band");
      context.fillRect(left, top + row * cell, cell * columns.length, cell);
      context.fillStyle = color("--constant");
      context.fillRect(left - 5, top + row * cell + 1, 3, cell - 2);
    });

    for (const row of redundant) {
      context.fillStyle = color("--warn");
      context.fillRect(left + cell * columns.length - 1, top + row * cell + 1, 3, cell - 2);
    }

    const largest = entries.reduce((most, entry) => Math.max(most, Math.abs(entry.value)), 1e-12);
    const gap = cell >= 8 ? 1.5 : 0.25;
    for (const { row, column, value, kind } of entries) {
      const fixed = kind === "constant";
      const x = left + column * cell + gap;
      const y = top + row * cell + gap;
      const size = cell - 2 * gap;
      if (kind === "fill") {
        context.fillStyle = color("--fill");
        context.fillRect(x, y, size, size);
        continue;
      }
      if (value === 0) {
        context.strokeStyle = color("--ink-3");
        context.lineWidth = 1;
        context.strokeRect(x + size / 2 - 1.5, y + size / 2 - 1.5, 3, 3);
        continue;
      }
      context.globalAlpha = fixed && cell >= 8 ? 1 : 0.35 + 0.65 * Math.sqrt(Math.abs(value) / largest);
      const tone = color(value > 0 ? "--plus" : "--minus");
      context.fillStyle = tone;
      if (fixed && cell >= 8) {
        context.strokeStyle = tone;
        context.lineWidth = 2;
        context.strokeRect(x + 1, y + 1, size - 2, size - 2);
      } else context.fillRect(x, y, size, size);
      context.globalAlpha = 1;
      if (cell >= 16) {
        context.fillStyle = fixed ? tone : color("--surface");
        context.font = font(12);
        context.textAlign = "center";
        context.textBaseline = "middle";
        context.fillText(value > 0 ? "+" : "−", x + size / 2, y + size / 2 + 0.5);
      }
    }

    context.strokeStyle = color("--line-strong");
    context.lineWidth = 1;
    context.fillStyle = color("--ink-2");
    context.textBaseline = "middle";
    for (const group of groups(rows)) {
      const y = top + group.from * cell;
      line(context, 0, y, left + cell * columns.length, y);
      if (group.name === marked || group.name === `λ ${marked ?? ""}`) {
        context.lineWidth = 2;
        context.strokeStyle = color("--accent");
        context.strokeRect(1, y + 1, left + cell * columns.length - 1, group.count * cell - 2);
        context.lineWidth = 1;
        context.strokeStyle = color("--line-strong");
      }
      context.textAlign = "left";
      context.font = font(12);
      if (!grid.named || group.count === 1)
        text(
          context,
          group.count === 1 && grid.named ? (rows[group.from] ?? "") : group.name,
          0,
          y + (group.count * cell) / 2,
          left - 10,
        );
      else text(context, group.name, 0, y + cell / 2, left * 0.46);
    }
    for (const group of groups(columns)) {
      const x = left + group.from * cell;
      line(context, x, 0, x, top + cell * rows.length);
      context.textAlign = "left";
      context.font = font(12);
      text(context, group.name, x + 4, 9, group.count * cell - 6);
    }
    if (grid.named) {
      context.fillStyle = color("--ink-3");
      context.font = font(11);
      context.textAlign = "right";
      rows.forEach((name, row) => {
        const { rest } = groupOf(name);
        if (rest) text(context, rest, left - 9, top + (row + 0.5) * cell, left * 0.5);
      });
      columns.forEach((name, column) => {
        context.save();
        context.translate(left + (column + 0.5) * cell, top - 6);
        context.rotate(-Math.PI / 2);
        context.textAlign = "left";
        text(context, groupOf(name).rest || name, 0, 0, top - 26);
        context.restore();
      });
    }
    if (at) {
      context.strokeStyle = color("--focus");
      context.lineWidth = 2;
      context.strokeRect(left + at.column * cell, top + at.row * cell, cell, cell);
      context.globalAlpha = 0.35;
      context.strokeRect(left, top + at.row * cell, cell * columns.length, cell);
      context.strokeRect(left + at.column * cell, top, cell, cell * rows.length);
      context.globalAlpha = 1;
    }
  };

  const moveTo = (cell: Cell | undefined): void => {
    if (at?.row === cell?.row && at?.column === cell?.column) return;
    at = cell;
    read(cell);
    draw();
  };
  canvas.addEventListener("pointermove", (event) => {
    if (!matrix || !grid) return;
    const box = canvas.getBoundingClientRect();
    moveTo(
      cellAt(
        grid,
        matrix.rows.length,
        matrix.columns.length,
        event.clientX - box.left,
        event.clientY - box.top,
      ),
    );
  });
  canvas.addEventListener("click", () => {
    if (at) choose(at.row);
  });
  canvas.addEventListener("pointerleave", () => moveTo(undefined));
  canvas.addEventListener("keydown", (event) => {
    const move = KEYS[event.key];
    if (event.key === "Enter" && at) {
      event.preventDefault();
      choose(at.row);
    }
    if (!move || !matrix) return;
    event.preventDefault();
    const from = at ?? { row: 0, column: 0 };
    const clamp = (value: number, most: number): number => Math.max(0, Math.min(most - 1, value));
    moveTo(
      at
        ? {
            row: clamp(from.row + move[0], matrix.rows.length),
            column: clamp(from.column + move[1], matrix.columns.length),
          }
        : from,
    );
  });
  const sized = new ResizeObserver(draw);
  sized.observe(holder);
  const untheme = onTheme(() => requestAnimationFrame(draw));

  return {
    root: holder,
    show: (value, mark) => {
      marked = mark;
      matrix = value;
      draw();
    },
    dispose: () => {
      sized.disconnect();
      untheme();
    },
  };
}

function line(context: CanvasRenderingContext2D, x1: number, y1: number, x2: number, y2: number): void {
  context.beginPath();
  context.moveTo(x1, Math.round(y1) + 0.5);
  context.lineTo(x2, Math.round(y2) + 0.5);
  if (x1 === x2) {
    context.beginPath();
    context.moveTo(Math.round(x1) + 0.5, y1);
    context.lineTo(Math.round(x2) + 0.5, y2);
  }
  context.stroke();
}

/** Text that ends with … where it does not fit. */
function text(context: CanvasRenderingContext2D, words: string, x: number, y: number, room: number): void {
  if (room < 8) return;
  let shown = words;
  while (shown.length > 1 && context.measureText(shown).width > room)
    shown = `${shown.slice(0, shown.endsWith("…") ? -2 : -1)}…`;
  context.fillText(shown, x, y);
}
