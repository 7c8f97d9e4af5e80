// What can be plotted of a run: energy, constraint violation, the motion of each body, the reaction of each joint.
import type { SessionState } from "../../api/types";

export interface Curve {
  label: string;
  unit: string;
  /** The value in a state. */
  of: (state: SessionState) => number;
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
): Curve[] {
  return AXES.map((axis, k) => ({ label: `${symbol}${axis}`, unit, of: (state) => of(state, k) ?? NaN }));
}

/** All plots of a scene, by one of its states. */
export function charts(state: SessionState): Chart[] {
  return [
    { label: "Energy drift", curves: [{ label: "ΔE", unit: "J", of: (s) => s.energy_drift }] },
    {
      label: "Constraint violation",
      log: true,
      curves: [
        { label: "|Φ|", unit: "", of: (s) => s.position_violation },
        { label: "|dΦ/dt|", unit: "", of: (s) => s.velocity_violation },
      ],
    },
    ...state.bodies.flatMap(({ name }, at): Chart[] => [
      {
        label: `Acceleration of ${name}`,
        curves: components("a", "m/s²", (s, k) => s.bodies[at]?.acceleration[k]),
      },
      { label: `Position of ${name}`, curves: components("", "m", (s, k) => s.bodies[at]?.position[k]) },
      { label: `Velocity of ${name}`, curves: components("v", "m/s", (s, k) => s.bodies[at]?.velocity[k]) },
      {
        label: `Angular velocity of ${name}`,
        curves: components("ω", "rad/s", (s, k) => s.bodies[at]?.angular_velocity[k]),
      },
    ]),
    ...state.forces.flatMap(({ joint, on }, at): Chart[] => [
      {
        label: `Force in ${joint} on ${on}`,
        curves: components("F", "N", (s, k) => s.forces[at]?.force[k]),
      },
      {
        label: `Moment in ${joint} on ${on}`,
        curves: components("M", "N m", (s, k) => s.forces[at]?.moment[k]),
      },
    ]),
  ];
}
