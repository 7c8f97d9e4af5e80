// The floor under the mechanism, with the shadows that fall on it.

import type { Vec3 } from "../api/types";
import { roundDown } from "../mechanics/forces";
import { add, cross, dot, scale, sub, unit } from "../mechanics/vec";
import { mix } from "./palette";
import type { Pen, Point } from "./pen";
import { type Shown, THIN } from "./shown";
import { inWorld } from "./solids";

/** Lines of the floor to each side of its middle. */
const FLOOR_LINES = 7;

/** A grid below the mechanism, and the shadows that fall on it: they tell how far away things are. */
export function drawFloor(pen: Pen, shown: Shown, height: number): void {
  const { eye, state, parts, colours } = shown;
  const down = (p: Vec3): Vec3 => add(p, scale(eye.up, height - dot(p, eye.up)));
  const [e1, e2] = floorAxes(eye.up);
  const span = Math.min(eye.width, eye.height) / eye.perMetre;
  const spacing = roundDown(span / 6);
  const bodies = state.bodies.map((body) => down(body.position));
  const joints = parts.joints.map((joint) => down(inWorld(state, joint.body, joint.point)));
  const all = [...bodies, ...joints];
  const mean = (axis: Vec3): number => {
    const sum = all.reduce((total, p) => total + dot(p, axis), 0);
    return Math.round(sum / Math.max(1, all.length) / spacing) * spacing;
  };
  const [m1, m2] = [mean(e1), mean(e2)];
  const corner = (i: number, j: number): Vec3 =>
    add(scale(eye.up, height), add(scale(e1, m1 + i * spacing), scale(e2, m2 + j * spacing)));
  const n = FLOOR_LINES;
  pen.path(
    [corner(-n, -n), corner(n, -n), corner(n, n), corner(-n, n)].map((p) => eye.project(p)),
    { fill: colours.grid, alpha: 0.45 },
    true,
  );
  for (let k = -n; k <= n; k += 1) {
    for (const line of [
      [corner(k, -n), corner(k, n)],
      [corner(-n, k), corner(n, k)],
    ])
      pen.path(
        line.map((p) => eye.project(p)),
        { stroke: mix(colours.grid, colours.edge, 0.25), width: 1, alpha: 0.8 },
      );
  }
  const shadow = { stroke: colours.ink, alpha: 0.1 };
  for (const solid of parts.solids) {
    const at = (point: Vec3): Point => eye.project(down(inWorld(state, solid.body, point)));
    if (solid.kind === "ball")
      pen.disc(at(solid.center), Math.max(THIN, solid.radius * eye.perMetre) * 0.8, {
        fill: colours.ink,
        alpha: 0.1,
      });
    else if (solid.kind === "rod")
      pen.path([at(solid.from), at(solid.to)], {
        ...shadow,
        width: Math.max(THIN, 1.6 * solid.radius * eye.perMetre),
      });
    else pen.path(hull(solid.corners.map(at)), { fill: colours.ink, alpha: 0.1 }, true);
  }
}

/** Two horizontal axes of the world. */
function floorAxes(up: Vec3): [Vec3, Vec3] {
  const first: Vec3 = Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const e1 = unit(sub(first, scale(up, dot(first, up))));
  return [e1, cross(up, e1)];
}

/** The points around all others, in turn. */
export function hull(points: Point[]): Point[] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list: Point[]): Point[] => {
    const kept: Point[] = [];
    for (const p of list) {
      for (;;) {
        const [a, b] = [kept.at(-2), kept.at(-1)];
        if (!a || !b || (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        kept.pop();
      }
      kept.push(p);
    }
    kept.pop();
    return kept;
  };
  return [...half(sorted), ...half(sorted.reverse())];
}
