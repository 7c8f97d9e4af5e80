// Curves over time from the states that arrived. A click in a plot moves the page's clock.

import { api } from "../../api/client";
import type { SessionState } from "../../api/types";
import { h, saveFile, setText } from "../../core/dom";
import { num, sci, seconds } from "../../core/format";
import { t } from "../../core/texts";
import { onTheme } from "../../core/theme";
import { type LiveQuery, liveQuery } from "../../session/live-query";
import type { Session } from "../../session/session";
import { keptGhost } from "../../stage/ghosts";
import { empty } from "../../ui/notice";
import type { Panel } from "../../ui/panel";
import { type LiveTable, liveTable } from "../../ui/table";
import { type Chart, charts, labelOf, lostIn, markShared, quantities, within } from "./charts";
import { columnsOf } from "./compare";
import { ExtremeMarks } from "./marks";
import { type Comparison, compare, keptRun, type Overlay, reference } from "./overlay";
import { PhaseView } from "./phase-view";
import { tableDialog } from "./run-table";
import { type Samples, samplesOf } from "./samples";
import { plotSvg } from "./svg-file";

/** About how many states the table of a plot shows. */
const TABLE_ROWS = 25;

export class PlotsTab implements Panel {
  readonly root: HTMLElement;
  private readonly select = h("select", { class: "field compact" });
  private readonly canvas = h("div", { class: "plot" });
  /** The largest differences between the run and what is laid over it. */
  private readonly apart = h("p", { class: "when", role: "status" });
  /** What the thin parts of the curves mean. */
  private readonly joined = h(
    "p",
    { class: "help", hidden: true },
    t("Discs mark what is known of the curves; a thin line only joins those that are far apart."),
  );
  /** From when on the error is not known. */
  private readonly lost = h("p", { class: "help", role: "note", hidden: true });
  /** What ≈ means. */
  private readonly shared = h(
    "p",
    { class: "help", hidden: true },
    t(
      "≈ marks what is not unique at the time that is shown: joints whose rows depend on each other may share their load in other ways too.",
    ),
  );
  /** Which reactions are unique at the moment that is shown. */
  private readonly unique: LiveQuery;
  /** The values at the time that is shown. */
  private readonly readout = h("p", { class: "readout" });
  private readonly table = h("details", { class: "as-table" }, h("summary", null, t("The same as a table")));
  private readonly mode = h(
    "select",
    { class: "field compact", "aria-label": t("Show both runs or their difference") },
    h("option", { value: "both" }, t("both runs")),
    h("option", { value: "difference" }, t("difference")),
  );
  private readonly modeLabel = h("span", { hidden: true }, this.mode);
  private readonly keepButton = h(
    "button",
    {
      type: "button",
      class: "button small",
      title: t("Lays this run over the next one, in the plots and as a ghost in the drawing"),
      onclick: () => this.keep(),
    },
    t("Keep this run"),
  );
  private readonly referenceButton = h(
    "button",
    {
      type: "button",
      class: "button small",
      title: t("A CSV file: time in the first column, values in the others, lines with # are remarks"),
      onclick: () => this.chooseReference(),
    },
    t("Lay a reference over it"),
  );
  private readonly file = h("input", {
    type: "file",
    accept: ".csv,.txt",
    hidden: true,
    "aria-label": t("CSV file of a reference"),
  });

  private readonly marks: ExtremeMarks;
  private readonly phase: PhaseView;
  private available: Chart[] = [];
  /** The choice that is painted. */
  private chosen: string | undefined;
  /** Names of the bodies that the offered plots are about. */
  private bodies = "";
  private kept: Overlay | undefined;
  private reference: Overlay | undefined;
  private plotter: typeof import("./plotter") | undefined;
  private loading = false;
  private rows: { table: LiveTable; label: string } | undefined;

  constructor(private readonly session: Session) {
    this.marks = new ExtremeMarks(session, () => this.refresh());
    this.phase = new PhaseView(this.canvas, session);
    this.root = this.layout();
    this.unique = liveQuery(
      session,
      (run, at) => api.reactions(run, { ...session.convention, in: "world" }, at),
      (found) => {
        markShared(this.available, found);
        this.refresh();
      },
      // Of large scenes nobody knows.
      () => undefined,
    );
    this.select.addEventListener("change", () => session.choosePlot(this.select.value));
    session.on("view", () => session.plot !== this.chosen && this.refresh());
    this.mode.addEventListener("change", () => this.refresh());
    this.table.addEventListener("toggle", () => this.refresh());
    this.file.addEventListener("change", () => void this.readReference());
    onTheme(() => requestAnimationFrame(() => this.canvas.isConnected && this.refresh()));
    let width = 0;
    new ResizeObserver(() => {
      if (this.canvas.clientWidth === width || this.canvas.clientWidth === 0) return;
      width = this.canvas.clientWidth;
      this.refresh();
    }).observe(this.canvas);
  }

