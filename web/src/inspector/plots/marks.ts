// The extremes of a plot: marked on the time line, told with their values, and passed slowly.

import type { SessionState } from "../../api/types";
import { h } from "../../core/dom";
import { num, seconds } from "../../core/format";
import { t } from "../../core/texts";
import type { Session } from "../../session/session";
import type { Mark } from "../../session/slow";
import type { Chart } from "./charts";
import { type Extreme, extremes } from "./extremes";

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
  update(chart: Chart, states: readonly SessionState[]): void {
    const marks = this.on ? marksOf(chart, states) : [];
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

function marksOf(chart: Chart, states: readonly SessionState[]): Mark[] {
  const times = states.map((state) => state.time);
  return chart.curves
    .flatMap((curve) =>
      extremes(times, states.map(curve.of)).map(({ time, value, kind }) => ({
        time,
        words: t("{curve} {kind} {value} at {time}", {
          curve: curve.label,
          kind: KINDS[kind](),
          value: `${num(value, 4)} ${curve.unit}`.trim(),
          time: seconds(time, 2),
        }),
      })),
    )
    .sort((a, b) => a.time - b.time);
}
