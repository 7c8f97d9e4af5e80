// The parts of the sketch: shapes of bodies, joints and principal axes as SVG elements that follow their body.
import type { Body, BodyState, Joint, Shape, Vec3 } from "../api/types";
import { svg } from "../core/dom";
import { type Axes, add, along, axesOf, out, scale, sub } from "../mechanics/vec";

export interface Piece {
  /** Index of the body that carries it. */
  body: number;
  /** Points along the body's reported axes, from its centre of mass. */
  points: Vec3[];
  element: SVGElement;
  /** Puts the element where its points are on the drawing. */
  place: (shown: [number, number][]) => void;
}

/** Radius of the circle of a joint, in units of the drawing. */
export const JOINT_RADIUS = 5;
/** Radius of the dot of a marker, in units of the drawing. */
const MARKER_RADIUS = 3;

/** Pairs of corners of a box that an edge joins; corner i has its sides in the bits of i. */
const BOX_EDGES = [
  [0, 1],
  [2, 3],
  [4, 5],
  [6, 7],
  [0, 2],
  [1, 3],
  [4, 6],
  [5, 7],
  [0, 4],
  [1, 5],
  [2, 6],
  [3, 7],
] as const;

/**
 * Turns a point of the body's own frame into the axes that the server reports. Where those are not the author's, they are
 * found from the first state, in which the body stands as it is stated.
 */
export function converter(frame: BodyState, stated: Body | undefined): (p: Vec3) => Vec3 {
  const inertia = stated?.inertia;
  if (stated && !stated.attached?.length && !(inertia && "tensor" in inertia)) {
    const center = stated.center_of_mass ?? [0, 0, 0];
    return (p) => sub(p, center);
  }
  const axes: Axes = [frame.u, frame.v, frame.w];
  const [origin, own] = [stated?.position ?? frame.position, axesOf(stated?.orientation)];
  return (p) => along(axes, sub(add(origin, out(own, p)), frame.position));
}

/** A shape of a body; `toBody` turns points of the body's own frame into its reported axes. */
export function shapePiece(shape: Shape, body: number, toBody: (p: Vec3) => Vec3): Piece {
  if (shape.kind === "rod") {
    const element = svg("line", { class: "sketch-rod" });
    element.style.setProperty("--r", String(shape.radius));
    return linePiece(element, body, toBody(shape.from), toBody(shape.to));
  }
  if (shape.kind === "sphere") {
    const element = svg("circle", { class: "sketch-ball" });
    element.style.setProperty("--r", String(shape.radius));
    return circlePiece(element, body, toBody(shape.center));
  }
  const [a, b, c] = scale(shape.size, 0.5);
  const corner = (i: number): Vec3 =>
    toBody(add(shape.center, [i & 1 ? a : -a, i & 2 ? b : -b, i & 4 ? c : -c]));
  const element = svg("path", { class: "sketch-box" });
  return {
    body,
    points: Array.from({ length: 8 }, (_, i) => corner(i)),
    element,
    place: (at) =>
      set(element, { d: BOX_EDGES.map(([i, j]) => `M${at[i]?.join(" ")}L${at[j]?.join(" ")}`).join("") }),
  };
}

/** A joint between two moving bodies; the second one carries it. */
export function jointPiece(
  frame: BodyState,
  body: number,
  stated: Body | undefined,
  joint: Joint,
): Piece | undefined {
  // A point of the world is meant where the bodies are stated, which need not be where they start.
  const own = joint.point
    ? along(axesOf(stated?.orientation), sub(joint.point, stated?.position ?? [0, 0, 0]))
    : joint.point_j;
  if (!own) return undefined;
  const point = converter(frame, stated)(own);
  return circlePiece(svg("circle", { r: JOINT_RADIUS, class: "sketch-joint" }), body, point);
}

/** A named point, a dot with its name beside it; `point` is along the body's reported axes. */
export function markerPiece(body: number, name: string, point: Vec3): Piece {
  const element = markerElement(name);
  return { body, points: [point], element, place: ([at]) => at && moveMarker(element, at) };
}

/** The dot and the name of a marker, at the origin of the drawing until it is moved. */
export function markerElement(name: string): SVGGElement {
  const label = svg("text", { x: 7, y: -5 });
  label.textContent = name;
  const element = svg("g", { class: "sketch-marker" });
  element.append(svg("circle", { r: MARKER_RADIUS }), label);
  return element;
}

/** Puts a marker at a place of the drawing. */
export function moveMarker(element: SVGGElement, [x, y]: [number, number]): void {
  set(element, { transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` });
}

/** The principal axes u, v, w of a body, as lines of a length in metres. */
export function axisPieces(body: number, length: number): Piece[] {
  return (["u", "v", "w"] as const).map((name, k) => {
    const tip: Vec3 = [0, 0, 0];
    tip[k] = length;
    return linePiece(svg("line", { class: `sketch-axis axis-${name}` }), body, [0, 0, 0], tip);
  });
}

function linePiece(element: SVGLineElement, body: number, from: Vec3, to: Vec3): Piece {
  return {
    body,
    points: [from, to],
    element,
    place: ([a, b]) => a && b && set(element, { x1: a[0], y1: a[1], x2: b[0], y2: b[1] }),
  };
}

function circlePiece(element: SVGCircleElement, body: number, center: Vec3): Piece {
  return {
    body,
    points: [center],
    element,
    place: ([c]) => c && set(element, { cx: c[0], cy: c[1] }),
  };
}

function set(element: SVGElement, values: Record<string, string | number>): void {
  for (const [key, value] of Object.entries(values))
    element.setAttribute(key, typeof value === "number" ? value.toFixed(1) : value);
}
