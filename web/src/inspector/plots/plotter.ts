// uPlot, fetched when a plot is first looked at.

import uPlot from "uplot";
import { t } from "../../core/texts";
import "uplot/dist/uPlot.min.css";
import { lonely } from "./samples";
import { JOIN_DASH, type Line, SHADE, tickLabels } from "./svg-file";

export interface Plot {
  /** A change of this key builds the plot anew. */
  key: string;
  log: boolean;
  cursor: number;
  times: number[];
  curves: Line[];
  /** Between which times a line only joins marks. */
  apart: readonly boolean[];
  /** From when on the run knows nothing of its error. */
  lost: number | undefined;
  seek: (time: number) => void;
}

/** An edge of a band: not drawn itself, and not in the legend. */
const EDGE: uPlot.Series = { class: "edge", width: 0, points: { show: false } };
/** Diameter of the mark at a sample, px. */
const MARK = 5;
/** Height of a plot, px: beside the text, and at most where the inspector is wide. */
const [LOW, HIGH] = [260, 420];
const heightOf = (width: number): number => Math.max(LOW, Math.min(HIGH, Math.round(0.4 * width)));
/** What changes while a plot stands. */
interface Live {
  at: number;
  apart: readonly boolean[];
  lost: number | undefined;
}
const plots = new WeakMap<HTMLElement, { key: string; plot: uPlot; live: Live }>();

export function draw(place: HTMLElement, drawing: Plot): void {
  const values = drawing.curves.map((curve) =>
    curve.values.map((value) =>
      Number.isFinite(value) && !(drawing.log && Number(value) <= 0) ? value : null,
    ),
  );
  const data: uPlot.AlignedData = [drawing.times, ...values, ...values, ...banded(drawing).flatMap(edges)];
  let entry = plots.get(place);
  if (entry?.key !== drawing.key || !place.contains(entry.plot.root)) {
    entry?.plot.destroy();
    place.replaceChildren();
    const live = { at: drawing.cursor, apart: drawing.apart, lost: drawing.lost };
    entry = { key: drawing.key, live, plot: build(place, drawing, data, live) };
    plots.set(place, entry);
  }
  Object.assign(entry.live, { at: drawing.cursor, apart: drawing.apart, lost: drawing.lost });
  if (entry.plot.width !== place.clientWidth && place.clientWidth > 0)
    entry.plot.setSize({ width: place.clientWidth, height: heightOf(place.clientWidth) });
  entry.plot.setData(data);
}

/** The curves about which a band shows the estimated error. */
const banded = ({ curves, log }: Plot): Line[] => (log ? [] : curves.filter((curve) => curve.errors?.length));

/** The upper and the lower edge of a band. */
function edges({ values, errors }: Line): (number | null)[][] {
  return [1, -1].map((side) =>
    values.map((value, k) => {
      const error = errors?.[k] ?? null;
      return value === null || error === null ? null : value + side * error;
    }),
  );
}

