// A plot as an SVG file.
import { t } from "../../core/texts";
import { lonely } from "./samples";

export interface Line {
  label: string;
  unit: string;
  values: (number | null)[];
  color: string;
  dash: number[];
  /** Estimated errors of the values: a band about the line. */
  errors?: (number | null)[];
}

/** Dashes of a line that only joins samples which are far apart. */
export const JOIN_DASH = [1, 3];
/** How strong the shade is where nothing is known of the error, from 0 to 1. */
export const SHADE = 0.16;
/** Size of the picture, px. */
const WIDTH = 900;
const HEIGHT = 520;
/** The frame of the curves, px from the edges of the picture. */
const LEFT = 88;
const RIGHT = WIDTH - 24;
const TOP = 46;
const BOTTOM = HEIGHT - 60;
/** Width of an entry of the legend, px. */
const LEGEND_ENTRY = 190;
/** About how many values an axis names. */
const TICKS = 6;
/** Larger than the number of values that an axis can name: a guard against an endless loop. */
const MAX_TICKS = 20;

export interface Colors {
  ink: string;
  line: string;
  paper: string;
}

/** A plot as a file of its own, readable in print and on a slide. */
export function plotSvg(
  title: string,
  times: number[],
  lines: Line[],
  colors: Colors,
  apart: readonly boolean[] = [],
  lost?: number,
): string {
  const numbers = lines.flatMap((line) =>
    line.values.filter((value): value is number => value !== null && Number.isFinite(value)),
  );
  const [x0, x1] = [times[0] ?? 0, times.at(-1) ?? 1];
  let [y0, y1] = [Math.min(...numbers, Infinity), Math.max(...numbers, -Infinity)];
  if (!(y1 > y0)) [y0, y1] = [(Number.isFinite(y0) ? y0 : 0) - 1, (Number.isFinite(y0) ? y0 : 0) + 1];
  const x = (t: number): number => LEFT + ((t - x0) / (x1 - x0 || 1)) * (RIGHT - LEFT);
  const y = (v: number): number => BOTTOM - ((v - y0) / (y1 - y0)) * (BOTTOM - TOP);
  const parts = [
    ...(lost === undefined || lost >= x1 ? [] : shade(x(Math.max(lost, x0)), colors)),
    ...mesh(
      { left: LEFT, right: RIGHT, top: TOP, bottom: BOTTOM },
      [
        [x0, x1],
        [y0, y1],
      ],
      { x, y },
      [t("Time, s"), ""],
      colors,
    ),
    ...lines.map((line) => band(line, (k) => x(times[k] ?? 0), y)),
    ...lines.map((line) => curve(line, (k) => x(times[k] ?? 0), y, apart)),
    ...lines.flatMap((line, k) => legendEntry(line, LEFT + k * LEGEND_ENTRY, 30, colors)),
  ];
  return [openSvg(title, WIDTH, HEIGHT, 16, colors), ...parts, "</svg>\n"].join("");
}

/** Where nothing is known of the error, and that it is so. */
const shade = (from: number, colors: Colors): string[] => [
  `<rect x="${r(from)}" y="${TOP}" width="${r(RIGHT - from)}" height="${BOTTOM - TOP}" fill="${colors.ink}" fill-opacity="${SHADE}"/>`,
  text(`x="${RIGHT - 8}" y="${TOP + 20}" text-anchor="end"`, t("error unknown"), colors),
];

/** The beginning of a file: its title for those who do not see it, and the paper. */
export function openSvg(title: string, width: number, height: number, font: number, colors: Colors): string {
  const size = `viewBox="0 0 ${width} ${height}" width="${width}" height="${height}"`;
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" ${size} font-family="sans-serif" font-size="${font}">` +
    `<title>${escapeXml(title)}</title><rect width="${width}" height="${height}" fill="${colors.paper}"/>`
  );
}

/** Lines at round values of both axes, with the values and what the axes show. */
export function mesh(
  at: { left: number; right: number; top: number; bottom: number },
  [across, up]: [[number, number], [number, number]],
  { x, y }: { x: (value: number) => number; y: (value: number) => number },
  [below, beside]: [string, string],
  colors: Colors,
): string[] {
  const [columns, rows] = [ticks(...across), ticks(...up)];
  const [under, left] = [tickLabels(columns), tickLabels(rows)];
  return [
    ...columns.flatMap((value, k) => [
      `<path d="M${r(x(value))} ${at.top}V${at.bottom}" stroke="${colors.line}"/>`,
      text(`x="${r(x(value))}" y="${at.bottom + 20}" text-anchor="middle"`, under[k] ?? "", colors),
    ]),
    ...rows.flatMap((value, k) => [
      `<path d="M${at.left} ${r(y(value))}H${at.right}" stroke="${colors.line}"/>`,
      text(`x="${at.left - 10}" y="${r(y(value) + 5)}" text-anchor="end"`, left[k] ?? "", colors),
    ]),
    text(`x="${(at.left + at.right) / 2}" y="${at.bottom + 40}" text-anchor="middle"`, below, colors),
    text(`x="${at.left - 10}" y="${at.top - 10}" text-anchor="end"`, beside, colors),
  ];
}