  refresh(): void {
    const state = this.session.shown;
    if (!state) return;
    this.offer(state);
    const chart = this.chart();
    if (!chart) return;
    const samples = samplesOf(chart, this.session);
    const values = quantities(chart).map((curve) => {
      return `${labelOf(curve)} = ${num(curve.of(state), 6)}${within(curve, state)} ${curve.unit}`.trim();
    });
    if (quantities(chart).some((curve) => curve.reaction)) this.unique.refresh();
    this.shared.hidden = !quantities(chart).some((curve) => curve.shared);
    this.readout.textContent = t("At {time}: {values}", {
      time: seconds(state.time),
      values: values.join(",  "),
    });
    this.fillTable(chart, samples);
    const lost = this.lostIn(chart);
    this.lost.hidden = lost === undefined;
    if (lost !== undefined)
      setText(
        this.lost,
        t("From {lost} on nothing is known of the error: the curves may be far off there.", {
          lost: seconds(lost),
        }),
      );
    this.marks.update(chart, samples);
    this.joined.hidden = !samples.apart.includes(true);
    if (samples.times.length < 2)
      this.canvas.replaceChildren(
        empty(t("Nothing to plot yet"), t("Play or step the run: the curves grow with it.")),
      );
    else if (chart.across) this.phase.draw(chart, samples, state, this.kept);
    else this.draw(chart, samples);
  }

  private layout(): HTMLElement {
    const save = (label: string, run: () => void): HTMLElement =>
      h("button", { type: "button", class: "button quiet small", onclick: run }, label);
    return h(
      "div",
      { class: "stack" },
      h(
        "div",
        { class: "row between" },
        h("label", { class: "switch" }, h("span", null, t("Plot")), this.select),
        h(
          "span",
          { class: "row wrap tight" },
          this.keepButton,
          this.referenceButton,
          this.file,
          this.modeLabel,
          h("span", { class: "help" }, t("Save as")),
          save("CSV", () => this.saveCsv()),
          save("SVG", () => this.saveSvg()),
          save("PNG", () => void this.savePng()),
          save(t("Table of the run …"), () => tableDialog(this.session)),
        ),
      ),
      this.canvas,
      this.lost,
      this.joined,
      this.shared,
      this.marks.root,
      this.apart,
      this.readout,
      this.table,
    );
  }

  /** From when on nothing is known of the errors of the run as far as it has come. */
  private lostIn(chart: Chart): number | undefined {
    const { latest } = this.session;
    return latest && lostIn(chart, latest);
  }

  private chart(): Chart | undefined {
    return this.available.find(({ key }) => key === this.session.plot) ?? this.available[0];
  }

  /** Offers the plots of a scene; other bodies have others. */
  private offer(state: SessionState): void {
    const bodies = state.bodies.map((body) => body.name).join("|");
    if (bodies !== this.bodies || this.available.length === 0) {
      this.bodies = bodies;
      this.available = charts(state);
      this.select.replaceChildren(
        ...this.available.map(({ key, label }) => h("option", { value: key }, label)),
      );
    }
    // Somebody else may have chosen it: who presents, or a link.
    this.chosen = this.session.plot;
    const key = this.chart()?.key ?? "";
    if (this.select.value !== key) this.select.value = key;
  }

  private draw(chart: Chart, samples: Samples): void {
    const { plotter } = this;
    if (!plotter) {
      void this.loadPlotter();
      return;
    }
    const theme = document.documentElement.dataset.theme ?? "";
    const { lines } = this.compared(chart, samples);
    plotter.draw(this.canvas, {
      key: [
        chart.label,
        theme,
        String(lines.length),
        String(lines.filter((line) => line.errors?.length).length),
        lines.map((line) => line.label).join(),
        this.kept?.name ?? "",
        this.reference?.name ?? "",
        this.mode.value,
      ].join("|"),
      log: chart.log === true && this.mode.value === "both",
      cursor: this.session.time,
      times: samples.times,
      curves: lines,
      apart: samples.apart,
      lost: this.lostIn(chart),
      seek: (time) => this.session.seek(time),
    });
  }

  private async loadPlotter(): Promise<void> {
    if (this.loading) return;
    this.loading = true;
    this.plotter = await import("./plotter");
    this.refresh();
  }

  private compared(chart: Chart, samples: Samples): Comparison {
    const overlays = [this.kept, this.reference].filter((one) => one !== undefined);
    const compared = compare(chart, samples, overlays, this.mode.value === "difference");
    setText(this.apart, compared.text);
    return compared;
  }