function build(place: HTMLElement, drawing: Plot, data: uPlot.AlignedData, live: Live): uPlot {
  const css = getComputedStyle(place);
  const color = (name: string): string => css.getPropertyValue(name).trim();
  const font = `12px ${css.fontFamily}`;
  const axis: uPlot.Axis = {
    stroke: color("--ink-2"),
    font,
    grid: { stroke: color("--line"), width: 1 },
    ticks: { stroke: color("--line"), width: 1 },
  };
  const bands = banded(drawing);
  const units = new Set(drawing.curves.map((curve) => curve.unit));
  const unit = units.size === 1 ? (drawing.curves[0]?.unit ?? "") : "";
  const plot = new uPlot(
    {
      width: place.clientWidth || 400,
      height: heightOf(place.clientWidth || 400),
      scales: { x: { time: false }, y: drawing.log ? { distr: 3 } : {} },
      axes: [
        { ...axis, label: t("Time, s"), labelFont: font, labelSize: 20 },
        {
          ...axis,
          size: 66,
          label: unit,
          labelFont: font,
          labelSize: unit ? 18 : 0,
          values: (_, ticks) => tickLabels(ticks),
        },
      ],
      series: [
        { label: t("Time") },
        ...drawing.curves.map(
          (curve): uPlot.Series => ({
            label: units.size > 1 ? `${curve.label}, ${curve.unit}` : curve.label,
            stroke: color(curve.color),
            width: 2,
            dash: curve.dash,
            points: { show: false },
            gaps: (self, _, from, to, gaps) =>
              [...gaps, ...joins(self, live.apart, from, to)].sort((a, b) => a[0] - b[0]),
            value: (_, value) => (value === null ? "–" : short(value)),
          }),
        ),
        ...drawing.curves.map((curve) => joining(curve, color(curve.color), live)),
        ...bands.flatMap(() => [EDGE, EDGE]),
      ],
      bands: bands.map((curve, k) => ({
        series: [1 + 2 * drawing.curves.length + 2 * k, 2 + 2 * drawing.curves.length + 2 * k],
        fill: `color-mix(in srgb, ${color(curve.color)} 22%, transparent)`,
      })),
      hooks: {
        drawClear: [(self) => shadeLost(self, live.lost, color("--ink-3"))],
        draw: [(self) => drawCursor(self, live.at, color("--accent"))],
      },
      cursor: { drag: { x: false, y: false } },
      legend: { live: false },
    },
    data,
    place,
  );
  plot.over.addEventListener("click", (event) => drawing.seek(plot.posToVal(event.offsetX, "x")));
  return plot;
}

/** Where a curve is not known, px of the canvas. */
function joins(plot: uPlot, apart: readonly boolean[], from: number, to: number): [number, number][] {
  const x = (k: number): number => plot.valToPos(plot.data[0][k] ?? 0, "x", true);
  return apart.flatMap((gap, k): [number, number][] =>
    gap && k >= from && k < to ? [[x(k), x(k + 1)]] : [],
  );
}

/** The thin line below a curve, seen where that breaks off, with marks at the samples beside. */
const joining = (curve: Line, stroke: string, live: Live): uPlot.Series => ({
  class: "edge",
  stroke,
  width: 1,
  dash: curve.dash.length > 0 ? curve.dash : JOIN_DASH,
  gaps: (self, _, from, to, gaps) => {
    // Elsewhere its dashes would fill those of the curve.
    const close = live.apart.map((gap) => !gap);
    return [...gaps, ...joins(self, close, from, to)].sort((a, b) => a[0] - b[0]);
  },
  points: {
    show: () => live.apart.includes(true),
    filter: () => lonely(live.apart),
    size: MARK,
    fill: stroke,
  },
});

/** A shade below the curves where nothing is known of their error. */
function shadeLost(plot: uPlot, lost: number | undefined, color: string): void {
  if (lost === undefined) return;
  const { ctx, bbox } = plot;
  const right = bbox.left + bbox.width;
  const x = Math.max(bbox.left, Math.round(plot.valToPos(lost, "x", true)));
  if (!(x < right)) return;
  ctx.save();
  ctx.globalAlpha = SHADE;
  ctx.fillStyle = color;
  ctx.fillRect(x, bbox.top, right - x, bbox.height);
  ctx.restore();
}

/** The line at the time that the page shows. */
function drawCursor(plot: uPlot, time: number, color: string): void {
  const x = Math.round(plot.valToPos(time, "x", true));
  const { ctx, bbox } = plot;
  if (x < bbox.left || x > bbox.left + bbox.width) return;
  ctx.save();
  ctx.strokeStyle = color;
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([]);
  ctx.beginPath();
  ctx.moveTo(x, bbox.top);
  ctx.lineTo(x, bbox.top + bbox.height);
  ctx.stroke();
  ctx.restore();
}

/** The picture as it is drawn, for a slide. */
export function png(place: HTMLElement): Promise<Blob | null> {
  const canvas = place.querySelector("canvas");
  return new Promise((done) => (canvas ? canvas.toBlob(done) : done(null)));
}

function short(value: number): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size < 1e-3 || size >= 1e5 ? value.toExponential(0) : String(Number(value.toPrecision(4)));
  return text.replaceAll("-", "−").replace("e+", "e");
}
