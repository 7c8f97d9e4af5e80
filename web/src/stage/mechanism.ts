// Bodies, joints, markers and the floor under them, from far to near.

import type { Vec3 } from "../api/types";
import { add, cross, dot, norm, scale, sub, unit } from "../mechanics/vec";
import type { Eye } from "./eye";
import { drawFloor, hull } from "./floor";
import { drawnJoint } from "./joints";
import type { Place } from "./labels";
import { letters, mix, type Paint, type Palette, paint } from "./palette";
import type { Pen, Point } from "./pen";
import { type Item, type Shown, THIN } from "./shown";
import { direction, inWorld, middleOf, type Solid } from "./solids";

/** A rod is drawn as a cylinder that is shorter than so many radii. */
const STOUT = 3;
/** Length of the principal axes of a body, CSS pixels. */
const AXES = 40;
/** From where light comes, along the axes of the view: from the left, from above, from the reader. */
const LIGHT: Vec3 = unit([-0.45, 0.75, 0.6]);
/** Faces of a box as corners around them; corner i has its sides in the bits of i. */
const FACES = [
  [0, 2, 3, 1],
  [4, 5, 7, 6],
  [0, 1, 5, 4],
  [2, 6, 7, 3],
  [0, 4, 6, 2],
  [1, 3, 7, 5],
] as const;

/** Draws the mechanism on its floor; what is drawn `behind` it stands on the floor too. */
export function drawMechanism(pen: Pen, shown: Shown, behind?: () => void): void {
  if (shown.floor !== undefined && shown.eye.seesFloor) drawFloor(pen, shown, shown.floor);
  behind?.();
  const items = [
    ...shown.parts.solids.map((solid) => drawnSolid(pen, shown, solid)),
    ...shown.parts.joints.flatMap((joint) => drawnJoint(pen, shown, joint)),
    ...(shown.plain ? [] : shown.state.bodies.map((_, body) => drawnAxes(pen, shown, body))),
  ];
  items.sort((a, b) => a.near - b.near);
  for (const item of items) item.draw();
  if (shown.plain) return;
  for (const marker of shown.parts.markers) {
    const at = shown.eye.project(inWorld(shown.state, marker.body, marker.point));
    const { colours } = shown;
    pen.disc(at, 3.5, { fill: colours.ink, stroke: colours.paper, width: 1.5 });
    pen.text([at[0] + 8, at[1] - 6], marker.name, {
      fill: colours.ink,
      size: letters(shown.eye.height, colours),
      halo: colours.paper,
      bold: false,
    });
  }
}

/** The part of a solid that reaches farthest, as seen on the picture: for pointing at it. */
export function distanceTo(shown: Shown, solid: Solid, [x, y]: Point): number {
  const { eye, state } = shown;
  const at = (point: Vec3): Point => eye.project(inWorld(state, solid.body, point));
  if (solid.kind === "ball") {
    const [cx, cy] = at(solid.center);
    return Math.hypot(x - cx, y - cy) - Math.max(THIN / 2, solid.radius * eye.perMetre);
  }
  if (solid.kind === "rod")
    return toSegment([x, y], at(solid.from), at(solid.to)) - Math.max(THIN / 2, solid.radius * eye.perMetre);
  const corners = solid.corners.map(at);
  const inside = (face: readonly number[]): boolean =>
    face.every((corner, k) => {
      const [a, b] = [corners[corner], corners[face[(k + 1) % 4] ?? 0]];
      return (
        a !== undefined && b !== undefined && (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) >= 0
      );
    });
  return FACES.some((face) => inside(face) || inside([...face].reverse())) ? 0 : Infinity;
}

function toSegment([x, y]: Point, [ax, ay]: Point, [bx, by]: Point): number {
  const [dx, dy] = [bx - ax, by - ay];
  const length = dx * dx + dy * dy;
  const part = length > 0 ? Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / length)) : 0;
  return Math.hypot(x - ax - part * dx, y - ay - part * dy);
}

function drawnSolid(pen: Pen, shown: Shown, solid: Solid): Item {
  const { eye, state, colours } = shown;
  const own = paint(solid.body, colours);
  const at = (point: Vec3): Vec3 => inWorld(state, solid.body, point);
  if (solid.kind === "rod") {
    const [a, b] = [at(solid.from), at(solid.to)];
    const near = eye.nearness(scale(add(a, b), 0.5));
    if (norm(sub(b, a)) < STOUT * solid.radius)
      return { near, draw: () => disk(pen, eye, a, b, solid.radius, own) };
    const width = Math.max(THIN, 2 * solid.radius * eye.perMetre);
    return { near, draw: () => rod(pen, eye.project(a), eye.project(b), width, own) };
  }
  if (solid.kind === "ball") {
    const center = at(solid.center);
    const radius = Math.max(THIN, solid.radius * eye.perMetre);
    return { near: eye.nearness(center), draw: () => ball(pen, eye.project(center), radius, own) };
  }
  const corners = solid.corners.map(at);
  const middle = middleOf(state, solid);
  return { near: eye.nearness(middle), draw: () => box(pen, eye, corners, middle, own, colours) };
}

function rod(pen: Pen, a: Point, b: Point, width: number, own: Paint): void {
  pen.path([a, b], { stroke: own.edge, width: width + 2.4 });
  pen.path([a, b], { stroke: own.fill, width });
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (length < width || width < 4) return;
  // Light falls on the upper left side.
  let [nx, ny] = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
  if (nx * LIGHT[0] - ny * LIGHT[1] < 0) [nx, ny] = [-nx, -ny];
  const off = 0.2 * width;
  const side: [Point, Point] = [
    [a[0] + nx * off, a[1] + ny * off],
    [b[0] + nx * off, b[1] + ny * off],
  ];
  pen.path(side, { stroke: own.light, width: 0.26 * width, alpha: 0.55 });
}

