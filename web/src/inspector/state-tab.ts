// The state that is shown: time, energy, constraint violation, work of the integrator, coordinates.

import { api } from "../api/client";
import type { SessionState } from "../api/types";
import { h, setText } from "../core/dom";
import { fixed, num, sci, seconds } from "../core/format";
import { t } from "../core/texts";
import { told } from "../core/told";
import type { Session } from "../session/session";
import type { Panel } from "../ui/panel";
import { liveTable } from "../ui/table";
import { meaning, within } from "./accuracy";
import { HappenedList } from "./happened";

/** Coordinates that are shown until all are wanted. */
const FIRST_ROWS = 48;

interface Figure {
  root: HTMLElement;
  value: HTMLElement;
}

function figure(label: string, about: string): Figure {
  const value = h("dd", null, "–");
  return { root: h("div", { class: "figure" }, h("dt", { title: about }, label), value), value };
}

/** The figures of a state, and how each is written. */
const FIGURES: { label: () => string; about: () => string; of: (state: SessionState) => string }[] = [
  { label: () => t("Time"), about: () => t("Simulated time"), of: (state) => seconds(state.time) },
  {
    label: () => t("Energy"),
    about: () => t("Kinetic and potential energy together"),
    of: (state) => `${num(state.energy, 7)} J`,
  },
  {
    label: () => t("Energy drift"),
    about: () => t("Change of the energy since the start: it should stay near zero where nothing is lost"),
    of: (state) => `${sci(state.energy_drift)} J`,
  },
  {
    label: () => t("Positions right to"),
    about: () =>
      t(
        "Estimated error of all positions so far, of the method and its rounding; that of the model is not in it",
      ),
    of: (state) => within(state, "position", "m"),
  },
  {
    label: () => t("Velocities right to"),
    about: () => t("Estimated error of all velocities so far"),
    of: (state) => within(state, "velocity", "m/s"),
  },
  {
    label: () => t("Forces right to"),
    about: () => t("Estimated error of the forces of joints and drivers"),
    of: (state) => within(state, "force", "N"),
  },
  {
    label: () => t("Energy right to"),
    about: () => t("Estimated error of the energy so far"),
    of: (state) => within(state, "energy", "J"),
  },
  {
    label: () => t("Violation |Φ|"),
    about: () => t("How far the positions are from meeting the constraints"),
    of: (state) => sci(state.position_violation),
  },
  {
    label: () => t("Its rate |dΦ/dt|"),
    about: () => t("How far the velocities are from meeting the constraints"),
    of: (state) => sci(state.velocity_violation),
  },
  {
    label: () => t("Steps"),
    about: () => t("Accepted steps of the integrator, and rejected ones"),
    of: ({ steps, rejected }) =>
      rejected > 0 ? t("{steps} (+ {rejected} rejected)", { steps, rejected }) : String(steps),
  },
  {
    label: () => t("Evaluations"),
    about: () => t("How often the accelerations were computed"),
    of: (state) => String(state.evaluations),
  },
  {
    label: () => t("Factorizations"),
    about: () => t("How often a matrix was factorized"),
    of: (state) => String(state.factorizations),
  },
];

/** That a state is not what the picture shows, an analysis or another moment: between two states the positions of bodies alone are recorded. */
export function between(
  state: SessionState,
  { time, reviewing, moving, pose }: { time: number; reviewing: boolean; moving: boolean; pose?: unknown },
): string {
  if (pose) return t("The picture shows the result of an analysis, not the run.");
  return !reviewing || moving || state.time === time
    ? ""
    : t(
        "The picture shows {shown}. Energy, errors and coordinates are kept at some moments only: those here are of {time}, the last before it. Bodies are told at the picture’s time.",
        { shown: seconds(time), time: seconds(state.time) },
      );
}

export class StateTab implements Panel {
  readonly root: HTMLElement;
  private readonly figures = FIGURES.map(({ label, about }) => figure(label(), about()));
  /** The notes that stand there. */
  private noted = "";
  private readonly notes = h("ul", {
    class: "notes",
    "aria-label": t("Notes of the engine about this scene"),
  });
  private readonly table = liveTable(t("Coordinates q and their rates"), t("Coordinate"), [
    { label: "q", number: true },
    { label: "dq/dt", unit: t("per s"), number: true },
  ]);
  private readonly more = h("button", {
    type: "button",
    class: "button quiet small",
    hidden: true,
    onclick: () => this.showAll(),
  });
  /** That the picture shows another moment. */
  private readonly when = h("p", { class: "when", role: "note", hidden: true });
  private readonly happened: HappenedList;
  private limit = FIRST_ROWS;
  /** Names of the coordinates. */
  private names: string[] | undefined;
  /** The session whose names were asked for. */
  private requestedFor = "";

  constructor(private readonly session: Session) {
    this.happened = new HappenedList(session);
    const figures = h("dl", { class: "figures" }, ...this.figures.map((item) => item.root));
    this.root = h(
      "div",
      { class: "stack" },
      this.when,
      this.happened.root,
      figures,
      meaning(),
      this.notes,
      this.table.root,
      this.more,
    );
  }

  refresh(): void {
    const state = this.session.shown;
    if (!state) return;
    this.happened.refresh();
    if (this.requestedFor !== state.id && this.names?.length !== state.q.length) this.requestNames(state);
    FIGURES.forEach(({ of }, k) => {
      const found = this.figures[k];
      if (found) setText(found.value, of(state));
    });
    const elsewhere = between(state, this.session);
    this.when.hidden = elsewhere === "";
    setText(this.when, elsewhere);
    const notes = state.notes ?? [];
    this.notes.hidden = notes.length === 0;
    if (this.noted !== notes.join("\n")) {
      this.noted = notes.join("\n");
      this.notes.replaceChildren(...notes.map((text) => h("li", null, told(text))));
    }
    this.showCoordinates(state);
  }

  private showCoordinates({ q, q_dot }: SessionState): void {
    const shown = Math.min(this.limit, q.length);
    this.table.update(
      q.slice(0, shown).map((value, k) => ({
        head: this.names?.[k] ?? `q${k + 1}`,
        cells: [fixed(value, 6), fixed(q_dot[k] ?? NaN, 6)],
      })),
    );
    this.more.hidden = shown >= q.length;
    setText(this.more, t("Show all {q} coordinates", { q: q.length }));
  }

  private showAll(): void {
    this.limit = Infinity;
    this.refresh();
  }

  /** Without names the coordinates are numbered. */
  private requestNames(state: SessionState): void {
    this.requestedFor = state.id;
    api
      .jacobian(state.links.self)
      .then((jacobian) => {
        this.names = jacobian.columns;
        this.refresh();
      })
      .catch(() => undefined);
  }
}
