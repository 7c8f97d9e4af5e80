// Three numbers at a time.
import type { Orientation, Vec3 } from "../api/types";

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a: Vec3, k: number): Vec3 => [a[0] * k, a[1] * k, a[2] * k];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const norm = (a: Vec3): number => Math.sqrt(dot(a, a));
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

export function unit(a: Vec3): Vec3 {
  const length = norm(a);
  return length > 0 ? scale(a, 1 / length) : a;
}

/** Three axes, each in world components. */
export type Axes = [Vec3, Vec3, Vec3];

/** Components along `axes` of a vector given in the world. */
export const along = (axes: Axes, a: Vec3): Vec3 => [dot(axes[0], a), dot(axes[1], a), dot(axes[2], a)];

/** The world vector with the components `a` along `axes`. */
export const out = (axes: Axes, a: Vec3): Vec3 =>
  add(add(scale(axes[0], a[0]), scale(axes[1], a[1])), scale(axes[2], a[2]));

/** The axes of a body's frame from any of the three ways to state an orientation. */
export function axesOf(orientation: Orientation | null | undefined): Axes {
  if (orientation?.u && orientation.v) {
    const u = unit(orientation.u);
    const w = unit(cross(u, orientation.v));
    return [u, cross(w, u), w];
  }
  if (orientation?.quaternion) return fromQuaternion(orientation.quaternion);
  if (orientation?.axis && typeof orientation.angle === "number") {
    const axis = unit(orientation.axis);
    const s = Math.sin(orientation.angle / 2);
    return fromQuaternion([Math.cos(orientation.angle / 2), axis[0] * s, axis[1] * s, axis[2] * s]);
  }
  return [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
}

function fromQuaternion(q: [number, number, number, number]): Axes {
  const length = Math.hypot(...q) || 1;
  const [w, x, y, z] = q.map((part) => part / length) as [number, number, number, number];
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];
}
