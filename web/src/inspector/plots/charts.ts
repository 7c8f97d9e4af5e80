// What can be plotted of a run: energy, constraint violation, errors, the motion of each body, the reaction of each joint.

import type { Accuracy, Reactions, SessionState } from "../../api/types";
import { sci } from "../../core/format";
import { t } from "../../core/texts";
import { type Frame, motionIn, reactionIn } from "../../session/track";
import { unknownFrom } from "../accuracy";

export interface Curve {
  label: string;
  unit: string;
  /** The value in a state. */
  of: (state: SessionState) => number;
  /** The value in a frame of the track, for what a track holds. */
  inFrame?: (frame: Frame) => number;
  /** Its estimated error, where there is one: the plot shows it as a band. */
  error?: keyof Accuracy;
  /** The component of a reaction that it shows. */
  reaction?: { joint: string; what: "force" | "moment"; axis: number };
  /** Whether that is not unique: one of many ways to share a load. */
  shared?: boolean;
}

/** A curve's name in a legend: what is not unique is marked as in the table of reactions. */
export const labelOf = (curve: Curve): string => (curve.shared ? `≈ ${curve.label}` : curve.label);

/** Marks the curves of reactions that are not unique. */
export function markShared(charts: Chart[], { reactions }: Reactions): void {
  for (const curve of charts.flatMap((chart) => quantities(chart))) {
    const { reaction } = curve;
    if (!reaction) continue;
    const entry = reactions.find(({ joint }) => joint === reaction.joint);
    curve.shared = entry?.[reaction.what][reaction.axis]?.unique === false;
  }
}

/** Curves that share one plot. */
export interface Chart {
  /** Its name in links and for followers, whatever language they read. */
  key: string;
  label: string;
  curves: Curve[];
  /** What each curve is drawn over in place of time: a phase plot, or a hodograph. */
  across?: Curve[];
  /** Values are positive and spread over many powers of ten. */
  log?: boolean;
}

const AXES = ["x", "y", "z"];

/** The three components of a vector, such as vx, vy, vz. */
function components(
  symbol: string,
  unit: string,
  of: (state: SessionState, k: number) => number | undefined,
  error?: keyof Accuracy,
  inFrame?: (frame: Frame, k: number) => number,
): Curve[] {
  return AXES.map((axis, k) => ({
    label: `${symbol}${axis}`,
    unit,
    of: (state) => of(state, k) ?? NaN,
    ...(error && { error }),
    ...(inFrame && { inFrame: (frame: Frame) => inFrame(frame, k) }),
  }));
}

/** The estimated error of a curve in a state, where it is known. */
export function errorOf(curve: Curve, state: SessionState): number | undefined {
  return (curve.error && state.accuracy?.[curve.error]) ?? undefined;
}

/** From when on nothing is known of the error of what a chart shows; how far constraints are open, and errors, are known themselves. */
export function lostIn(chart: Chart, state: SessionState): number | undefined {
  return chart.log ? undefined : (state.error_unknown_from ?? undefined);
}

/** How far a curve may be off in a state, behind its value. */
export function within(curve: Curve, state: SessionState): string {
  const error = errorOf(curve, state);
  if (error !== undefined) return ` ± ${sci(error, 1)}`;
  return curve.error && unknownFrom(state, curve.error) !== undefined ? " ± ?" : "";
}

/** The errors of a run that estimates them. */
function errors(state: SessionState): Chart[] {
  if (!state.accuracy && typeof state.error_unknown_from !== "number") return [];
  const of = (label: string, unit: string, error: keyof Accuracy): Curve => ({
    label,
    unit,
    of: (s) => s.accuracy?.[error] ?? NaN,
  });
  const forces = state.forces.length > 0 ? [of(t("forces"), "N", "force")] : [];
  return [
    {
      key: "errors",
      label: t("Estimated error"),
      log: true,
      curves: [of(t("positions"), "m", "position"), of(t("velocities"), "m/s", "velocity"), ...forces],
    },
  ];
}

/** Each quantity of a vector over the next: the way of its tip, seen along the three axes. */
function hodograph(key: string, label: string, curves: Curve[]): Chart {
  const [x, y, z] = curves as [Curve, Curve, Curve];
  return { key, label, curves: [y, z, z], across: [x, x, y] };
}

/** The quantities of a chart, each once. */
export const quantities = (chart: Chart): Curve[] => [...new Set([...(chart.across ?? []), ...chart.curves])];

/** All plots of a scene, by one of its states. */
export function charts(state: SessionState): Chart[] {
  return [
    {
      key: "drift",
      label: t("Energy drift"),
      curves: [{ label: "ΔE", unit: "J", of: (s) => s.energy_drift, error: "energy" }],
    },
    ...errors(state),
    {
      key: "violation",
      label: t("Constraint violation"),
      log: true,
      curves: [
        { label: "|Φ|", unit: "", of: (s) => s.position_violation },
        { label: "|dΦ/dt|", unit: "", of: (s) => s.velocity_violation },
      ],
    },
    ...state.bodies.flatMap(({ name }, at) => ofBody(name, at)),
    ...state.forces.flatMap(({ joint, on }, at) => ofJoint(joint, on, at)),
  ];
}

function ofBody(name: string, at: number): Chart[] {
  type Motion = "position" | "velocity" | "angular_velocity";
  const motion = (symbol: string, unit: string, what: Motion | "acceleration"): Curve[] =>
    components(
      symbol,
      unit,
      (s, k) => s.bodies[at]?.[what][k],
      what === "acceleration" ? undefined : what,
      (frame, k) => motionIn(frame, at, what, k),
    );
  const place = motion("", "m", "position");
  const velocity = motion("v", "m/s", "velocity");
  const key = (what: string): string => `body:${name}:${what}`;
  return [
    {
      key: key("acceleration"),
      label: t("Acceleration of {name}", { name }),
      curves: motion("a", "m/s²", "acceleration"),
    },
    { key: key("position"), label: t("Position of {name}", { name }), curves: place },
    { key: key("velocity"), label: t("Velocity of {name}", { name }), curves: velocity },
    {
      key: key("angular_velocity"),
      label: t("Angular velocity of {name}", { name }),
      curves: motion("ω", "rad/s", "angular_velocity"),
    },
    { key: key("phase"), label: t("Phase plot of {name}", { name }), curves: velocity, across: place },
    hodograph(key("path"), t("Path of {name}", { name }), place),
    hodograph(key("hodograph"), t("Hodograph of the velocity of {name}", { name }), velocity),
  ];
}

function ofJoint(joint: string, on: string, at: number): Chart[] {
  const reaction = (symbol: string, unit: string, what: "force" | "moment"): Curve[] =>
    components(
      symbol,
      unit,
      (s, k) => s.forces[at]?.[what][k],
      what,
      (frame, k) => reactionIn(frame, at, what, k),
    ).map((curve, axis) => ({ ...curve, reaction: { joint, what, axis } }));
  const force = reaction("F", "N", "force");
  const key = (what: string): string => `joint:${joint}:${what}`;
  return [
    { key: key("force"), label: t("Force in {joint} on {on}", { joint, on }), curves: force },
    {
      key: key("moment"),
      label: t("Moment in {joint} on {on}", { joint, on }),
      curves: reaction("M", "N m", "moment"),
    },
    hodograph(key("hodograph"), t("Hodograph of the force in {joint} on {on}", { joint, on }), force),
  ];
}
