// The drawing on the first page: a spatial loop with the frame (u, v, w) of one of its bodies.
import { svg } from "../core/dom";

export function heroDrawing(): SVGSVGElement {
  const line = (x1: number, y1: number, x2: number, y2: number, cls: string): SVGLineElement =>
    svg("line", { x1, y1, x2, y2, class: cls });
  const dot = (cx: number, cy: number, r: number, cls: string): SVGCircleElement =>
    svg("circle", { cx, cy, r, class: cls });
  const label = (x: number, y: number, text: string): SVGTextElement =>
    svg("text", { x, y, class: "hero-label" }, text);
  // The hinges of the loop, and the centre of mass of its coupler, in units of the drawing.
  const A = [86, 262] as const;
  const B = [150, 92] as const;
  const C = [356, 66] as const;
  const D = [404, 262] as const;
  const G = [253, 79] as const;

  const hatch = (x: number): SVGGElement =>
    svg(
      "g",
      { class: "hero-ground" },
      line(x - 26, 278, x + 26, 278, ""),
      ...[-20, -8, 4, 16].map((d) => line(x + d, 278, x + d - 8, 288, "")),
    );

  return svg(
    "svg",
    { viewBox: "0 0 490 310", class: "hero-drawing", "aria-hidden": "true" },
    svg(
      "g",
      { class: "hero-grid" },
      ...[60, 110, 160, 210, 260].map((y) => line(20, y, 470, y, "")),
      ...[40, 90, 140, 190, 240, 290, 340, 390, 440].map((x) => line(x, 36, x, 286, "")),
    ),
    svg("path", { d: "M150 92A182 182 0 0 1 256 190", class: "hero-path" }),
    hatch(A[0]),
    hatch(D[0]),
    svg("path", {
      d: `M${A[0]} ${A[1]}L72 278M${A[0]} ${A[1]}L100 278M${D[0]} ${D[1]}L390 278M${D[0]} ${D[1]}L418 278`,
      class: "hero-ground",
    }),
    line(A[0], A[1], B[0], B[1], "hero-rod"),
    line(B[0], B[1], C[0], C[1], "hero-rod"),
    line(C[0], C[1], D[0], D[1], "hero-rod"),
    ...[A, B, C, D].map(([x, y]) => dot(x, y, 8, "hero-joint")),
    arrow(G[0], G[1], 84, -10.6, "hero-u"),
    arrow(G[0], G[1], -9, -72, "hero-v"),
    arrow(G[0], G[1], -46, 40, "hero-w"),
    dot(G[0], G[1], 5, "hero-origin"),
    label(G[0] + 82, G[1] - 22, "u"),
    label(G[0] - 30, G[1] - 60, "v"),
    label(G[0] - 64, G[1] + 44, "w"),
  );
}

/** Length of an arrow's head, in units of the drawing. */
const HEAD = 11;
/** Half the width of an arrow's head, in units of the drawing. */
const HALF_HEAD = 4.6;
/** The shaft ends this far before the tip, inside the head, in units of the drawing. */
const SHAFT_END = 8;

function arrow(x: number, y: number, dx: number, dy: number, cls: string): SVGGElement {
  const length = Math.hypot(dx, dy);
  const [ex, ey] = [dx / length, dy / length];
  const [tx, ty] = [x + dx, y + dy];
  const [nx, ny] = [tx - ex * HEAD, ty - ey * HEAD];
  const left = `${nx - ey * HALF_HEAD} ${ny + ex * HALF_HEAD}`;
  const right = `${nx + ey * HALF_HEAD} ${ny - ex * HALF_HEAD}`;
  return svg(
    "g",
    { class: cls },
    svg("line", { x1: x, y1: y, x2: tx - ex * SHAFT_END, y2: ty - ey * SHAFT_END }),
    svg("path", { d: `M${tx} ${ty}L${left}L${right}Z` }),
  );
}
