// Time, coordinates, energy, violation, work.
import { api } from "../api/client";
import { h, setText } from "../core/dom";
import { fixed, num, sci, seconds } from "../core/format";
import type { Session } from "../session/session";
import type { Panel } from "../ui/panel";
import { liveTable } from "../ui/table";

const FIRST_ROWS = 48;

interface Figure {
  root: HTMLElement;
  value: HTMLElement;
}

function figure(label: string, about: string): Figure {
  const value = h("dd", null, "–");
  return { root: h("div", { class: "figure" }, h("dt", { title: about }, label), value), value };
}

export function stateTab(session: Session): Panel {
  const time = figure("Time", "Simulated time");
  const energy = figure("Energy", "Kinetic and potential energy together");
  const drift = figure(
    "Energy drift",
    "Change of the energy since the start: it should stay near zero where nothing is lost",
  );
  const phi = figure("Violation |Φ|", "How far the positions are from meeting the constraints");
  const phiDot = figure("Its rate |dΦ/dt|", "How far the velocities are from meeting the constraints");
  const steps = figure("Steps", "Accepted steps of the integrator, and rejected ones");
  const evaluations = figure("Evaluations", "How often the accelerations were computed");
  const factors = figure("Factorizations", "How often a matrix was factorized");
  const table = liveTable("Coordinates q and their rates", "Coordinate", [
    { label: "q", number: true },
    { label: "dq/dt", unit: "per s", number: true },
  ]);
  const more = h("button", { type: "button", class: "button quiet small", hidden: true });
  const notes = h("ul", { class: "notes", "aria-label": "Notes of the engine about this scene" });
  let limit = FIRST_ROWS;
  let names: string[] | undefined;
  let requestedFor = "";

  more.addEventListener("click", () => {
    limit = Infinity;
    refresh();
  });

  const refresh = (): void => {
    const state = session.shown;
    if (!state) return;
    if (requestedFor !== state.id && names?.length !== state.q.length) {
      requestedFor = state.id;
      // Without names the coordinates are numbered.
      api
        .jacobian(state.links.self)
        .then((jacobian) => {
          names = jacobian.columns;
          refresh();
        })
        .catch(() => undefined);
    }
    setText(time.value, seconds(state.time));
    setText(energy.value, `${num(state.energy, 7)} J`);
    setText(drift.value, `${sci(state.energy_drift)} J`);
    setText(phi.value, sci(state.position_violation));
    setText(phiDot.value, sci(state.velocity_violation));
    setText(
      steps.value,
      state.rejected > 0 ? `${state.steps} (+ ${state.rejected} rejected)` : String(state.steps),
    );
    setText(evaluations.value, String(state.evaluations));
    setText(factors.value, String(state.factorizations));
    const said = state.notes ?? [];
    notes.hidden = said.length === 0;
    if (notes.textContent !== said.join(""))
      notes.replaceChildren(...said.map((text) => h("li", null, text)));
    const shown = Math.min(limit, state.q.length);
    table.update(
      state.q.slice(0, shown).map((q, k) => ({
        head: names?.[k] ?? `q${k + 1}`,
        cells: [fixed(q, 6), fixed(state.q_dot[k] ?? NaN, 6)],
      })),
    );
    more.hidden = shown >= state.q.length;
    setText(more, `Show all ${state.q.length} coordinates`);
  };

  return {
    root: h(
      "div",
      { class: "stack" },
      h(
        "dl",
        { class: "figures" },
        ...[time, energy, drift, phi, phiDot, steps, evaluations, factors].map((item) => item.root),
      ),
      notes,
      table.root,
      more,
    ),
    refresh,
  };
}
