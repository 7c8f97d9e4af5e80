// What can be plotted of a run: energy, constraint violation, errors, the motion of each body, the reaction of each joint.

import type { Accuracy, SessionState } from "../../api/types";
import { t } from "../../core/texts";

export interface Curve {
  label: string;
  unit: string;
  /** The value in a state. */
  of: (state: SessionState) => number;
  /** Its estimated error, where there is one: the plot shows it as a band. */
  error?: keyof Accuracy;
}

/** Curves that share one plot. */
export interface Chart {
  label: string;
  curves: Curve[];
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
): Curve[] {
  return AXES.map((axis, k) => ({
    label: `${symbol}${axis}`,
    unit,
    of: (state) => of(state, k) ?? NaN,
    ...(error && { error }),
  }));
}

/** The estimated error of a curve in a state, where it is known. */
export function errorOf(curve: Curve, state: SessionState): number | undefined {
  return (curve.error && state.accuracy?.[curve.error]) ?? undefined;
}

/** The errors of a run that estimates them. */
function errors(state: SessionState): Chart[] {
  if (!state.accuracy && typeof state.error_unknown_from !== "number") return [];
  const of = (label: string, unit: string, error: keyof Accuracy): Curve => ({
    label,
    unit,
    of: (s) => s.accuracy?.[error] ?? NaN,
  });
  const forces = state.forces.length > 0 ? [of("forces", "N", "force")] : [];
  return [
    {
      label: t("Estimated error"),
      log: true,
      curves: [of("positions", "m", "position"), of("velocities", "m/s", "velocity"), ...forces],
    },
  ];
}

/** All plots of a scene, by one of its states. */
export function charts(state: SessionState): Chart[] {
  return [
    { label: t("Energy drift"), curves: [{ label: "ΔE", unit: "J", of: (s) => s.energy_drift }] },
    ...errors(state),
    {
      label: t("Constraint violation"),
      log: true,
      curves: [
        { label: "|Φ|", unit: "", of: (s) => s.position_violation },
        { label: "|dΦ/dt|", unit: "", of: (s) => s.velocity_violation },
      ],
    },
    ...state.bodies.flatMap(({ name }, at): Chart[] => [
      {
        label: t("Acceleration of {name}", { name }),
        curves: components("a", "m/s²", (s, k) => s.bodies[at]?.acceleration[k]),
      },
      {
        label: t("Position of {name}", { name }),
        curves: components("", "m", (s, k) => s.bodies[at]?.position[k], "position"),
      },
      {
        label: t("Velocity of {name}", { name }),
        curves: components("v", "m/s", (s, k) => s.bodies[at]?.velocity[k], "velocity"),
      },
      {
        label: t("Angular velocity of {name}", { name }),
        curves: components("ω", "rad/s", (s, k) => s.bodies[at]?.angular_velocity[k], "angular_velocity"),
      },
    ]),
    ...state.forces.flatMap(({ joint, on }, at): Chart[] => [
      {
        label: t("Force in {joint} on {on}", { joint, on }),
        curves: components("F", "N", (s, k) => s.forces[at]?.force[k], "force"),
      },
      {
        label: t("Moment in {joint} on {on}", { joint, on }),
        curves: components("M", "N m", (s, k) => s.forces[at]?.moment[k], "moment"),
      },
    ]),
  ];
}
