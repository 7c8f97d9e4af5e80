// Curves that are laid over those of the run: an earlier run that was kept, or a reference from a file.

import { sci } from "../../core/format";
import { t } from "../../core/texts";
import { type Chart, type Curve, labelOf } from "./charts";
import { type Columns, difference, resample } from "./compare";
import { type Known, type Samples, samplesOf } from "./samples";
import type { Line } from "./svg-file";

export interface Overlay {
  name: string;
  /** What a legend calls it. */
  short: string;
  /** What it knows of curve number k of a plot, if anything. */
  of: (chart: Chart, curve: Curve, k: number) => Values | undefined;
}

interface Values {
  times: number[];
  values: number[];
  /** Between which of them a line only joins. */
  apart: boolean[];
}

/** Custom properties of the style sheet for the curves of a plot, in turn. */
const COLORS = ["--curve-1", "--curve-2", "--curve-3"];
/** Dashes of the curves of a plot, in turn: they differ without colour too. */
const DASHES = [[], [7, 4], [2, 3]];
/** Dashes of overlays beside a run, whose curves are drawn without a break then. */
const OVERLAY_DASHES = [
  [3, 5],
  [9, 4],
];
/** Dashes of differences. */
const DIFFERENCE_DASHES = [[], [8, 3]];

/** A run that goes on to be shown beside later ones. */
export function keptRun(name: string, run: Known): Overlay {
  return {
    name: t("Kept: {name}", { name }),
    short: t("kept"),
    of: (chart, curve) => {
      const { times, apart, of } = samplesOf(chart, run);
      return { times, apart, values: of(curve) };
    },
  };
}

/**
 * The columns of a file. A column belongs to the curve that it names, such as bob.x or x; a file that names no curve is
 * taken in its order.
 */
export function reference(name: string, { times, columns }: Columns, charts: Chart[]): Overlay {
  const named = columns.some((column) =>
    charts.some((chart) => chart.curves.some((curve) => names(column.label, chart.label, curve.label))),
  );
  return {
    name,
    short: t("reference"),
    of: (chart, curve, k) => {
      const own = named
        ? columns.find((column) => names(column.label, chart.label, curve.label))
        : columns[k];
      return own && { times, apart: [], values: own.values };
    },
  };
}

/** Whether a column such as "bob.x" or "bob x" names a curve such as "x" in the plot "Position of bob". */
function names(column: string, plot: string, curve: string): boolean {
  const parts = column.toLowerCase().split(/[\s._:]+/);
  const body = parts.slice(0, -1).join(" ");
  return (
    parts.at(-1) === curve.toLowerCase() &&
    (body === "" || plot.toLowerCase().replaceAll(/[._-]/g, " ").includes(body.replaceAll("-", " ")))
  );
}

export interface Comparison {
  /** The curves of the run and of the overlays, or the differences between them. */
  lines: Line[];
  /** The largest differences, in words. */
  text: string;
}

/** A plot of the run with what is laid over it, or of the run less the overlays. */
export function compare(
  chart: Chart,
  samples: Samples,
  overlays: Overlay[],
  differences: boolean,
): Comparison {
  const { times } = samples;
  const largest = overlays.map((): string[] => []);
  const lines = chart.curves.flatMap((curve, k): Line[] => {
    const now = samples.of(curve);
    const color = COLORS[k % COLORS.length] ?? "--ink";
    const dash = DASHES[k % DASHES.length] ?? [];
    const line: Line = { label: labelOf(curve), unit: curve.unit, values: now, color, dash };
    if (curve.error) line.errors = samples.errors(curve);
    const others = overlays.flatMap((overlay, at): Line[] => {
      const known = overlay.of(chart, curve, k);
      if (!known) return [];
      const other = resample(known.times, known.values, times);
      const apart = difference(now, other);
      largest[at]?.push(`${curve.label} ${sci(apart.largest, 3)} ${curve.unit}`.trim());
      return differences
        ? [
            {
              ...line,
              label: t("{label} less {short}", { label: curve.label, short: overlay.short }),
              values: apart.values,
              dash: DIFFERENCE_DASHES[at] ?? [],
            },
          ]
        : [
            {
              ...line,
              label: `${curve.label}, ${overlay.short}`,
              values: other,
              errors: [],
              dash: OVERLAY_DASHES[at] ?? [],
            },
          ];
    });
    if (differences && others.length > 0) return others;
    return [others.length > 0 ? { ...line, dash: [] } : line, ...others];
  });
  const text = overlays.map((overlay, at) => {
    const found = largest[at] ?? [];
    const what =
      found.length > 0
        ? t("largest difference {found}", { found: found.join(", ") })
        : t("nothing of it belongs to this plot");
    return `${overlay.name}: ${what}.`;
  });
  return { lines, text: text.join(" ") };
}
