// How far a mechanism reaches.

import type { SessionState, Vec3 } from "../api/types";
import { add, scale } from "../mechanics/vec";
import type { Eye } from "./eye";
import type { Point } from "./pen";
import { inWorld, type Parts, spanned } from "./solids";

/** Points about the parts of a mechanism on the plane of the picture. */
export function outline(parts: Parts, state: SessionState, eye: Eye): Point[] {
  const round = parts.solids.flatMap((solid) => {
    if (solid.kind === "box") return [];
    return spanned(solid).flatMap((end): Point[] => {
      const [x, y] = eye.flat(inWorld(state, solid.body, end));
      return [
        [x - solid.radius, y - solid.radius],
        [x + solid.radius, y + solid.radius],
      ];
    });
  });
  return [...round, ...pointsOf(parts, state).map((p) => eye.flat(p))];
}

/** Where the parts of a mechanism are. */
export function pointsOf(parts: Parts, state: SessionState): Vec3[] {
  return [
    ...parts.solids.flatMap((solid) => spanned(solid).map((point) => inWorld(state, solid.body, point))),
    ...[...parts.joints, ...parts.markers].map((one) => inWorld(state, one.body, one.point)),
  ];
}

/** Where bodies will be in so many seconds if nothing changes how they move. */
export function soon(state: SessionState, seconds: number): SessionState {
  const bodies = state.bodies.map((body) => ({
    ...body,
    position: add(
      body.position,
      add(scale(body.velocity, seconds), scale(body.acceleration, 0.5 * seconds * seconds)),
    ),
  }));
  return { ...state, bodies };
}

/** Mechanisms swing about their ground: the circle about it that holds all points. */
export function circle(fixed: Point[], points: Point[]): Point[] {
  const mean = (k: 0 | 1): number => fixed.reduce((sum, p) => sum + p[k], 0) / fixed.length;
  const [x, y] = [mean(0), mean(1)];
  const radius = Math.max(...points.map((p) => Math.hypot(p[0] - x, p[1] - y)));
  return [
    [x - radius, y - radius],
    [x + radius, y + radius],
  ];
}
