// Curves over time from the states that arrived. A click in a plot moves the page's clock.
import { h } from "../core/dom";
import { num, sci, seconds } from "../core/format";
import { onTheme } from "../core/prefs";
import type { SessionState } from "../core/types";
import { empty } from "../ui/notice";
import { liveTable } from "../ui/table";
import type { InspectorTab } from "./inspector";
import type { Session } from "./session";

type Curve = { label: string; unit: string; of: (state: SessionState) => number };
type Chart = { label: string; curves: Curve[]; log?: boolean };
type Plotter = typeof import("./plotter");

const TABLE_ROWS = 25;

function charts(state: SessionState): Chart[] {
  const list: Chart[] = [
    { label: "Energy drift", curves: [{ label: "ΔE", unit: "J", of: (s) => s.energy_drift }] },
    { label: "Constraint violation", log: true, curves: [
      { label: "|Φ|", unit: "", of: (s) => s.position_violation }, { label: "|dΦ/dt|", unit: "", of: (s) => s.velocity_violation }] },
  ];
  state.bodies.forEach((body, at) => {
    const xyz = (symbol: string, unit: string, of: (s: SessionState, k: number) => number | undefined): Curve[] =>
      ["x", "y", "z"].map((axis, k) => ({ label: `${symbol}${axis}`, unit, of: (s) => of(s, k) ?? NaN }));
    list.push({ label: `Position of ${body.name}`, curves: xyz("", "m", (s, k) => s.bodies[at]?.position[k]) });
    list.push({ label: `Velocity of ${body.name}`, curves: xyz("v", "m/s", (s, k) => s.bodies[at]?.velocity[k]) });
    list.push({ label: `Angular velocity of ${body.name}`, curves: xyz("ω", "rad/s", (s, k) => s.bodies[at]?.angular_velocity[k]) });
  });
  return list;
}

export function plotsTab(session: Session): InspectorTab {
  const select = h("select", { class: "field compact" });
  const canvas = h("div", { class: "plot" });
  const place = h("p", { class: "readout" });
  const tableHolder = h("details", { class: "as-table" }, h("summary", null, "The same as a table"));
  const save = h("button", { type: "button", class: "button quiet small" }, "Save as CSV");
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
    plotter.draw(canvas, {
      key: `${shown.label}|${document.documentElement.dataset.theme ?? ""}`, log: shown.log === true, cursor: session.time,
      times: states.map((entry) => entry.time),
      curves: shown.curves.map((curve) => ({ label: curve.label, unit: curve.unit, values: states.map(curve.of) })),
      seek: (time) => session.seek(time),
    });
  };

  const fillTable = (shown: Chart, states: readonly SessionState[]): void => {
    if (!tableHolder.open) return;
    if (tableFor !== shown.label || !table) {
      table?.root.remove();
      tableFor = shown.label;
      table = liveTable(shown.label, "Time", shown.curves.map((curve) => ({ label: curve.label, unit: curve.unit, number: true })), true);
      tableHolder.append(table.root);
    }
    const stride = Math.max(1, Math.ceil(states.length / TABLE_ROWS));
    table.update(states.filter((_, k) => k % stride === 0 || k === states.length - 1).map((entry) => ({
      head: seconds(entry.time), cells: shown.curves.map((curve) => sci(curve.of(entry), 5)),
    })));
  };

  save.addEventListener("click", () => {
    const shown = chart();
    if (!shown) return;
    const lines = [["time", ...shown.curves.map((curve) => curve.label)].join(","), ["s", ...shown.curves.map((curve) => curve.unit || "1")].join(","),
      ...session.past.all.map((entry) => [entry.time, ...shown.curves.map((curve) => curve.of(entry))].join(","))];
    const link = h("a", { href: URL.createObjectURL(new Blob([lines.join("\n") + "\n"], { type: "text/csv" })), download: `${shown.label.toLowerCase().replaceAll(" ", "-")}.csv` });
    link.click();
    URL.revokeObjectURL(link.href);
  });
  select.addEventListener("change", refresh);
  tableHolder.addEventListener("toggle", refresh);
  onTheme(() => requestAnimationFrame(() => canvas.isConnected && refresh()));

  return {
    root: h("div", { class: "stack" },
      h("div", { class: "row between" }, h("label", { class: "switch" }, h("span", null, "Plot"), select), save),
      canvas, place, tableHolder),
    refresh,
  };
}
