// The scene as a line drawing: shown at once, without WebGL, and while the 3-D view loads.

import type { Body, BodyState, Scene, SessionState, Vec3 } from "../api/types";
import { svg } from "../core/dom";
import { type Axes, add, cross, dot, norm, out, scale, sub, unit } from "../mechanics/vec";
import {
  axisPieces,
  converter,
  JOINT_RADIUS,
  jointPiece,
  markerElement,
  markerPiece,
  moveMarker,
  type Piece,
  shapePiece,
} from "./pieces";
import { type Grip, HEIGHT, inPlane, type Layer, WIDTH } from "./viewport";

const GROUND = "ground";
/** Free space beside a body that leaves the picture, in units of the drawing. */
const MARGIN = 120;
/** Length of a body's principal axes, in units of the drawing. */
const AXIS_LENGTH = 46;
/** The drawing is this many times as wide as the radius of the circle that holds the mechanism. */
const RADII_SHOWN = 2.2;
/** Smallest radius that is drawn, m: a single point has none. */
const MIN_RADIUS = 0.2;
/** The view is turned about the vertical by this angle, rad: no horizontal axis points at the reader. */
const TURN = 0.42;
/** The view is tilted from above by this angle, rad: the vertical axis hides no horizontal one. */
const TILT = 0.26;

type Point = [number, number];

/** A joint that stands on the ground. */
interface GroundJoint {
  point: Vec3;
  name: string;
}

export class Sketch {
  readonly root = svg("svg", {
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
    class: "sketch",
    role: "img",
    "aria-label": "Line drawing of the mechanism",
  });
  private readonly view: Axes;
  private pieces: Piece[] | undefined;
  private perMetre = 1;
  /** The point of the world in the middle of the drawing, along the axes of the view. */
  private middle: Point = [0, 0];
  private last: SessionState | undefined;
  /** Left, top, right, bottom: grows when a body leaves the picture, and stays so until it is drawn anew. */
  private frame: [number, number, number, number] = [0, 0, WIDTH, HEIGHT];

  /** `over` is drawn above the mechanism; `choose` is called with the name of a joint that is clicked. */
  constructor(
    private scene: Scene | undefined,
    private readonly over: Layer[],
    private readonly choose: (joint: string) => void,
  ) {
    this.view = viewAxes(scene?.gravity);
  }

  update(state: SessionState): void {
    this.last = state;
    this.pieces ??= this.build(state);
    for (const piece of this.pieces) {
      const frame = state.bodies[piece.body];
      if (frame) piece.place(piece.points.map((point) => this.project(inWorld(frame, point))));
    }
    this.widen(state);
    for (const layer of this.over) layer.update(state, (p) => this.project(p), this.perMetre);
  }

  /** Draws a changed scene from its start. */
  rebuild(scene: Scene): void {
    this.scene = scene;
    this.pieces = undefined;
    this.frame = [0, 0, WIDTH, HEIGHT];
    this.root.setAttribute("viewBox", this.frame.join(" "));
  }

  /** The body under a point of the drawing, and the point of it that was grabbed. */
  grip(target: Element, x: number, y: number): Grip | undefined {
    const piece = this.pieces?.find(
      (entry) => entry.element === target && !entry.element.matches(".sketch-axis, .sketch-joint"),
    );
    const frame = piece && this.last?.bodies[piece.body];
    if (!piece || !frame) return undefined;
    // The point under the mouse, in the plane of the drawing through the middle of the piece.
    const sum = piece.points.reduce((total, point) => add(total, point), [0, 0, 0] as Vec3);
    const middle = inWorld(frame, scale(sum, 1 / piece.points.length));
    const [mx, my] = this.project(middle);
    return { body: frame.name, at: add(middle, this.move(x - mx, y - my)) };
  }

  /** The shift in the world that a shift on the drawing means. */
  move(dx: number, dy: number): Vec3 {
    return inPlane(this.view, this.perMetre)(dx, dy);
  }

  private project(p: Vec3): Point {
    const [x, y] = flat(this.view, p);
    const [mx, my] = this.middle;
    return [WIDTH / 2 + (x - mx) * this.perMetre, HEIGHT / 2 - (y - my) * this.perMetre];
  }

  /** Makes all elements and chooses the scale, so that the mechanism fits. */
  private build(state: SessionState): Piece[] {
    const grounds = this.groundJoints();
    const made = [...this.shapes(state), ...this.movingJoints(state), ...this.movingMarkers(state)];
    this.fit(state, made, grounds);
    for (const piece of made) piece.element.style.setProperty("--px", String(this.perMetre));
    made.push(...state.bodies.flatMap((_, at) => axisPieces(at, AXIS_LENGTH / this.perMetre)));
    this.root.replaceChildren(
      ...made.map((piece) => piece.element),
      ...grounds.map(({ point, name }) => {
        const [cx, cy] = this.project(point);
        return this.clickable(svg("circle", { cx, cy, r: JOINT_RADIUS, class: "sketch-joint" }), name);
      }),
      ...this.groundMarkers(),
      ...this.over.map((layer) => layer.root),
    );
    return made;
  }

