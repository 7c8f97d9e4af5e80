import { expect, it } from "vitest";
import type { Vec3 } from "../api/types";
import { cross, dot, norm, sub } from "../mechanics/vec";
import { boxOf, Eye } from "./eye";

const points: Vec3[] = [
  [0, 0, 0],
  [1, -0.3, 0.2],
  [-0.5, 0.8, 1.1],
];

it("axes are at right angles, and what is fitted is inside and fills the picture", () => {
  const eye = Eye.under([0, -9.81, 0]);
  for (const side of ["corner", "front", "side", "above"] as const) {
    eye.lookFrom(side);
    const [right, up, near] = eye.axes;
    expect(norm(sub(cross(right, up), near))).toBeLessThan(1e-12);
    expect(Math.abs(dot(right, up))).toBeLessThan(1e-12);
    const box = boxOf(points.map((p) => eye.flat(p)));
    if (!box) throw new Error("three points have a box");
    eye.fit(box, 20, 60);
    const seen = points.map((p) => eye.project(p));
    for (const [x, y] of seen) {
      expect(x).toBeGreaterThan(0);
      expect(x).toBeLessThan(eye.width);
      expect(y).toBeGreaterThan(20);
      expect(y).toBeLessThan(eye.height - 60);
    }
    const extent = (k: 0 | 1): number =>
      Math.max(...seen.map((p) => p[k])) - Math.min(...seen.map((p) => p[k]));
    expect(Math.max(extent(0) / eye.width, extent(1) / (eye.height - 80))).toBeCloseTo(0.84);
  }
});

it("turning and coming closer leave the point in question where it is", () => {
  const eye = Eye.under([0, 0, -9.81]);
  const [, about] = points as [Vec3, Vec3];
  const before = eye.project(about);
  eye.orbit(0.7, -0.2, about);
  eye.zoom(1.7, eye.project(about));
  const after = eye.project(about);
  expect(after[0]).toBeCloseTo(before[0]);
  expect(after[1]).toBeCloseTo(before[1]);
});

it("a mechanism in a plane is seen from its front, whatever plane that is", () => {
  for (const normal of [
    [0, 0, 1],
    [1, 0, 0],
    [0, -1, 0],
    [0.6, 0.8, 0],
  ] as Vec3[]) {
    const eye = Eye.under([0, 0, -9.81]);
    eye.faceOn(normal);
    expect(Math.abs(dot(eye.axes[2], normal))).toBeGreaterThan(0.8);
  }
});

it("a shift of the picture is the same shift of the world", () => {
  const eye = Eye.under(undefined);
  const [a, b] = [eye.project([0, 0, 0]), eye.project(eye.shift(30, -12))];
  expect(b[0] - a[0]).toBeCloseTo(30);
  expect(b[1] - a[1]).toBeCloseTo(-12);
});

it("stands as gravity says once that is known", () => {
  const late = Eye.under(undefined);
  late.standUnder([0, -9.81, 0]);
  expect(late.axes).toEqual(Eye.under([0, -9.81, 0]).axes);
});
