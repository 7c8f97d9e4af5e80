// The spring that joins a pulled body to the hand.

import type { SessionState } from "../api/types";
import { add, out } from "../mechanics/vec";
import type { Watched } from "../session/watched";
import type { Eye } from "./eye";
import type { Palette } from "./palette";
import type { Pen, Point } from "./pen";

/** Radius of the circle that stands for the hand, CSS pixels. */
const HAND = 8;
/** Straight pieces of the zigzag of a spring. */
const PIECES = 20;
/** Distance of the corners of a spring from its axis, CSS pixels. */
const WIDTH = 5;

export function drawPull(pen: Pen, session: Watched, state: SessionState, eye: Eye, colours: Palette): void {
  const pull = session.latest?.pull;
  const body = pull && state.bodies.find((entry) => entry.name === pull.body);
  if (!pull || !body) return;
  const from = eye.project(add(body.position, out([body.u, body.v, body.w], pull.point ?? [0, 0, 0])));
  const hand = eye.project(pull.to);
  pen.path(spring(from, hand), { stroke: colours.force.load, width: 2.5 });
  pen.disc(hand, HAND, { fill: colours.paper, stroke: colours.force.load, width: 3 });
}

function spring([x, y]: Point, [hx, hy]: Point): Point[] {
  const [dx, dy] = [hx - x, hy - y];
  const length = Math.hypot(dx, dy) || 1;
  const [nx, ny] = [-dy / length, dx / length];
  return Array.from({ length: PIECES + 1 }, (_, k) => {
    const end = k === 0 || k === PIECES;
    const side = end ? 0 : k % 2 === 0 ? WIDTH : -WIDTH;
    return [x + (dx * k) / PIECES + nx * side, y + (dy * k) / PIECES + ny * side];
  });
}
