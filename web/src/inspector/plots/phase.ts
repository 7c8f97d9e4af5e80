// Quantities over each other in place of time: phase plots and hodographs.

import type { SessionState } from "../../api/types";
import { t } from "../../core/texts";
import type { Chart, Curve } from "./charts";
import type { Overlay } from "./overlay";
import { lonely, type Samples } from "./samples";
import { type Colors, disc, JOIN_DASH, legendEntry, mesh, openSvg } from "./svg-file";

/** A way through a plane. */
export interface Way {
  label: string;
  color: string;
  dash: number[];
  x: number[];
  y: number[];
  /** Between which points a line only joins. */
  apart: boolean[];
  /** Where it is at the moment that is shown. */
  now?: [number, number];
}

export interface PhasePlot {
  title: string;
  /** What the axes show. */
  axes: [string, string];
  /** Both axes have one scale. */
  equal: boolean;
  ways: Way[];
}

const COLORS = ["--curve-1", "--curve-2", "--curve-3"];
const KEPT_DASH = [3, 5];
/** Width of an entry of the legend, px. */
const LEGEND_ENTRY = 150;

/** The plot of a chart whose quantities stand over each other; kept runs beside the run. */
export function phasePlot(chart: Chart, samples: Samples, now: SessionState, kept?: Overlay): PhasePlot {
  const across = chart.across ?? [];
  const pairs = chart.curves.map((curve, k): [Curve, Curve] => [across[k] ?? curve, curve]);
  const ways = pairs.flatMap(([x, y], k): Way[] => {
    const label = t("{y} over {x}", { x: x.label, y: y.label });
    const color = COLORS[k % COLORS.length] ?? "--ink";
    const own: Way = {
      label,
      color,
      dash: [],
      x: samples.of(x),
      y: samples.of(y),
      apart: samples.apart,
      now: [x.of(now), y.of(now)],
    };
    const [kx, ky] = [kept?.of(chart, x, k), kept?.of(chart, y, k)];
    if (!kept || !kx || !ky) return [own];
    return [
      own,
      {
        label: `${label}, ${kept.short}`,
        color,
        dash: KEPT_DASH,
        x: kx.values,
        y: ky.values,
        apart: kx.apart,
      },
    ];
  });
  const [x, y] = pairs[0] ?? [];
  return { title: chart.label, axes: [x?.unit ?? "", y?.unit ?? ""], equal: x?.unit === y?.unit, ways };
}

/** Where the values of a plot lie on a picture. */
export function scales(
  plot: PhasePlot,
  width: number,
  height: number,
): { x: (v: number) => number; y: (v: number) => number; ranges: [Range, Range] } {
  const place = frame(width, height);
  let ranges = (["x", "y"] as const).map((axis) => rangeOf(plot.ways.flatMap((way) => way[axis]))) as [
    Range,
    Range,
  ];
  if (plot.equal) {
    const per = Math.max(
      (ranges[0][1] - ranges[0][0]) / (place.right - place.left),
      (ranges[1][1] - ranges[1][0]) / (place.bottom - place.top),
    );
    const widened = ([low, high]: Range, length: number): Range => {
      const [middle, half] = [(low + high) / 2, (per * length) / 2];
      return [middle - half, middle + half];
    };
    ranges = [widened(ranges[0], place.right - place.left), widened(ranges[1], place.bottom - place.top)];
  }
  const [[x0, x1], [y0, y1]] = ranges;
  return {
    x: (v) => place.left + ((v - x0) / (x1 - x0)) * (place.right - place.left),
    y: (v) => place.bottom - ((v - y0) / (y1 - y0)) * (place.bottom - place.top),
    ranges,
  };
}

type Range = [number, number];

const frame = (
  width: number,
  height: number,
): { left: number; right: number; top: number; bottom: number } => ({
  left: 70,
  right: width - 16,
  top: 40,
  bottom: height - 44,
});

/** The values with a little room about them. */
function rangeOf(values: number[]): Range {
  const known = values.filter(Number.isFinite);
  const [low, high] = [Math.min(...known, Infinity), Math.max(...known, -Infinity)];
  if (!(high > low)) return Number.isFinite(low) ? [low - 1, low + 1] : [-1, 1];
  const room = 0.05 * (high - low);
  return [low - room, high + room];
}

