import { expect, it } from "vitest";
import type { Motion } from "../api/types";
import { Recorded } from "./recorded";

/** Two frames of one body that moves along x, and of one joint whose force grows, as the server packs them. */
function motion(): Motion {
  const frame = (x: number, force: number): number[] => [
    ...[x, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1],
    ...[2, 0, 0, 0, 0, 0, 0, 0, 0],
    ...[x, 0, 0, force, 0, 0, 0, 0, 0],
  ];
  const bytes = new Uint8Array(16 + 2 * (8 + 4 * 30));
  const view = new DataView(bytes.buffer);
  for (const [k, count] of [1, 1, 2, 0].entries()) view.setUint32(4 * k, count, true);
  for (const [k, time] of [0, 2].entries()) view.setFloat64(16 + 8 * k, time, true);
  for (const [k, x] of [...frame(0, 10), ...frame(4, 30)].entries()) view.setFloat32(32 + 4 * k, x, true);
  return {
    title: "a slide",
    scene: { name: "slide", gravity: [0, 0, -9.81] },
    until: 2,
    speed: 1,
    bodies: ["block"],
    joints: [{ joint: "rail", on: "block", by: "ground" }],
    force_scale: 0.1,
    moment_scale: 0.1,
    longest: 1,
    track: btoa(String.fromCharCode(...bytes)),
  } as unknown as Motion;
}

it("a recorded run has its bodies and forces between its frames, and ends where it ends", () => {
  const run = new Recorded(motion(), { what: "all" });
  const halfway = run.moment(1);
  expect(halfway.bodies[0]).toMatchObject({ name: "block", position: [2, 0, 0] });
  expect(halfway.forces[0]).toMatchObject({ joint: "rail", force: [20, 0, 0] });
  expect(run.moment(9).bodies[0]?.position).toEqual([4, 0, 0]);
  expect(run.latest.time).toBe(2);
});
