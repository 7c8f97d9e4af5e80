// What the scene is drawn of: the shapes of bodies, the joints by their kinds, the markers, each in the frame of its body.

import type { Body, BodyState, Joint, JointKind, Scene, SessionState, Shape, Vec3 } from "../api/types";
import { type Axes, add, along, axesOf, dot, norm, out, scale, sub, unit } from "../mechanics/vec";

/** Index that stands for the ground in place of a body. */
export const GROUND = -1;
const GROUND_NAME = "ground";
/** Cosine of the angle from which on hinges are parallel. */
const PARALLEL = 0.999;
/** Radius of the ball that stands for a body that nobody drew, and of its bars to its joints, by the size of the scene. */
const PLAIN_BALL = 0.045;
const PLAIN_BAR = 0.016;

/** Points are along the body's reported axes, m, from its centre of mass; those of the ground in the world. */
export type Solid = { body: number } & (
  | { kind: "rod"; from: Vec3; to: Vec3; radius: number }
  | { kind: "ball"; center: Vec3; radius: number }
  // Corner i has its sides in the bits of i.
  | { kind: "box"; corners: Vec3[] }
);

export interface JointMark {
  name: string;
  kind: JointKind;
  body: number;
  point: Vec3;
  axis: Vec3 | undefined;
  /** It stands on the ground. */
  grounded: boolean;
  /** The other end of a rod without mass: its body and point. */
  other: { body: number; point: Vec3 } | undefined;
}

export interface NamedPoint {
  name: string;
  body: number;
  point: Vec3;
}

export interface Parts {
  solids: Solid[];
  joints: JointMark[];
  markers: NamedPoint[];
}

/** The normal of the plane in which a mechanism moves whose hinges are all parallel; `undefined` for others. */
export function planeOf(parts: Parts, state: SessionState): Vec3 | undefined {
  const hinges = parts.joints.filter((joint) => joint.kind === "revolute" && joint.axis);
  const axes = hinges.map((joint) => direction(state, joint.body, joint.axis ?? [0, 0, 1]));
  const [first] = axes;
  const planar = parts.joints.every((joint) => ["revolute", "prismatic", "fixed"].includes(joint.kind));
  const slides = parts.joints.filter((joint) => joint.kind === "prismatic" && joint.axis);
  if (!first || !planar || axes.some((axis) => Math.abs(dot(axis, first)) < PARALLEL)) return undefined;
  const across = slides.every(
    (joint) => Math.abs(dot(direction(state, joint.body, joint.axis ?? first), first)) < 1e-3,
  );
  return across ? first : undefined;
}

/** A point of a body, or of the ground, in the world. */
export function inWorld(state: SessionState, body: number, point: Vec3): Vec3 {
  const frame = state.bodies[body];
  return frame ? add(frame.position, direction(state, body, point)) : point;
}

/** A direction of a body, or of the ground, in the world. */
export function direction(state: SessionState, body: number, along: Vec3): Vec3 {
  const frame = state.bodies[body];
  return frame ? out([frame.u, frame.v, frame.w], along) : along;
}

/** The points that a solid spans, along the axes of its body. */
export const spanned = (solid: Solid): Vec3[] =>
  solid.kind === "rod" ? [solid.from, solid.to] : solid.kind === "ball" ? [solid.center] : solid.corners;

/** The middle of a solid in the world. */
export function middleOf(state: SessionState, solid: Solid): Vec3 {
  const points = spanned(solid);
  const sum = points.reduce((total, point) => add(total, point));
  return inWorld(state, solid.body, scale(sum, 1 / points.length));
}

/** The parts of a scene, of which `state` is the first. */
export function partsOf(scene: Scene | undefined, state: SessionState): Parts {
  const frames = state.bodies.map((frame) => {
    const stated = scene?.bodies?.find((body) => body.name === frame.name);
    return { frame, stated, place: converter(frame, stated) };
  });
  const at = (name: string | undefined): number => state.bodies.findIndex((body) => body.name === name);
  const joints = (scene?.joints ?? []).flatMap((joint) => jointMark(joint, frames, at) ?? []);
  const shaped = frames.flatMap(({ stated, place }, body) =>
    (stated?.shape ?? []).map((shape) => solid(shape, body, place)),
  );
  const bare = frames.flatMap(({ stated }, body) =>
    stated?.shape?.length ? [] : plain(body, joints, sizeOf(state, joints)),
  );
  const markers = (scene?.markers ?? []).map(({ name, body, point }) => {
    const index = at(body);
    const place = frames[index]?.place ?? ((p: Vec3): Vec3 => p);
    return { name, body: index, point: place(point ?? [0, 0, 0]) };
  });
  return { solids: [...shaped, ...bare], joints, markers };
}

