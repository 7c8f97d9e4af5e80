// What stands behind the picture, in numbers: state, Jacobian, multipliers, bodies, plots.
import { h } from "../core/dom";
import { recall, remember } from "../core/prefs";
import type { Session } from "../session/session";
import type { Panel } from "../ui/panel";
import { tabs } from "../ui/tabs";
import { analysesTab } from "./analyses-tab";
import { bodiesTab } from "./bodies-tab";
import { matrixTab } from "./matrix/matrix-tab";
import { parametersTab } from "./parameters-tab";
import { plotsTab } from "./plots/plots-tab";
import { multipliersTab } from "./reactions-tab";
import { stateTab } from "./state-tab";

/** Panels that are nothing to somebody who only watches. */
const PRESENTER_ONLY = new Set(["parameters", "analyses"]);

export function inspector(
  session: Session,
  panelAsked?: string,
): { root: HTMLElement; current: () => string; select: (key: string) => void } {
  const made: Record<string, Panel> = {
    parameters: parametersTab(session),
    state: stateTab(session),
    jacobian: matrixTab(session),
    multipliers: multipliersTab(session),
    bodies: bodiesTab(session),
    plots: plotsTab(session),
    analyses: analysesTab(session),
  };
  const panel = (key: string): HTMLElement => h("div", null, made[key]?.root);
  const bar = tabs(
    "Inspector",
    [
      { key: "parameters", label: "Parameters", panel: panel("parameters") },
      { key: "state", label: "State", panel: panel("state") },
      { key: "jacobian", label: "Jacobian", panel: panel("jacobian") },
      { key: "multipliers", label: "Reactions", panel: panel("multipliers") },
      { key: "bodies", label: "Bodies", panel: panel("bodies") },
      { key: "plots", label: "Plots", panel: panel("plots") },
      { key: "analyses", label: "Analyses", panel: panel("analyses") },
    ].filter((tab) => session.controls || !PRESENTER_ONLY.has(tab.key)),
    panelAsked ?? recall("tab:inspector"),
    (key) => {
      if (session.controls) remember("tab:inspector", key);
      made[key]?.refresh();
      session.showPanel();
    },
  );

  // A joint that was clicked in the viewer shows its force, unless its rows are being looked at.
  session.on("selected", () => {
    if (session.joint !== null && bar.current() !== "jacobian") bar.select("multipliers");
    else made[bar.current()]?.refresh();
  });
  let waiting = false;
  session.on("shown", () => {
    if (waiting) return;
    waiting = true;
    // Tables follow ten times a second: faster cannot be read.
    setTimeout(
      () => {
        waiting = false;
        made[bar.current()]?.refresh();
      },
      session.moving ? 100 : 0,
    );
  });
  return {
    root: h("section", { class: "inspector", "aria-label": "Inspector" }, bar.root),
    current: bar.current,
    select: (key) => (made[key] && bar.current() !== key ? bar.select(key) : undefined),
  };
}
