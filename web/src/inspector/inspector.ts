// The run in numbers, below its picture: parameters, state, matrices, reactions, bodies, plots, analyses.

import { h } from "../core/dom";
import { recall, remember } from "../core/prefs";
import { t } from "../core/texts";
import type { Session } from "../session/session";
import type { Panel } from "../ui/panel";
import { tabs } from "../ui/tabs";
import { AnalysesTab } from "./analyses/analyses-tab";
import { bodiesTab } from "./bodies-tab";
import { MatrixTab } from "./matrix/matrix-tab";
import { ParametersTab } from "./parameters/parameters-tab";
import { PlotsTab } from "./plots/plots-tab";
import { ReactionsTab } from "./reactions/reactions-tab";
import { StateTab } from "./state-tab";

/** Panels for the page that controls the run; a follower of a lecture has no use for them. */
const PRESENTER_ONLY = new Set(["parameters", "analyses"]);

export function inspector(
  session: Session,
  wantedPanel?: string,
): { root: HTMLElement; current: () => string; select: (key: string) => void } {
  const made: Record<string, Panel> = {
    parameters: new ParametersTab(session),
    state: new StateTab(session),
    jacobian: new MatrixTab(session),
    multipliers: new ReactionsTab(session),
    bodies: bodiesTab(session),
    plots: new PlotsTab(session),
    analyses: new AnalysesTab(session),
  };
  const panel = (key: string): HTMLElement => h("div", null, made[key]?.root);
  const bar = tabs(
    t("Inspector"),
    [
      { key: "parameters", label: t("Parameters"), panel: panel("parameters") },
      { key: "state", label: t("State"), panel: panel("state") },
      { key: "jacobian", label: t("Jacobian"), panel: panel("jacobian") },
      { key: "multipliers", label: t("Reactions"), panel: panel("multipliers") },
      { key: "bodies", label: t("Bodies"), panel: panel("bodies") },
      { key: "plots", label: t("Plots"), panel: panel("plots") },
      { key: "analyses", label: t("Analyses"), panel: panel("analyses") },
    ].filter((tab) => session.controls || !PRESENTER_ONLY.has(tab.key)),
    wantedPanel ?? recall("tab:inspector"),
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
    root: h(
      "section",
      { class: "inspector", "aria-label": t("Inspector") },
      // For those who go from heading to heading: those of joints and results stand below it.
      h("h2", { class: "visually-hidden" }, t("Inspector")),
      bar.root,
    ),
    current: bar.current,
    select: (key) => (made[key] && bar.current() !== key ? bar.select(key) : undefined),
  };
}