/** The plot as an SVG file, or for the page. */
export function phaseSvg(
  plot: PhasePlot,
  colors: Colors,
  color: (name: string) => string,
  width: number,
  height: number,
): string {
  const { x, y, ranges } = scales(plot, width, height);
  const place = frame(width, height);
  const drawn = plot.ways.map((way) => {
    const points = way.x
      .map((value, k): Point => [x(value), y(way.y[k] ?? NaN), k])
      .filter(([a, b]) => Number.isFinite(a) && Number.isFinite(b));
    const ink = color(way.color);
    const start =
      points[0] && !way.dash.length
        ? disc(points[0][0], points[0][1], 3, `fill="${colors.paper}" stroke="${ink}" stroke-width="1.5"`)
        : "";
    const now = way.now?.every(Number.isFinite)
      ? disc(x(way.now[0]), y(way.now[1]), 5, `fill="${ink}" stroke="${colors.paper}" stroke-width="1.5"`)
      : "";
    return line(way, points, ink) + start + now;
  });
  return [
    openSvg(plot.title, width, height, 13, colors),
    ...mesh(place, ranges, { x, y }, plot.axes, colors),
    ...drawn,
    ...plot.ways.flatMap((way, k) =>
      legendEntry({ ...way, unit: "", color: color(way.color) }, place.left + k * LEGEND_ENTRY, 22, colors),
    ),
    "</svg>\n",
  ].join("");
}

/** A point of the picture, px, and which sample it is of. */
type Point = [x: number, y: number, sample: number];

/**
 * A line through all points. Where samples lie close it has no corners: between two it is bent as its neighbours ask (Catmull and
 * Rom). Those that are far apart are marked, and joined straight.
 */
function line({ apart, dash }: Way, points: Point[], ink: string): string {
  if (points.length < 2) return "";
  const joined = (k: number): boolean => apart[(points[k]?.[2] ?? 0) - 1] === true;
  const written = (...numbers: number[]): string => numbers.map((value) => value.toFixed(1)).join(" ");
  const at = (k: number): Point => points[k] ?? [0, 0, 0];
  const parts = points.slice(1).map(([x2, y2], before) => {
    const [k, [x1, y1]] = [before + 1, at(before)];
    if (joined(k)) return { join: `M${written(x1, y1)}L${written(x2, y2)}`, bend: `M${written(x2, y2)}` };
    // What lies beyond a gap asks for no bend.
    const [x0, y0] = k < 2 || joined(k - 1) ? [x1, y1] : at(k - 2);
    const [x3, y3] = k + 1 >= points.length || joined(k + 1) ? [x2, y2] : at(k + 1);
    const ends = written(
      x1 + (x2 - x0) / 6,
      y1 + (y2 - y0) / 6,
      x2 - (x3 - x1) / 6,
      y2 - (y3 - y1) / 6,
      x2,
      y2,
    );
    return { join: "", bend: `C${ends}` };
  });
  const path = (d: string, width: number, dashes: number[], more = ""): string =>
    `<path${more} d="${d}" fill="none" stroke="${ink}" stroke-width="${width}"` +
    `${dashes.length > 0 ? ` stroke-dasharray="${dashes.join(" ")}"` : ""}/>`;
  const bends = `M${written(at(0)[0], at(0)[1])}${parts.map(({ bend }) => bend).join("")}`;
  const joins = parts.map(({ join }) => join).join("");
  const alone = new Set(lonely(apart));
  const marks = points.filter(([, , k]) => alone.has(k)).map(([x, y]) => disc(x, y, 2, `fill="${ink}"`));
  return path(bends, 2, dash) + (joins && path(joins, 1, JOIN_DASH, ' class="join"')) + marks.join("");
}

/** Which of the moments is nearest to a point of the picture. */
export function nearest(
  plot: PhasePlot,
  width: number,
  height: number,
  [px, py]: [number, number],
): number | undefined {
  const { x, y } = scales(plot, width, height);
  let best: { k: number; off: number } | undefined;
  for (const way of plot.ways.filter(({ now }) => now))
    for (const [k, value] of way.x.entries()) {
      const off = Math.hypot(x(value) - px, y(way.y[k] ?? NaN) - py);
      if (Number.isFinite(off) && off < (best?.off ?? Infinity)) best = { k, off };
    }
  return best?.k;
}