interface Frame {
  frame: BodyState;
  stated: Body | undefined;
  place: (point: Vec3) => Vec3;
}

/**
 * Turns a point of the body's own frame into the axes that the server reports. Where those are not the author's, they are
 * found from the first state, in which the body stands as it is stated.
 */
function converter(frame: BodyState, stated: Body | undefined): (p: Vec3) => Vec3 {
  const inertia = stated?.inertia;
  if (stated && !stated.attached?.length && !(inertia && "tensor" in inertia)) {
    const center = stated.center_of_mass ?? [0, 0, 0];
    return (p) => sub(p, center);
  }
  const axes: Axes = [frame.u, frame.v, frame.w];
  const [origin, own] = [stated?.position ?? frame.position, axesOf(stated?.orientation)];
  return (p) => along(axes, sub(add(origin, out(own, p)), frame.position));
}

function solid(shape: Shape, body: number, place: (p: Vec3) => Vec3): Solid {
  if (shape.kind === "rod")
    return { kind: "rod", body, from: place(shape.from), to: place(shape.to), radius: shape.radius };
  if (shape.kind === "sphere")
    return { kind: "ball", body, center: place(shape.center), radius: shape.radius };
  const [a, b, c] = scale(shape.size, 0.5);
  const corner = (i: number): Vec3 =>
    place(add(shape.center, [i & 1 ? a : -a, i & 2 ? b : -b, i & 4 ? c : -c]));
  return { kind: "box", body, corners: Array.from({ length: 8 }, (_, i) => corner(i)) };
}

/** A body that nobody drew: a ball at its centre of mass with a bar to each of its joints. */
function plain(body: number, joints: JointMark[], size: number): Solid[] {
  const bars = joints.flatMap((joint): Solid[] => {
    const ends = [joint, joint.other].filter((end) => end?.body === body);
    return ends.flatMap((end) =>
      end ? [{ kind: "rod", body, from: [0, 0, 0], to: end.point, radius: PLAIN_BAR * size }] : [],
    );
  });
  return [...bars, { kind: "ball", body, center: [0, 0, 0], radius: PLAIN_BALL * size }];
}

function sizeOf(state: SessionState, joints: JointMark[]): number {
  const points = [
    ...state.bodies.map((body) => body.position),
    ...joints.map((joint) => inWorld(state, joint.body, joint.point)),
  ];
  const first = points[0] ?? [0, 0, 0];
  return Math.max(0.2, ...points.map((point) => norm(sub(point, first))));
}

function jointMark(
  joint: Joint,
  frames: Frame[],
  at: (name: string | undefined) => number,
): JointMark | undefined {
  if (joint.type === "gear") return undefined;
  const sides = (["i", "j"] as const).map((side) => {
    const name = (side === "i" ? joint.body_i : joint.body_j) ?? GROUND_NAME;
    return end(joint, side, name === GROUND_NAME ? GROUND : at(name), frames);
  });
  const [i, j] = sides;
  if (!i || !j) return undefined;
  const grounded = i.body === GROUND || j.body === GROUND;
  // Of a joint with the ground the side that stands still is drawn.
  const [drawn, other] = i.body === GROUND ? [i, j] : [j, i];
  if (!drawn.point) return undefined;
  const far = other.point && { body: other.body, point: other.point };
  return {
    name: joint.name,
    kind: joint.type,
    body: drawn.body,
    point: drawn.point,
    axis: drawn.axis ?? undefined,
    grounded,
    other: far,
  };
}

/** One side of a joint, in the reported axes of its body. */
function end(
  joint: Joint,
  side: "i" | "j",
  body: number,
  frames: Frame[],
): { body: number; point: Vec3 | undefined; axis: Vec3 | undefined } {
  const [ownPoint, ownAxis] = side === "i" ? [joint.point_i, joint.axis_i] : [joint.point_j, joint.axis_j];
  const stated = frames[body]?.stated;
  const place = frames[body]?.place ?? ((p: Vec3): Vec3 => p);
  // A point or an axis of the world is meant where the bodies are stated, which need not be where they start.
  const own = axesOf(stated?.orientation);
  const inBody = (p: Vec3): Vec3 => along(own, sub(p, stated?.position ?? [0, 0, 0]));
  const shared = joint.point ?? joint.points?.[side === "i" ? 0 : 1];
  const point = ownPoint ?? (shared && inBody(shared));
  const world = joint.axis ?? joint.axes?.[side === "i" ? 0 : 1];
  const axis = ownAxis ?? (world && along(own, world));
  return {
    body,
    point: point ? place(point) : undefined,
    axis: axis ? unit(sub(place(axis), place([0, 0, 0]))) : undefined,
  };
}
