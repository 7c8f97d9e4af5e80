// Curves over time from the states that arrived. A click in a plot moves the page's clock.

import type { SessionState } from "../../api/types";
import { h, setText } from "../../core/dom";
import { num, sci, seconds } from "../../core/format";
import { onTheme } from "../../core/prefs";
import type { Session } from "../../session/session";
import { empty } from "../../ui/notice";
import type { Panel } from "../../ui/panel";
import { liveTable } from "../../ui/table";
import { columnsOf, difference, type Line, plotSvg, resample } from "./compare";

type Curve = { label: string; unit: string; of: (state: SessionState) => number };
type Chart = { label: string; curves: Curve[]; log?: boolean };
type Plotter = typeof import("./plotter");

const TABLE_ROWS = 25;
const COLORS = ["--curve-1", "--curve-2", "--curve-3"];
const DASHES = [[], [7, 4], [2, 3]];

/** Curves that are laid over those of the run. */
interface Overlay {
  name: string;
  short: string;
  times: number[];
  of: (curve: Curve, k: number) => number[] | undefined;
}

/** Whether a column such as "bob.x" or "bob x" is a curve such as "x" in the plot "Position of bob". */
function isOf(column: string, plot: string, curve: string): boolean {
  const parts = column.toLowerCase().split(/[\s._:]+/);
  const body = parts.slice(0, -1).join(" ");
  return (
    parts.at(-1) === curve.toLowerCase() &&
    (body === "" || plot.toLowerCase().replaceAll(/[._-]/g, " ").includes(body.replaceAll("-", " ")))
  );
}

/** What tells a run from another: its numbers. */
function runName(session: Session): string {
  const { values, places } = session.numbers;
  const changed = [...Object.entries(values), ...Object.entries(places)].map(
    ([name, value]) => `${name} ${typeof value === "object" ? JSON.stringify(value) : String(value)}`,
  );
  return changed.length > 0 ? changed.join(", ") : "the scene as its author wrote it";
}

const fileName = (label: string, ending: string): string =>
  `${label.toLowerCase().replaceAll(" ", "-")}.${ending}`;

