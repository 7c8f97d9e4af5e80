import { describe, expect, it } from "vitest";
import type { BodyFrame, Drawing, SessionState, Vec3 } from "../core/types";
import { arrows, freeBody, momentAbout, roundDown } from "./force-model";
import { History } from "./history";
import { cellAt, groups, layout } from "./matrix";
import { axesOf, cross, norm, sub } from "./vec";

const body: BodyFrame = {
  name: "bob",
  position: [1, 0, 0],
  u: [0, 1, 0],
  v: [-1, 0, 0],
  w: [0, 0, 1],
  velocity: [0, 0, 0],
  angular_velocity: [0, 0, 0],
  acceleration: [0, 0, 0],
  mass: 1,
};
const drawing: Drawing = {
  on: "j",
  about: "joint",
  drawn: "all",
  marked: null,
  force_scale: 0.1,
  moment_scale: 0.1,
  longest: 1,
  camera: "corner",
};

describe("axesOf", () => {
  it("agrees between the three ways to state a turn", () => {
    const turn = Math.PI / 3;
    const axis = axesOf({ axis: [0, 0, 2], angle: turn });
    const quaternion = axesOf({ quaternion: [Math.cos(turn / 2), 0, 0, Math.sin(turn / 2)] });
    const vectors = axesOf({
      u: [Math.cos(turn), Math.sin(turn), 0],
      v: [-Math.sin(turn), Math.cos(turn), 0],
    });
    for (const k of [0, 1, 2] as const) {
      expect(norm(sub(axis[k], quaternion[k]))).toBeLessThan(1e-15);
      expect(norm(sub(axis[k], vectors[k]))).toBeLessThan(1e-15);
    }
  });
});

const state = (time: number, x: number): SessionState => ({
  id: "a",
  title: "",
  links: { self: "", stream: "" },
  time,
  duration: 10,
  playing: false,
  speed: 1,
  q: [],
  q_dot: [],
  energy: 0,
  energy_drift: 0,
  position_violation: 0,
  velocity_violation: 0,
  steps: 0,
  rejected: 0,
  evaluations: 0,
  factorizations: 0,
  finished: false,
  changes: 0,
  drawing,
  forces: [],
  gravity: [0, 0, -9.81],
  bodies: [{ ...body, position: [x, 0, 0] as Vec3 }],
});

describe("History", () => {
  it("finds, mixes and goes back", () => {
    const past = new History();
    for (const t of [0, 1, 2]) past.add(state(t, 10 * t));
    expect(past.at(1.5)?.time).toBe(1);
    expect(past.before(1)?.time).toBe(0);
    expect(past.before(0)).toBeUndefined();
    expect(past.between(1.25)?.bodies[0]?.position[0]).toBeCloseTo(12.5);
  });
  it("starts anew when time jumps back, and stays bounded", () => {
    const past = new History();
    for (let k = 0; k < 10_000; k += 1) past.add(state(k, 0));
    expect(past.all.length).toBeLessThanOrEqual(3000);
    expect(past.all[0]?.time).toBe(0);
    expect(past.all.at(-1)?.time).toBe(9999);
    past.add(state(5, 0));
    expect(past.all.length).toBe(1);
  });
});

describe("matrix layout", () => {
  it("groups names and finds cells", () => {
    expect(groups(["bob: uu", "bob: vv", "pin: CP.x"])).toEqual([
      { name: "bob", from: 0, count: 2 },
      { name: "pin", from: 2, count: 1 },
    ]);
    expect(groups(["λ bob: uu", "λ bob: vv", "λ pin: CP.x"]).map((group) => group.name)).toEqual([
      "λ bob",
      "λ pin",
    ]);
    expect(groups(["bob.rx", "arm.rx"]).map((group) => group.name)).toEqual(["bob", "arm"]);
    const grid = layout(3, 12, 700, true);
    expect(cellAt(grid, 3, 12, grid.left + 2.5 * grid.cell, grid.top + 1)).toEqual({ row: 0, column: 2 });
    expect(cellAt(grid, 3, 12, grid.left - 1, grid.top + 1)).toBeUndefined();
  });
});

describe("forces", () => {
  const hanging = (): SessionState => ({
    ...state(0, 0),
    gravity: [0, -10, 0],
    bodies: [{ ...body, mass: 2, position: [1, 0, 0], acceleration: [0, -4, 0] }],
    forces: [{ joint: "pin", on: "bob", by: "ground", at: [0, 0, 0], force: [0, 10, 0], moment: [0, 0, 1] }],
  });
  it("on a body cut free add up to mass times acceleration, whatever loads act", () => {
    const { arrows: list, sum, inertia } = freeBody(hanging(), "bob");
    expect(list.map((arrow) => [arrow.label, arrow.force])).toEqual([
      ["weight", [0, -20, 0]],
      ["pin", [0, 10, 0]],
      ["loads together", [0, 2, 0]],
    ]);
    expect(sum).toEqual(inertia);
    expect(list[1] && momentAbout(list[1], [1, 0, 0])).toEqual([0, 0, -9]);
  });
  it("are reversed on the first body", () => {
    expect(arrows(hanging(), { what: "all" }, null, { on: "i", about: "joint" })[0]?.force).toEqual([
      -0, -10, -0,
    ]);
    expect(arrows(hanging(), { what: "joint" }, "other", { on: "j", about: "joint" })).toEqual([]);
  });
  it("move to the centre of mass with the moment that this takes", () => {
    const [arrow] = arrows(hanging(), { what: "all" }, null, { on: "j", about: "center" });
    expect(arrow?.at).toEqual([1, 0, 0]);
    expect(arrow?.moment).toEqual([0, 0, 1 + cross([-1, 0, 0], [0, 10, 0])[2]]);
  });
  it("have a legend of a round number", () => {
    expect(roundDown(96)).toBe(50);
    expect(roundDown(0.2)).toBeCloseTo(0.2);
  });
});
