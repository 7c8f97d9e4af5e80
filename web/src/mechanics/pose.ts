// Bodies shown where an analysis found them, or swinging in a mode: apart from the run, which stands still meanwhile.
import type { BodyState, SessionState, Vec3 } from "../api/types";
import { add, cross, norm, scale, sub } from "./vec";

export type Placed = Pick<BodyState, "position" | "u" | "v" | "w">;

export interface ModeMotion {
  translation: Vec3;
  rotation: Vec3;
  translation_later: Vec3;
  rotation_later: Vec3;
}

/** Where an analysis found the bodies; with a shape they swing in that mode, by so much. */
export interface Pose {
  bodies: Placed[];
  shape?: ModeMotion[];
  size?: number;
}

/** Period at which a mode is shown, s: slow enough for the eye, whatever its frequency. */
const SHOWN_PERIOD = 2;

/** The state with its bodies as a pose has them at a moment of the wall clock, ms; `still` where nothing may move by itself. */
export function posed(state: SessionState, pose: Pose, now: number, still: boolean): SessionState {
  const { bodies, shape, size = 0 } = pose;
  if (!shape) return placed(state, bodies);
  const phase = still ? 0 : ((now / 1000 / SHOWN_PERIOD) % 1) * 2 * Math.PI;
  return placed(state, swung(bodies, shape, phase, size));
}

/** A vector turned by a rotation vector. */
export function turned(a: Vec3, rotation: Vec3): Vec3 {
  const angle = norm(rotation);
  if (angle === 0) return a;
  const n = scale(rotation, 1 / angle);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const along = n[0] * a[0] + n[1] * a[1] + n[2] * a[2];
  return add(add(scale(a, c), scale(cross(n, a), s)), scale(n, along * (1 - c)));
}

/** The state with its bodies elsewhere; forces belong to the run and are left out. */
export function placed(state: SessionState, bodies: Placed[]): SessionState {
  return {
    ...state,
    forces: [],
    bodies: state.bodies.map((body, k) => ({ ...body, ...(bodies[k] ?? body) })),
  };
}

/** Bodies in a mode at a phase: what is in phase, and what follows a quarter of a period later. */
export function swung(bodies: Placed[], shape: ModeMotion[], phase: number, size: number): Placed[] {
  const [now, later] = [Math.cos(phase) * size, Math.sin(phase) * size];
  return bodies.map((body, k) => {
    const motion = shape[k];
    if (!motion) return body;
    const shift = add(scale(motion.translation, now), scale(motion.translation_later, later));
    const turn = add(scale(motion.rotation, now), scale(motion.rotation_later, later));
    return {
      position: add(body.position, shift),
      u: turned(body.u, turn),
      v: turned(body.v, turn),
      w: turned(body.w, turn),
    };
  });
}

/** A displacement that is seen and does not tear the drawing apart, m. */
export function visible(state: SessionState): number {
  const points = [...state.bodies.map((body) => body.position), ...state.forces.map((entry) => entry.at)];
  const first = points[0];
  if (!first) return 0.1;
  return 0.22 * Math.max(0.2, ...points.map((point) => norm(sub(point, first))));
}