/** A line through all finite values; it breaks where there is none, and is thin where it only joins marks. */
function curve(
  line: Line,
  x: (k: number) => number,
  y: (value: number) => number,
  apart: readonly boolean[],
): string {
  let pen = "M";
  const joins: string[] = [];
  const points = line.values.map((value, k) => {
    if (value === null || !Number.isFinite(value)) {
      pen = "M";
      return "";
    }
    const at = `${r(x(k))} ${r(y(value))}`;
    const before = line.values[k - 1];
    if (pen === "L" && apart[k - 1] && typeof before === "number") {
      joins.push(`M${r(x(k - 1))} ${r(y(before))}L${at}`);
      pen = "M";
    }
    const point = `${pen}${at}`;
    pen = "L";
    return point;
  });
  const dash = ` stroke-dasharray="${(line.dash.length > 0 ? line.dash : JOIN_DASH).join(" ")}"`;
  const join =
    joins.length > 0 ? `<path d="${joins.join("")}" fill="none" stroke="${line.color}"${dash}/>` : "";
  const marks = lonely(apart).flatMap((k) => {
    const value = line.values[k] ?? NaN;
    return Number.isFinite(value) ? [disc(x(k), y(value), 2.5, `fill="${line.color}"`)] : [];
  });
  return `${join}${marks.join("")}<path d="${points.join("")}" fill="none" stroke="${line.color}" stroke-width="2.5"${dashes(line)}/>`;
}

/** The strip within the estimated error; it breaks where that is not known. */
function band(line: Line, x: (k: number) => number, y: (value: number) => number): string {
  const strips: [string[], string[]][] = [];
  let open = false;
  line.values.forEach((value, k) => {
    const error = line.errors?.[k];
    const known = value !== null && Number.isFinite(value) && error !== null && error !== undefined;
    if (known) {
      if (!open) strips.push([[], []]);
      const [above, below] = strips.at(-1) ?? [[], []];
      above.push(`${r(x(k))} ${r(y(value + error))}`);
      below.unshift(`${r(x(k))} ${r(y(value - error))}`);
    }
    open = known;
  });
  const path = strips.map(([above, below]) => `M${[...above, ...below].join("L")}Z`).join("");
  return path && `<path d="${path}" fill="${line.color}" fill-opacity="0.2"/>`;
}

export function legendEntry(
  line: Pick<Line, "label" | "unit" | "color" | "dash">,
  left: number,
  top: number,
  colors: Colors,
): string[] {
  return [
    `<path d="M${left} ${top}h28" stroke="${line.color}" stroke-width="3"${dashes(line)}/>`,
    text(`x="${left + 36}" y="${top + 5}"`, `${line.label}${line.unit ? `, ${line.unit}` : ""}`, colors),
  ];
}

export const disc = (x: number, y: number, r: number, ink: string): string =>
  `<circle cx="${x.toFixed(1)}" cy="${y.toFixed(1)}" r="${r}" ${ink}/>`;

const dashes = ({ dash }: Pick<Line, "dash">): string =>
  dash.length > 0 ? ` stroke-dasharray="${dash.join(" ")}"` : "";

const text = (place: string, body: string, { ink }: Colors): string =>
  `<text ${place} fill="${ink}">${escapeXml(body)}</text>`;

/** About six round values from low to high. */
export function ticks(low: number, high: number): number[] {
  const rough = (high - low) / TICKS;
  if (!(rough > 0) || !Number.isFinite(rough)) return [low];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5, 10].find((lead) => lead * power >= rough) ?? 10);
  const found: number[] = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step && found.length < MAX_TICKS; k += 1)
    found.push(k * step);
  return found;
}

/** The labels of an axis: with as many digits as tell one value from the next. */
export function tickLabels(values: readonly (number | null)[]): string[] {
  const known = values.filter((value) => value !== null).sort((a, b) => a - b);
  const steps = known.slice(1).map((value, k) => value - (known[k] ?? value));
  const largest = Math.max(...known.map(Math.abs), 0);
  const step = Math.min(...steps.filter((one) => one > 0), largest || 1);
  const plain = largest >= 1e-3 && largest < 1e5;
  const order = (value: number): number => Math.floor(Math.log10(Math.abs(value)) + 1e-9);
  return values.map((value) => {
    if (value === null) return "";
    if (Math.abs(value) < 1e-6 * step) return "0";
    // One digit more than the step has: it may be a quarter of a power of ten.
    const digits = Math.min(15, Math.max(1, order(value) - order(step) + 2));
    const rounded = Number(value.toPrecision(digits));
    return (plain ? String(rounded) : rounded.toExponential()).replaceAll("-", "−").replace("e+", "e");
  });
}

const r = (value: number): string => value.toFixed(1);
const escapeXml = (text: string): string => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
