// Results of the analyses, as tables and lists of figures.

import type { CheckReport, Reaction, Vec3 } from "../../api/types";
import { h } from "../../core/dom";
import { fixed, num, sci, seconds } from "../../core/format";
import { listed, t } from "../../core/texts";
import { told } from "../../core/told";
import type { ModeMotion, Placed } from "../../mechanics/pose";
import { liveTable } from "../../ui/table";
import { tidy, values } from "../reactions/reaction-card";
import { aboutIn } from "../reactions/wording";

export interface AssemblyResult {
  bodies: { body: string; position: Vec3; moved: number; turned: number }[];
  iterations: number;
  opening: number;
  left: number;
  notes: string[];
}

export interface KinematicsResult {
  states: { time: number; bodies: Placed[]; reactions: { reactions: Reaction[] } }[];
  steps: number;
  /** The largest error of a position, m. */
  correction: number;
  passages: { time: number; joints: string[] }[];
  events: { name: string; time: number; stop: boolean }[];
  notes: string[];
}

export interface EquilibriumResult {
  iterations: number;
  residual: number;
  /** How far the bodies may be from rest, m; null where some motion meets no stiffness. */
  error: number | null;
  least_stiffness: number;
  /** Null where it is undecided; a note says why. */
  stable: boolean | null;
  bodies: Placed[];
  reactions: { reactions: Reaction[] };
  notes: string[];
}

export interface Mode {
  kind: string;
  frequency: number;
  growth: number;
  damping_ratio: number;
  /** Estimated error of the eigenvalue, 1/s; null where the mode drifts, and where it is not known. */
  error: number | null;
  shape: ModeMotion[];
}

export interface ModesResult {
  freedoms: number;
  modes: Mode[];
  /** Motions that have no inertia, and the bodies that turn in them. */
  left_out: number;
  without_inertia: { body: string; axes: Vec3[] }[];
  /** The steady motion that the modes are about, if they are about one. */
  steady?: { turning: Vec3; sliding: Vec3; spins: { body: string; rate: number }[] } | null;
  bodies: Placed[];
  notes: string[];
}

/** What a small motion does, in the server's word. */
const KINDS: Record<string, () => string> = {
  oscillates: () => t("oscillates"),
  decays: () => t("decays"),
  grows: () => t("grows"),
  drifts: () => t("drifts"),
};

/** Positions of a kinematic analysis that the table shows at most. */
const MAX_ROWS = 21;

const columns = (labels: string[], unit: string): { label: string; unit: string; number: boolean }[] =>
  labels.map((label) => ({ label, unit, number: true }));

function figures(list: [string, string][]): HTMLElement {
  return h(
    "dl",
    { class: "figures" },
    ...list.map(([label, value]) =>
      h("div", { class: "figure" }, h("dt", null, label), h("dd", null, value)),
    ),
  );
}

export function freedomsView(report: CheckReport): HTMLElement[] {
  const redundant = report.redundant.map((entry) => `${entry.joint} (${entry.rows.join(", ")})`);
  return [
    figures([
      [t("Bodies"), String(report.bodies)],
      [t("Coordinates"), String(report.coordinates)],
      [t("Rows"), String(report.rows)],
      [t("Rank"), String(report.rank)],
      [t("Degrees of freedom"), String(report.degrees_of_freedom)],
    ]),
    redundant.length > 0
      ? h("p", null, t("Redundant rows:"), " ", redundant.join("; "), ".")
      : h("p", null, t("No row is redundant.")),
  ];
}

export function assemblyView(found: AssemblyResult): HTMLElement[] {
  const table = liveTable(t("Where the bodies came to lie"), t("Body"), [
    ...columns(["x", "y", "z", t("moved")], "m"),
    ...columns([t("turned")], "rad"),
  ]);
  table.update(
    found.bodies.map((body) => ({
      head: body.body,
      cells: [...body.position.map((part) => fixed(part, 5)), sci(body.moved), sci(body.turned)],
    })),
  );
  return [
    figures([
      [t("Steps"), String(found.iterations)],
      [t("Open at the start"), `${sci(found.opening)} m`],
      [t("Open now"), `${sci(found.left)} m`],
    ]),
    ...found.notes.map((note) => h("p", null, told(note))),
    table.root,
  ];
}