  private stated(frame: BodyState): Body | undefined {
    return this.scene?.bodies?.find((body) => body.name === frame.name);
  }

  private shapes(state: SessionState): Piece[] {
    return state.bodies.flatMap((frame, at) => {
      const stated = this.stated(frame);
      const toBody = converter(frame, stated);
      return (stated?.shape ?? []).map((shape) => shapePiece(shape, at, toBody));
    });
  }

  private groundJoints(): GroundJoint[] {
    return (this.scene?.joints ?? []).flatMap((joint) => {
      if (joint.body_i !== GROUND && joint.body_j !== GROUND) return [];
      const point = (joint.body_i === GROUND ? joint.point_i : joint.point_j) ?? joint.point;
      return point ? [{ point, name: joint.name }] : [];
    });
  }

  /** Joints between two moving bodies. */
  private movingJoints(state: SessionState): Piece[] {
    return (this.scene?.joints ?? []).flatMap((joint) => {
      if (joint.body_i === GROUND || joint.body_j === GROUND) return [];
      const at = state.bodies.findIndex((body) => body.name === joint.body_j);
      const frame = state.bodies[at];
      const piece = frame && jointPiece(frame, at, this.stated(frame), joint);
      if (!piece) return [];
      this.clickable(piece.element, joint.name);
      return [piece];
    });
  }

  private movingMarkers(state: SessionState): Piece[] {
    return (this.scene?.markers ?? []).flatMap(({ name, body, point }) => {
      const at = state.bodies.findIndex((frame) => frame.name === body);
      const frame = state.bodies[at];
      if (!frame) return [];
      const stated = this.stated(frame);
      const toBody = converter(frame, stated);
      return [markerPiece(at, name, toBody(point ?? [0, 0, 0]))];
    });
  }

  private groundMarkers(): SVGElement[] {
    const own = (this.scene?.markers ?? []).filter(({ body }) => body === GROUND);
    return own.map(({ name, point }) => {
      const element = markerElement(name);
      moveMarker(element, this.project(point ?? [0, 0, 0]));
      return element;
    });
  }

  private clickable<E extends SVGElement>(element: E, joint: string): E {
    element.addEventListener("click", () => this.choose(joint));
    return element;
  }

  /** Mechanisms swing about their ground: the circle around it that holds the first picture is kept in view. */
  private fit(state: SessionState, made: Piece[], grounds: GroundJoint[]): void {
    const fixed = grounds.map((joint) => flat(this.view, joint.point));
    const drawn = made.flatMap((piece) => {
      const frame = state.bodies[piece.body];
      return frame ? piece.points.map((point) => inWorld(frame, point)) : [];
    });
    const points = [
      ...fixed,
      ...[...state.bodies.map((frame) => frame.position), ...drawn].map((p) => flat(this.view, p)),
    ];
    const around = fixed.length > 0 ? fixed : points;
    const mean = (k: 0 | 1): number =>
      around.reduce((sum, point) => sum + point[k], 0) / Math.max(1, around.length);
    const [x, y] = [mean(0), mean(1)];
    const radius = Math.max(MIN_RADIUS, ...points.map(([px, py]) => Math.hypot(px - x, py - y)));
    this.middle = [x, y];
    this.perMetre = Math.min(WIDTH, HEIGHT) / (radius * RADII_SHOWN);
  }

  /** Widens the picture where a body has left it. */
  private widen(state: SessionState): void {
    let [left, top, right, bottom] = this.frame;
    for (const body of state.bodies) {
      const [x, y] = this.project(body.position);
      if (!Number.isFinite(x + y)) continue;
      if (x < 0 || x > WIDTH) [left, right] = [Math.min(left, x - MARGIN), Math.max(right, x + MARGIN)];
      if (y < 0 || y > HEIGHT) [top, bottom] = [Math.min(top, y - MARGIN), Math.max(bottom, y + MARGIN)];
    }
    if ([left, top, right, bottom].every((side, at) => side === this.frame[at])) return;
    this.frame = [left, top, right, bottom];
    this.root.setAttribute("viewBox", `${left} ${top} ${right - left} ${bottom - top}`);
  }
}

/** A point along a body's axes as a point of the world. */
function inWorld(frame: BodyState, point: Vec3): Vec3 {
  return add(frame.position, out([frame.u, frame.v, frame.w], point));
}

/** To the right and up on the drawing, and away from the reader. */
function viewAxes(gravity: Vec3 | undefined): Axes {
  const up: Vec3 = gravity && norm(gravity) > 0 ? unit(scale(gravity, -1)) : [0, 0, 1];
  const horizontal: Vec3 = Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const right = unit(sub(horizontal, scale(up, dot(horizontal, up))));
  const toward = cross(right, up);
  const turnedRight = add(scale(right, Math.cos(TURN)), scale(toward, -Math.sin(TURN)));
  const away = add(scale(toward, Math.cos(TURN)), scale(right, Math.sin(TURN)));
  const tiltedUp = add(scale(up, Math.cos(TILT)), scale(away, -Math.sin(TILT)));
  return [turnedRight, tiltedUp, away];
}

const flat = (view: Axes, p: Vec3): Point => [dot(view[0], p), dot(view[1], p)];
