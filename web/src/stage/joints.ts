// Joints, recognisable by their kinds, and what stands on the ground.

import type { Vec3 } from "../api/types";
import { add, scale, sub } from "../mechanics/vec";
import type { Eye } from "./eye";
import { mix, type Palette } from "./palette";
import type { Pen, Point } from "./pen";
import type { Item, Shown } from "./shown";
import { direction, inWorld, type JointMark } from "./solids";

/** Radius of a joint, CSS pixels. */
const JOINT = 6;
/** Radius of the ring about the chosen joint, CSS pixels. */
const CHOSEN = 14;

export function drawnJoint(pen: Pen, shown: Shown, joint: JointMark): Item[] {
  const { eye, state, colours } = shown;
  const point = inWorld(state, joint.body, joint.point);
  const near = eye.nearness(point) + 20 / eye.perMetre;
  const far = joint.other && inWorld(state, joint.other.body, joint.other.point);
  const size = JOINT * Math.sqrt(colours.size);
  const items: Item[] = [];
  if (joint.grounded)
    items.push({
      near: near - 15 / eye.perMetre,
      draw: () => bearing(pen, eye.project(point), size, colours),
    });
  if (joint.kind === "rod" && far)
    items.push({
      near: eye.nearness(scale(add(point, far), 0.5)),
      draw: () => pen.path([eye.project(point), eye.project(far)], { stroke: colours.edge, width: 3 }),
    });
  items.push({
    near,
    draw: () => {
      const axis = joint.axis && direction(state, joint.body, joint.axis);
      glyph(pen, shown, joint, point, axis, size);
      if (shown.joint === joint.name)
        pen.disc(eye.project(point), CHOSEN * Math.sqrt(colours.size), {
          stroke: colours.accent,
          width: 3.5,
        });
    },
  });
  return items;
}

/** What stands on the ground: a block with hatching below the joint. */
function bearing(pen: Pen, [x, y]: Point, size: number, colours: Palette): void {
  const [half, depth] = [2.2 * size, 2.3 * size];
  pen.path(
    [
      [x, y],
      [x - 0.75 * half, y + depth],
      [x + 0.75 * half, y + depth],
    ],
    { fill: mix(colours.edge, colours.paper, 0.6), stroke: colours.edge, width: 1.8 },
    true,
  );
  pen.path(
    [
      [x - half, y + depth],
      [x + half, y + depth],
    ],
    { stroke: colours.edge, width: 2.4 },
  );
  for (let k = 0; k < 5; k += 1) {
    const from = x - half + (k + 0.7) * ((2 * half) / 5);
    pen.path(
      [
        [from, y + depth],
        [from - 0.7 * size, y + depth + 0.9 * size],
      ],
      { stroke: colours.edge, width: 1.6 },
    );
  }
}

/** The joint, recognisable by its kind. */
function glyph(
  pen: Pen,
  shown: Shown,
  joint: JointMark,
  point: Vec3,
  axis: Vec3 | undefined,
  size: number,
): void {
  const { eye, colours } = shown;
  const at = eye.project(point);
  const metal = { fill: colours.paper, stroke: colours.edge, width: 2.4 };
  const half = (1.6 * size) / eye.perMetre;
  const ends =
    axis &&
    ([eye.project(sub(point, scale(axis, half))), eye.project(add(point, scale(axis, half)))] as const);
  switch (joint.kind) {
    case "revolute":
    case "cylindrical":
    case "screw": {
      if (ends) {
        pen.path(ends, { stroke: colours.edge, width: 2 * size + 2.4, butt: true });
        pen.path(ends, { stroke: mix(colours.edge, colours.paper, 0.5), width: 2 * size - 1, butt: true });
        pen.disc(at, size, metal);
        if (joint.kind !== "revolute") pen.path(ends, { stroke: colours.edge, width: 2 });
      } else pen.disc(at, size, metal);
      return;
    }
    case "spherical":
      pen.disc(at, size * 1.15, metal);
      pen.disc(at, size * 0.5, { fill: colours.edge });
      return;
    case "universal":
      pen.disc(at, size * 1.1, metal);
      pen.path(
        [
          [at[0] - size, at[1]],
          [at[0] + size, at[1]],
        ],
        { stroke: colours.edge, width: 2 },
      );
      pen.path(
        [
          [at[0], at[1] - size],
          [at[0], at[1] + size],
        ],
        { stroke: colours.edge, width: 2 },
      );
      return;
    case "prismatic":
    case "point-on-line": {
      if (axis) rail(pen, eye, point, axis, size, colours);
      pen.path(square(at, 0.9 * size), metal, true);
      return;
    }
    case "planar":
    case "point-in-plane":
    case "fixed":
      pen.path(square(at, size), metal, true);
      return;
    default:
      pen.disc(at, 0.7 * size, metal);
  }
}

/** The line along which something slides. */
function rail(pen: Pen, eye: Eye, point: Vec3, axis: Vec3, size: number, colours: Palette): void {
  const long = (9 * size) / eye.perMetre;
  const ends = [-1, 1].map((sense) => eye.project(add(point, scale(axis, sense * long))));
  pen.path(ends, { stroke: colours.edge, width: 1.8, dash: [7, 5] });
}

const square = ([x, y]: Point, half: number): Point[] => [
  [x - half, y - half],
  [x + half, y - half],
  [x + half, y + half],
  [x - half, y + half],
];
