import { describe, expect, it } from "vitest";
import type { SessionState } from "../api/types";
import { body, state } from "../testing/state";
import { arrows, freeBody, momentAbout, roundDown } from "./forces";
import { cross } from "./vec";

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
