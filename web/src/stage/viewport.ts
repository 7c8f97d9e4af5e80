// The area that the sketch and its layers are drawn on.
import type { SessionState, Vec3 } from "../api/types";
import { type Axes, add, scale } from "../mechanics/vec";

/** Size of the drawing, in units of the drawing. */
export const WIDTH = 800;
export const HEIGHT = 500;

/** A point of the world as a point of the drawing. */
export type Project = (p: Vec3) => [number, number];

/** What is drawn over the mechanism. */
export interface Layer {
  root: SVGGElement;
  update: (state: SessionState, project: Project, perMetre: number) => void;
}

export interface Grip {
  body: string;
  /** Where it was grabbed, in the world. */
  at: Vec3;
}

/** A shift on the screen in the plane of the drawing. */
export const inPlane =
  (view: Axes, perMetre: number) =>
  (dx: number, dy: number): Vec3 =>
    add(scale(view[0], dx / perMetre), scale(view[1], -dy / perMetre));
