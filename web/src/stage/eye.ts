// From where the drawing is seen: parallel projection, so that equal lengths are equal wherever they are.

import type { Camera, Vec3 } from "../api/types";
import { type Axes, add, cross, dot, norm, scale, sub, unit } from "../mechanics/vec";
import type { Point } from "./pen";

/** Turn about the vertical and tilt from above, rad, of each side. */
const SIDES: Record<Camera, [turn: number, tilt: number]> = {
  // No axis points at the reader, and the vertical hides no horizontal one.
  corner: [0.42, 0.26],
  front: [0, 0],
  side: [Math.PI / 2, 0],
  above: [0, Math.PI / 2],
};
/** Free space around what is fitted, as a part of the picture. */
const MARGIN = 0.08;
/** Smallest part of the world that fills the picture, m: a single point has no size. */
const SMALLEST = 0.05;

/** A rectangle of the plane of the picture, m: left, bottom, right, top. */
export type Box = [number, number, number, number];

/** The smallest box about points of that plane; `undefined` about none. */
export function boxOf(points: Iterable<Point>): Box | undefined {
  let box: Box | undefined;
  for (const [x, y] of points) {
    if (!Number.isFinite(x + y)) continue;
    box ??= [x, y, x, y];
    box = [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)];
  }
  return box;
}

const upward = (gravity: Vec3 | undefined): Vec3 =>
  gravity && norm(gravity) > 0 ? unit(scale(gravity, -1)) : [0, 0, 1];

export class Eye {
  width = 800;
  height = 500;
  /** CSS pixels. */
  perMetre = 100;
  /** Along the axes of the view, m: what is in the middle. */
  middle: Point = [0, 0];
  /** To the right, up, and toward the reader. */
  axes: Axes;
  private turn = 0;
  private tilt = 0;

  /** The corner from which this mechanism is seen best. */
  private corner: [turn: number, tilt: number] = SIDES.corner;

  /** `up` is a unit vector. */
  constructor(public up: Vec3) {
    this.axes = this.made();
    this.lookFrom("corner");
  }

  /** With gravity down, or z up without it. */
  static under(gravity: Vec3 | undefined): Eye {
    return new Eye(upward(gravity));
  }

  /** Who follows a lecture learns only from its scene which way is down. */
  standUnder(gravity: Vec3 | undefined): void {
    this.up = upward(gravity);
    this.axes = this.made();
  }

  /** Looks as another eye does. */
  like(other: Eye): void {
    [this.turn, this.tilt] = [other.turn, other.tilt];
    this.axes = this.made();
  }

  lookFrom(side: Camera): void {
    [this.turn, this.tilt] = side === "corner" ? this.corner : SIDES[side];
    this.axes = this.made();
  }

  /** A mechanism that moves in a plane of this normal is seen nearly along it from the corner. */
  faceOn(normal: Vec3): void {
    const [right, toward] = this.level();
    const [turn, tilt] = SIDES.corner;
    if (Math.abs(dot(normal, this.up)) > 0.7) this.corner = [turn, Math.PI / 2 - 2 * tilt];
    else {
      const sense = dot(normal, toward) + 1e-9 * dot(normal, right) < 0 ? -1 : 1;
      const facing = Math.atan2(sense * dot(normal, right), sense * dot(normal, toward));
      this.corner = [facing + turn, tilt];
    }
    this.lookFrom("corner");
  }

  /** Goes around the mechanism, about a point that stays where it is on the picture. */
  orbit(turn: number, tilt: number, about: Vec3): void {
    const before = this.project(about);
    this.turn += turn;
    this.tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.tilt + tilt));
    this.axes = this.made();
    const [x, y] = this.project(about);
    this.middle[0] += (x - before[0]) / this.perMetre;
    this.middle[1] -= (y - before[1]) / this.perMetre;
  }

  /** Nearer or farther, about a point of the picture. */
  zoom(by: number, [x, y]: Point): void {
    const [dx, dy] = [x - this.width / 2, this.height / 2 - y];
    const before = this.perMetre;
    this.perMetre = before * by;
    this.middle[0] += dx / before - dx / this.perMetre;
    this.middle[1] += dy / before - dy / this.perMetre;
  }

  /** The scale at which a box of the plane of the picture fits, CSS pixels a metre; `above` and `below` stay free, px. */
  scaleOf([left, bottom, right, top]: Box, above = 0, below = 0): number {
    const width = Math.max(SMALLEST, right - left);
    const height = Math.max(SMALLEST, top - bottom);
    const free = 1 - 2 * MARGIN;
    const room = Math.max(1, this.height - above - below);
    return Math.min((free * this.width) / width, (free * room) / height);
  }

  /** Puts such a box in the middle of the picture, as large as it fits. */
  fit(box: Box, above = 0, below = 0): void {
    const [left, bottom, right, top] = box;
    this.perMetre = this.scaleOf(box, above, below);
    this.middle = [(left + right) / 2, (bottom + top) / 2 + (above - below) / (2 * this.perMetre)];
  }

  /** A point of the world in the plane of the picture, m. */
  flat(p: Vec3): Point {
    return [dot(this.axes[0], p), dot(this.axes[1], p)];
  }

  /** A point of the world as a point of the picture. */
  project(p: Vec3): Point {
    const [x, y] = this.flat(p);
    return [
      this.width / 2 + (x - this.middle[0]) * this.perMetre,
      this.height / 2 - (y - this.middle[1]) * this.perMetre,
    ];
  }

  /** How near a point is: what is nearer hides what is farther. */
  nearness(p: Vec3): number {
    return dot(this.axes[2], p);
  }

  /** The shift in the world, in the plane of the picture, that a shift on it means. */
  shift(dx: number, dy: number): Vec3 {
    return add(scale(this.axes[0], dx / this.perMetre), scale(this.axes[1], -dy / this.perMetre));
  }

  /** Whether horizontal planes are seen as more than lines. */
  get seesFloor(): boolean {
    return dot(this.axes[2], this.up) > 0.03;
  }

  /** Horizontal: to the right and toward the reader before any turn. */
  private level(): [Vec3, Vec3] {
    const { up } = this;
    const horizontal: Vec3 = Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
    const right = unit(sub(horizontal, scale(up, dot(horizontal, up))));
    return [right, cross(right, up)];
  }

  private made(): Axes {
    const { up, turn, tilt } = this;
    const [right, toward] = this.level();
    const turned = sub(scale(right, Math.cos(turn)), scale(toward, Math.sin(turn)));
    const level = add(scale(toward, Math.cos(turn)), scale(right, Math.sin(turn)));
    const upward = sub(scale(up, Math.cos(tilt)), scale(level, Math.sin(tilt)));
    return [turned, upward, add(scale(level, Math.cos(tilt)), scale(up, Math.sin(tilt)))];
  }
}