function saveBlob(blob: Blob, name: string): void {
  const link = h("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  URL.revokeObjectURL(link.href);
}

function charts(state: SessionState): Chart[] {
  const list: Chart[] = [
    { label: "Energy drift", curves: [{ label: "ΔE", unit: "J", of: (s) => s.energy_drift }] },
    {
      label: "Constraint violation",
      log: true,
      curves: [
        { label: "|Φ|", unit: "", of: (s) => s.position_violation },
        { label: "|dΦ/dt|", unit: "", of: (s) => s.velocity_violation },
      ],
    },
  ];
  state.bodies.forEach((body, at) => {
    const xyz = (
      symbol: string,
      unit: string,
      of: (s: SessionState, k: number) => number | undefined,
    ): Curve[] =>
      ["x", "y", "z"].map((axis, k) => ({ label: `${symbol}${axis}`, unit, of: (s) => of(s, k) ?? NaN }));
    list.push({
      label: `Acceleration of ${body.name}`,
      curves: xyz("a", "m/s²", (s, k) => s.bodies[at]?.acceleration[k]),
    });
    list.push({
      label: `Position of ${body.name}`,
      curves: xyz("", "m", (s, k) => s.bodies[at]?.position[k]),
    });
    list.push({
      label: `Velocity of ${body.name}`,
      curves: xyz("v", "m/s", (s, k) => s.bodies[at]?.velocity[k]),
    });
    list.push({
      label: `Angular velocity of ${body.name}`,
      curves: xyz("ω", "rad/s", (s, k) => s.bodies[at]?.angular_velocity[k]),
    });
  });
  state.forces.forEach((entry, at) => {
    const force = (
      symbol: string,
      unit: string,
      of: (s: SessionState, k: number) => number | undefined,
    ): Curve[] =>
      ["x", "y", "z"].map((axis, k) => ({ label: `${symbol}${axis}`, unit, of: (s) => of(s, k) ?? NaN }));
    list.push({
      label: `Force in ${entry.joint} on ${entry.on}`,
      curves: force("F", "N", (s, k) => s.forces[at]?.force[k]),
    });
    list.push({
      label: `Moment in ${entry.joint} on ${entry.on}`,
      curves: force("M", "N m", (s, k) => s.forces[at]?.moment[k]),
    });
  });
  return list;
}

export function plotsTab(session: Session): Panel {
  const select = h("select", { class: "field compact" });
  const canvas = h("div", { class: "plot" });
  const place = h("p", { class: "readout" });
  const tableHolder = h("details", { class: "as-table" }, h("summary", null, "The same as a table"));
  const save = h("button", { type: "button", class: "button quiet small" }, "CSV");
  const keep = h(
    "button",
    { type: "button", class: "button small", title: "Lays this run over the next one" },
    "Keep this run",
  );
  const mode = h(
    "select",
    { class: "field compact", "aria-label": "Show both runs or their difference" },
    h("option", { value: "both" }, "both runs"),
    h("option", { value: "difference" }, "difference"),
  );
  const modeLabel = h("span", { hidden: true }, mode);
  const apartFrom = h("p", { class: "when", role: "status" });
  let kept: Overlay | undefined;
  let reference: Overlay | undefined;
  let available: Chart[] = [];
  let bodies = "";
  let plotter: Plotter | undefined;
  let loading = false;
  let table: ReturnType<typeof liveTable> | undefined;
  let tableFor = "";

  const chart = (): Chart | undefined => available[Number(select.value)] ?? available[0];
  const offer = (state: SessionState): void => {
    const key = state.bodies.map((body) => body.name).join("|");
    if (key === bodies && available.length > 0) return;
    bodies = key;
    available = charts(state);
    select.replaceChildren(...available.map((entry, at) => h("option", { value: String(at) }, entry.label)));
  };

  const refresh = (): void => {
    const state = session.shown;
    if (!state) return;
    offer(state);
    const states = session.past.all;
    const shown = chart();
    if (!shown) return;
    place.textContent = `At ${seconds(state.time)}: ${shown.curves.map((curve) => `${curve.label} = ${num(curve.of(state), 6)} ${curve.unit}`.trim()).join(",  ")}`;
    fillTable(shown, states);
    if (states.length < 2) {
      canvas.replaceChildren(empty("Nothing to plot yet", "Play or step the run: the curves grow with it."));
      return;
    }
    if (!plotter) {
      if (!loading) {
        loading = true;
        void import("./plotter").then((module) => {
          plotter = module;
          refresh();
        });
      }
      return;
    }
    const lines = linesOf(shown, states);
    plotter.draw(canvas, {
      key: `${shown.label}|${document.documentElement.dataset.theme ?? ""}|${kept?.name ?? ""}|${reference?.name ?? ""}|${mode.value}`,
      log: shown.log === true && mode.value === "both",
      cursor: session.time,
      times: states.map((entry) => entry.time),
      curves: lines,
      seek: (time) => session.seek(time),
    });
  };

  /** The curves of this run, those that are laid over it, or what lies between them. */
  const linesOf = (shown: Chart, states: readonly SessionState[]): Line[] => {
    const times = states.map((entry) => entry.time);
    const over = [kept, reference].filter((one) => one !== undefined);
    const largest = over.map((): string[] => []);
    const lines = shown.curves.flatMap((curve, k): Line[] => {
      const color = COLORS[k % COLORS.length] ?? "--ink";
      const now = states.map(curve.of);
      const line = {
        label: curve.label,
        unit: curve.unit,
        values: now,
        color,
        dash: DASHES[k % DASHES.length] ?? [],
      };
      const others = over.flatMap((one, at): Line[] => {
        const values = one.of(curve, k);
        if (!values) return [];
        const other = resample(one.times, values, times);
        const apart = difference(now, other);
        largest[at]?.push(`${curve.label} ${sci(apart.largest, 3)} ${curve.unit}`.trim());
        return [
          mode.value === "difference"
            ? {
                ...line,
                label: `${curve.label} less ${one.short}`,
                values: apart.values,
                dash: at === 0 ? [] : [8, 3],
              }
            : {
                ...line,
                label: `${curve.label}, ${one.short}`,
                values: other,
                dash: at === 0 ? [3, 5] : [9, 4],
              },
        ];
      });
      return mode.value === "difference" && others.length > 0
        ? others
        : [others.length > 0 ? { ...line, dash: [] } : line, ...others];
    });
    setText(
      apartFrom,
      over
        .map(
          (one, at) =>
            `${one.name}: ${(largest[at]?.length ?? 0) > 0 ? `largest difference ${largest[at]?.join(", ")}` : "nothing of it belongs to this plot"}.`,
        )
        .join(" "),
    );
    return lines;
  };

  const fillTable = (shown: Chart, states: readonly SessionState[]): void => {
    if (!tableHolder.open) return;
    if (tableFor !== shown.label || !table) {
      table?.root.remove();
      tableFor = shown.label;
      table = liveTable(
        shown.label,
        "Time",
        shown.curves.map((curve) => ({ label: curve.label, unit: curve.unit, number: true })),
        true,
      );
      tableHolder.append(table.root);
    }
    const stride = Math.max(1, Math.ceil(states.length / TABLE_ROWS));
    table.update(
      states
        .filter((_, k) => k % stride === 0 || k === states.length - 1)
        .map((entry) => ({
          head: seconds(entry.time),
          cells: shown.curves.map((curve) => sci(curve.of(entry), 5)),
        })),
    );
  };

  save.addEventListener("click", () => {
    const shown = chart();
    if (!shown) return;
    const lines = [
      ["time", ...shown.curves.map((curve) => curve.label)].join(","),
      ["s", ...shown.curves.map((curve) => curve.unit || "1")].join(","),
      ...session.past.all.map((entry) =>
        [entry.time, ...shown.curves.map((curve) => curve.of(entry))].join(","),
      ),
    ];
    saveBlob(new Blob([`${lines.join("\n")}\n`], { type: "text/csv" }), fileName(shown.label, "csv"));
  });
  keep.addEventListener("click", () => {
    const states = [...session.past.all];
    kept = kept
      ? undefined
      : {
          name: `Kept: ${runName(session)}`,
          short: "kept",
          times: states.map((entry) => entry.time),
          of: (curve) => states.map(curve.of),
        };
    setText(keep, kept ? "Drop the kept run" : "Keep this run");
    modeLabel.hidden = !kept && !reference;
    refresh();
  });
  mode.addEventListener("change", refresh);
  const file = h("input", {
    type: "file",
    accept: ".csv,.txt",
    hidden: true,
    "aria-label": "CSV file of a reference",
  });
  const lay = h(
    "button",
    {
      type: "button",
      class: "button small",
      title: "A CSV file: time in the first column, values in the others, lines with # are remarks",
      onclick: () => {
        if (reference) {
          reference = undefined;
          layChanged();
        } else file.click();
      },
    },
    "Lay a reference over it",
  );
  const layChanged = (): void => {
    setText(lay, reference ? "Drop the reference" : "Lay a reference over it");
    modeLabel.hidden = !kept && !reference;
    refresh();
  };
  file.addEventListener("change", () => {
    const chosen = file.files?.[0];
    file.value = "";
    void chosen?.text().then((text) => {
      const found = columnsOf(text);
      if (!found) {
        setText(
          apartFrom,
          `${chosen.name} has no table of numbers: write time in the first column and values in the others, separated by commas.`,
        );
        return;
      }
      // A column belongs to the curve of its name, such as bob.x or x; a file that names none of them is taken in its order.
      const named = found.columns.some((column) =>
        available.some((one) => one.curves.some((curve) => isOf(column.label, one.label, curve.label))),
      );
      reference = {
        name: chosen.name,
        short: "reference",
        times: found.times,
        of: (curve, k) =>
          (named
            ? found.columns.find((column) => isOf(column.label, chart()?.label ?? "", curve.label))
            : found.columns[k]
          )?.values,
      };
      layChanged();
    });
  });
  const saveSvg = (): void => {
    const shown = chart();
    if (!shown) return;
    const css = getComputedStyle(canvas);
    const color = (name: string): string => css.getPropertyValue(name).trim();
    const lines = linesOf(shown, session.past.all).map((line) => ({ ...line, color: color(line.color) }));
    const text = plotSvg(
      `${shown.label}, ${runName(session)}`,
      session.past.all.map((entry) => entry.time),
      lines,
      { ink: color("--ink"), line: color("--line"), paper: color("--surface") },
    );
    saveBlob(new Blob([text], { type: "image/svg+xml" }), fileName(shown.label, "svg"));
  };
  const savePng = async (): Promise<void> => {
    const shown = chart();
    const blob = await plotter?.png(canvas);
    if (shown && blob) saveBlob(blob, fileName(shown.label, "png"));
  };
  select.addEventListener("change", refresh);
  tableHolder.addEventListener("toggle", refresh);
  onTheme(() => requestAnimationFrame(() => canvas.isConnected && refresh()));

  return {
    root: h(
      "div",
      { class: "stack" },
      h(
        "div",
        { class: "row between" },
        h("label", { class: "switch" }, h("span", null, "Plot"), select),
        h(
          "span",
          { class: "row wrap tight" },
          keep,
          lay,
          file,
          modeLabel,
          h("span", { class: "help" }, "Save as"),
          save,
          h("button", { type: "button", class: "button quiet small", onclick: saveSvg }, "SVG"),
          h("button", { type: "button", class: "button quiet small", onclick: () => void savePng() }, "PNG"),
        ),
      ),
      canvas,
      apartFrom,
      place,
      tableHolder,
    ),
    refresh,
  };
}