/** A rod that is about as thick as long: a cylinder with its ends. */
function disk(pen: Pen, eye: Eye, a: Vec3, b: Vec3, radius: number, own: Paint): void {
  const axis = unit(sub(b, a));
  const e1 = unit(cross(axis, Math.abs(axis[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
  const e2 = cross(axis, e1);
  const end = (center: Vec3): Point[] =>
    Array.from({ length: 40 }, (_, k) => {
      const angle = (k / 40) * 2 * Math.PI;
      const off = add(scale(e1, radius * Math.cos(angle)), scale(e2, radius * Math.sin(angle)));
      return eye.project(add(center, off));
    });
  const [nearer, farther] = eye.nearness(axis) > 0 ? [b, a] : [a, b];
  const front = end(nearer);
  pen.path(
    hull([...front, ...end(farther)]),
    { fill: mix(own.fill, own.edge, 0.35), stroke: own.edge, width: 1.4 },
    true,
  );
  pen.path(front, { fill: own.fill, stroke: own.edge, width: 1.2 }, true);
}

function ball(pen: Pen, center: Point, radius: number, own: Paint): void {
  pen.disc(center, radius, { fill: own.fill, stroke: own.edge, width: 1.4 });
  const [x, y] = center;
  pen.disc([x - 0.28 * radius, y - 0.32 * radius], 0.42 * radius, { fill: own.light, alpha: 0.4 });
  pen.disc([x - 0.32 * radius, y - 0.38 * radius], 0.2 * radius, { fill: own.light, alpha: 0.7 });
}

function box(pen: Pen, eye: Eye, corners: Vec3[], middle: Vec3, own: Paint, colours: Palette): void {
  for (const face of FACES) {
    const [a, b, c, d] = face.map((corner) => corners[corner] ?? middle) as [Vec3, Vec3, Vec3, Vec3];
    const center = scale(add(add(a, b), add(c, d)), 0.25);
    const plain = unit(cross(sub(b, a), sub(d, a)));
    const normal = dot(plain, sub(center, middle)) < 0 ? scale(plain, -1) : plain;
    if (eye.nearness(normal) <= 1e-9) continue;
    const seen: Vec3 = [dot(eye.axes[0], normal), dot(eye.axes[1], normal), dot(eye.axes[2], normal)];
    const lit = Math.max(0, dot(seen, LIGHT));
    const fill =
      lit > 0.6 ? mix(own.fill, own.light, lit - 0.6) : mix(own.fill, colours.ink, 0.35 * (0.6 - lit));
    pen.path(
      [a, b, c, d].map((p) => eye.project(p)),
      { fill, stroke: own.edge, width: 1.2 },
      true,
    );
  }
}

function drawnAxes(pen: Pen, shown: Shown, body: number): Item {
  const { eye, state, colours } = shown;
  const origin = state.bodies[body]?.position ?? [0, 0, 0];
  const draw = (): void => {
    const at = eye.project(origin);
    for (const [k, name] of (["u", "v", "w"] as const).entries()) {
      const axis: Vec3 = [0, 0, 0];
      axis[k] = (AXES * Math.sqrt(colours.size)) / eye.perMetre;
      const tip = eye.project(add(origin, direction(state, body, axis)));
      const stroke = colours.axes[k] ?? colours.ink;
      if (Math.hypot(tip[0] - at[0], tip[1] - at[1]) < 4) continue;
      pen.path([at, tip], { stroke, width: 2.6 * Math.sqrt(colours.size) });
      const beyond: Point = [at[0] + 1.2 * (tip[0] - at[0]), at[1] + 1.2 * (tip[1] - at[1]) + 4];
      pen.text(beyond, name, {
        fill: stroke,
        size: letters(eye.height, colours),
        anchor: "middle",
        halo: colours.paper,
      });
    }
  };
  // Its own body does not hide it.
  return { near: eye.nearness(origin) + 30 / eye.perMetre, draw };
}

/** Where the axes of the world stand, letters included. */
export function axesCorner({ width, height }: Eye, { size }: Palette): Place {
  const length = 30 * Math.sqrt(size);
  return [width - 3.4 * length, height - 3.2 * length, width, height];
}

/** The axes x, y, z of the world, in the corner of the picture. */
export function drawWorldAxes(pen: Pen, eye: Eye, colours: Palette): void {
  const length = 30 * Math.sqrt(colours.size);
  const at: Point = [eye.width - 1.7 * length, eye.height - 1.5 * length];
  const axes = (["x", "y", "z"] as const).map((name, k) => {
    const axis: Vec3 = [0, 0, 0];
    axis[k] = 1;
    return { name, near: eye.nearness(axis), flat: eye.flat(axis), stroke: colours.axes[k] ?? colours.ink };
  });
  axes.sort((a, b) => a.near - b.near);
  for (const { name, flat, stroke } of axes) {
    const [dx, dy] = [flat[0] * length, -flat[1] * length];
    if (norm([dx, dy, 0]) < 3) {
      pen.text([at[0] - 8, at[1] + 14], name, {
        fill: stroke,
        size: letters(eye.height, colours),
        anchor: "middle",
        halo: colours.paper,
      });
      continue;
    }
    pen.path([at, [at[0] + dx, at[1] + dy]], { stroke, width: 2.2 });
    pen.text([at[0] + 1.3 * dx, at[1] + 1.3 * dy + 4], name, {
      fill: stroke,
      size: letters(eye.height, colours),
      anchor: "middle",
      halo: colours.paper,
    });
  }
}