  private fillTable(chart: Chart, { times, of }: Samples): void {
    if (!this.table.open) return;
    const key = [chart.label, ...quantities(chart).map(labelOf)].join("|");
    if (this.rows?.label !== key) {
      this.rows?.table.root.remove();
      const columns = quantities(chart).map((curve) => ({
        label: labelOf(curve),
        unit: curve.unit,
        number: true,
      }));
      this.rows = { table: liveTable(chart.label, t("Time"), columns, true), label: key };
      this.table.append(this.rows.table.root);
    }
    const stride = Math.max(1, Math.ceil(times.length / TABLE_ROWS));
    const columns = quantities(chart).map(of);
    this.rows.table.update(
      times.flatMap((time, k) =>
        k % stride === 0 || k === times.length - 1
          ? [{ head: seconds(time), cells: columns.map((column) => sci(column[k] ?? NaN, 5)) }]
          : [],
      ),
    );
  }

  /** Keeps this run to lay it over the next one, or drops the kept one. */
  private keep(): void {
    const name = runName(this.session);
    this.kept = this.kept ? undefined : keptRun(name, this.session.copy());
    this.session.showGhost(this.kept && keptGhost(this.session, name));
    this.paintOverlays();
  }

  private chooseReference(): void {
    if (!this.reference) {
      this.file.click();
      return;
    }
    this.reference = undefined;
    this.paintOverlays();
  }

  private async readReference(): Promise<void> {
    const chosen = this.file.files?.[0];
    this.file.value = "";
    if (!chosen) return;
    const columns = columnsOf(await chosen.text());
    if (!columns) {
      setText(
        this.apart,
        t(
          "{name} has no table of numbers: write time in the first column and values in the others, separated by commas.",
          { name: chosen.name },
        ),
      );
      return;
    }
    this.reference = reference(chosen.name, columns, this.available);
    this.paintOverlays();
  }

  private paintOverlays(): void {
    setText(this.keepButton, this.kept ? t("Drop the kept run") : t("Keep this run"));
    setText(this.referenceButton, this.reference ? t("Drop the reference") : t("Lay a reference over it"));
    this.modeLabel.hidden = !this.kept && !this.reference;
    this.refresh();
  }

  private saveCsv(): void {
    const chart = this.chart();
    if (!chart) return;
    const { times, of } = samplesOf(chart, this.session);
    const columns = quantities(chart).map(of);
    const lines = [
      [t("time"), ...quantities(chart).map(labelOf)].join(","),
      ["s", ...quantities(chart).map((curve) => curve.unit || "1")].join(","),
      ...times.map((time, k) => [time, ...columns.map((column) => written(column[k] ?? NaN))].join(",")),
    ];
    saveFile(new Blob([`${lines.join("\n")}\n`], { type: "text/csv" }), fileName(chart, "csv"));
  }

  private saveSvg(): void {
    const chart = this.chart();
    if (!chart) return;
    const samples = samplesOf(chart, this.session);
    const css = getComputedStyle(this.canvas);
    const color = (name: string): string => css.getPropertyValue(name).trim();
    const title = `${chart.label}, ${runName(this.session)}`;
    const colors = { ink: color("--ink"), line: color("--line"), paper: color("--surface") };
    if (chart.across) {
      const text = this.phase.file(title, colors, color);
      saveFile(new Blob([text], { type: "image/svg+xml" }), fileName(chart, "svg"));
      return;
    }
    const text = plotSvg(
      title,
      samples.times,
      this.compared(chart, samples).lines.map((line) => ({ ...line, color: color(line.color) })),
      colors,
      samples.apart,
      this.lostIn(chart),
    );
    saveFile(new Blob([text], { type: "image/svg+xml" }), fileName(chart, "svg"));
  }

  private async savePng(): Promise<void> {
    const chart = this.chart();
    const blob = chart?.across ? await this.phase.png() : await this.plotter?.png(this.canvas);
    if (chart && blob) saveFile(blob, fileName(chart, "png"));
  }
}

/** What distinguishes a run from another: the numbers that were changed, and that this was on its way. */
export function runName({
  numbers: { values, places },
  altered,
}: Pick<Session, "numbers" | "altered">): string {
  const changed = [...Object.entries(values), ...Object.entries(places)].map(
    ([name, value]) => `${name} ${typeof value === "object" ? JSON.stringify(value) : String(value)}`,
  );
  const name = changed.length > 0 ? changed.join(", ") : t("the scene as its author wrote it");
  return altered ? t("{name}, changed on its way", { name }) : name;
}

/** A number with the digits that it has: those of a frame are in single precision. */
const written = (value: number): number =>
  Math.fround(value) === value ? Number(value.toPrecision(8)) : value;

const fileName = (chart: Chart, ending: string): string =>
  `${chart.label.toLowerCase().replaceAll(" ", "-")}.${ending}`;
