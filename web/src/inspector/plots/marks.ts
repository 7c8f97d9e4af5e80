// The extremes of a plot: marked on the time line, told with their values, and passed slowly.

import { h } from "../../core/dom";
import { num, seconds } from "../../core/format";
import { t } from "../../core/texts";
import type { Session } from "../../session/session";
import type { Mark } from "../../session/slow";
import type { Chart, Curve } from "./charts";
import { DECIMALS, DIGITS, type Extreme, extremes } from "./extremes";
import type { Samples } from "./samples";

/** A curve that stays below this part of the largest of its plot is zero but for rounding: a frame has seven digits. */
const ROUNDING = 1e-6;

const KINDS: Record<Extreme["kind"], () => string> = {
  largest: () => t("largest"),
  smallest: () => t("smallest"),
  maximum: () => t("maximum"),
  minimum: () => t("minimum"),
};

export class ExtremeMarks {
  private readonly list = h("ul", { class: "extremes", hidden: true });
  private readonly button = h(
    "button",
    {
      type: "button",
      class: "button small",
      "aria-pressed": "false",
      title: t(
        "Marks on the time line where these curves are largest and smallest and where they turn; a replay goes slowly there",
      ),
      onclick: () => this.toggle(),
    },
    t("Mark the extremes"),
  );
  readonly root = h("div", { class: "stack" }, h("div", { class: "row" }, this.button), this.list);
  private on = false;
  private told = "";

  constructor(
    private readonly session: Session,
    private readonly again: () => void,
  ) {}

  /** Marks what the curves have shown so far. */
  update(chart: Chart, samples: Samples): void {
    const marks = this.on ? marksOf(chart, samples) : [];
    const told = marks.map(({ words }) => words).join("\n");
    if (told === this.told) return;
    this.told = told;
    this.session.mark(marks);
    this.list.hidden = marks.length === 0;
    // A list that is being used stays as it is.
    if (this.list.contains(document.activeElement)) return;
    this.list.replaceChildren(
      ...marks.map(({ time, words }) =>
        h(
          "li",
          null,
          h(
            "button",
            { type: "button", class: "button quiet small", onclick: () => this.session.seek(time) },
            words,
          ),
        ),
      ),
    );
  }

  private toggle(): void {
    this.on = !this.on;
    this.button.setAttribute("aria-pressed", String(this.on));
    this.again();
  }
}

/** The extremes of the curves, in words: those that lie between samples far apart are told roughly. */
export function marksOf(chart: Chart, samples: Samples): Mark[] {
  const largest = Math.max(...chart.curves.map((curve) => size(samples, curve)));
  return chart.curves
    .filter((curve) => chart.log || size(samples, curve) > ROUNDING * largest)
    .flatMap((curve) =>
      extremes(samples.times, samples.of(curve)).map(({ time, value, kind, sure }) => ({
        time,
        words: sure
          ? t("{curve} {kind} {value} at {time}", {
              curve: curve.label,
              kind: KINDS[kind](),
              value: `${num(value, DIGITS)} ${curve.unit}`.trim(),
              time: seconds(time, DECIMALS),
            })
          : t("{curve} {kind} about {value} near {time}", {
              curve: curve.label,
              kind: KINDS[kind](),
              value: `${num(value, 2)} ${curve.unit}`.trim(),
              time: seconds(time, 1),
            }),
      })),
    )
    .sort((a, b) => a.time - b.time);
}

/** The largest magnitude of a curve, 0 where nothing is known of it. */
const size = (samples: Samples, curve: Curve): number =>
  samples.of(curve).reduce((most, value) => Math.max(most, Math.abs(value) || 0), 0);