/** Along the axes of the world. */
const COMPONENTS = [...columns(["Fx", "Fy", "Fz"], "N"), ...columns(["Mx", "My", "Mz"], "N m")];

/** Force and moment, component by component, with their signs; ≈ marks what is not unique. */
export function components({ force, moment }: Pick<Reaction, "force" | "moment">, digits: number): string[] {
  const all = [...force, ...moment];
  return all.map((part) => `${part.unique ? "" : "≈ "}${num(tidy(part.value, values(all)), digits)}`);
}

/** What positions are worth, to so many digits: never to more than the precision of a double. */
const rightTo = (error: number, digits: number): string => sci(Math.max(error, Number.EPSILON), digits);

export const errorOfMotion = ({ correction }: Pick<KinematicsResult, "correction">): string =>
  t(
    "Error: positions right to about {error} m, axes to that part of their length: Newton-Raphson moved none by more.",
    { error: rightTo(correction, 2) },
  );

export const errorAtRest = ({ error }: Pick<EquilibriumResult, "error">): string =>
  error === null
    ? t("Error: positions are not known along motions that meet no stiffness.")
    : t("Error: positions right to about {error} m.", { error: rightTo(error, 1) });

/** What a driver must exert, time by time. */
function driverTable({ joint, on, about }: Reaction, states: KinematicsResult["states"]): HTMLElement {
  const caption = t("What {joint} must exert on {on}, moments about {about}, in the world frame", {
    joint,
    on,
    about: aboutIn(about),
  });
  const table = liveTable(caption, t("Time"), COMPONENTS);
  const stride = Math.max(1, Math.ceil(states.length / MAX_ROWS));
  table.update(
    states
      .filter((_, k) => k % stride === 0)
      .map((state) => {
        const entry = state.reactions.reactions.find((one) => one.joint === joint);
        return {
          head: seconds(state.time),
          cells: entry ? components(entry, 6) : COMPONENTS.map(() => "–"),
        };
      }),
  );
  return table.root;
}

export function kinematicsView(found: KinematicsResult): HTMLElement[] {
  const { states } = found;
  const drivers = (states[0]?.reactions.reactions ?? []).filter((entry) => entry.driver);
  return [
    h(
      "p",
      null,
      t("{positions}, {steps} between them.", {
        positions: t("{n} position | {n} positions", { n: states.length }),
        steps: t("{n} step | {n} steps", { n: found.steps }),
      }),
    ),
    h("p", null, errorOfMotion(found)),
    ...found.passages.map((passed) =>
      h(
        "p",
        null,
        t("Passes a singular position of {joints} at {time}.", {
          joints: passed.joints.join(", "),
          time: seconds(passed.time),
        }),
      ),
    ),
    ...found.events.map((event) =>
      h(
        "p",
        null,
        event.stop
          ? t("{name} at {time}, where the motion ends.", { name: event.name, time: seconds(event.time) })
          : t("{name} at {time}.", { name: event.name, time: seconds(event.time) }),
      ),
    ),
    ...found.notes.map((note) => h("p", null, told(note))),
    ...drivers.map((driver) => driverTable(driver, states)),
  ];
}

/** `names` are those of the bodies, in their order. */
export function equilibriumView(found: EquilibriumResult, names: string[]): HTMLElement[] {
  const places = liveTable(t("Centres of mass at rest"), t("Body"), columns(["x", "y", "z"], "m"));
  places.update(
    found.bodies.map((body, k) => ({
      head: names[k] ?? "",
      cells: body.position.map((part) => fixed(part, 6)),
    })),
  );
  const forces = liveTable(t("Reactions at rest, world frame"), t("Joint"), COMPONENTS);
  forces.update(
    found.reactions.reactions.map((entry) => ({ head: entry.joint, cells: components(entry, 5) })),
  );
  return [
    figures([
      [t("Stable"), found.stable === null ? t("undecided") : found.stable ? t("yes") : t("no")],
      [t("Least stiffness"), `${num(found.least_stiffness, 5)} N/m`],
      [t("Left over"), `${sci(found.residual)} N`],
      [t("Steps"), String(found.iterations)],
    ]),
    h("p", null, errorAtRest(found)),
    ...found.notes.map((note) => h("p", { class: "help" }, told(note))),
    places.root,
    forces.root,
  ];
}

export function modesView(found: ModesResult, about: string, show: (mode: Mode) => void): HTMLElement[] {
  return [
    h(
      "p",
      null,
      t("{degrees} of freedom {about}. Choose a mode to see it swing in the drawing.", {
        degrees: t("{n} degree | {n} degrees", { n: found.freedoms }),
        about,
      }),
    ),
    ...steadyView(found.steady),
    modesTable(found.modes, show),
    ...leftOutView(found),
    ...found.notes.map((note) => h("p", { class: "help" }, told(note))),
  ];
}

/** The steady motion that modes are about: its frame, and the bodies that spin in it. */
function steadyView(steady: ModesResult["steady"]): HTMLElement[] {
  if (!steady) return [];
  const vector = (of: Vec3, unit: string): string => `(${of.map((x) => num(x, 4)).join(", ")}) ${unit}`;
  const spins = steady.spins.map((spin) =>
    t("{body} spins with {rate} rad/s", { body: spin.body, rate: num(spin.rate, 4) }),
  );
  const frame = t("The frame of the motion turns with {turning} and slides with {sliding}", {
    turning: vector(steady.turning, "rad/s"),
    sliding: vector(steady.sliding, "m/s"),
  });
  return [h("p", null, `${[frame, ...spins].join("; ")}.`)];
}

function leftOutView(found: ModesResult): HTMLElement[] {
  if (found.left_out === 0) return [];
  const axis = (to: Vec3): string => `(${to.map((x) => fixed(x, 3)).join(", ")})`;
  const turns = found.without_inertia.map(({ body, axes }) =>
    t("{body} turns about {axes}", { body, axes: listed(axes.map(axis)) }),
  );
  const what = t("{motions} without inertia left out: {turns}.", {
    motions: t("{n} motion | {n} motions", { n: found.left_out }),
    turns: turns.join("; "),
  });
  return [h("p", { class: "help" }, what)];
}

function modesTable(modes: Mode[], show: (mode: Mode) => void): HTMLElement {
  const buttons: HTMLButtonElement[] = [];
  const rows = modes.map((mode, k) => {
    const button = h(
      "button",
      {
        type: "button",
        class: "button small",
        "aria-pressed": "false",
        "aria-label": t("Show mode {number}", { number: k + 1 }),
        onclick: () => {
          for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
          show(mode);
        },
      },
      t("Show"),
    );
    buttons.push(button);
    return h(
      "tr",
      null,
      h(
        "th",
        { scope: "row" },
        t("Mode {number}, {kind}", { number: k + 1, kind: KINDS[mode.kind]?.() ?? mode.kind }),
      ),
      h("td", { class: "number" }, num(mode.frequency, 6)),
      h("td", { class: "number" }, mode.frequency > 0 ? num(1 / mode.frequency, 5) : "–"),
      h("td", { class: "number" }, num(mode.growth, 4)),
      h("td", { class: "number" }, num(mode.damping_ratio, 4)),
      h("td", { class: "number" }, mode.error === null ? "–" : num(mode.error, 1)),
      h("td", null, button),
    );
  });
  return h(
    "div",
    { class: "table-scroll", tabindex: "0", role: "region", "aria-label": t("Modes") },
    h("table", { class: "data" }, modesHead(), h("tbody", null, ...rows)),
  );
}

function modesHead(): HTMLElement {
  const quantities = [
    [t("Frequency"), "Hz"],
    [t("Period"), "s"],
    [t("Growth"), "1/s"],
    [t("Damping ratio"), ""],
    [t("Error of λ"), "1/s"],
  ];
  return h(
    "thead",
    null,
    h(
      "tr",
      null,
      h("th", { scope: "col" }, t("Mode")),
      ...quantities.map(([label, unit]) =>
        h(
          "th",
          { scope: "col", class: "number" },
          label,
          unit ? h("span", { class: "unit" }, ` ${unit}`) : null,
        ),
      ),
      h("th", { scope: "col" }, h("span", { class: "visually-hidden" }, t("Picture"))),
    ),
  );
}
