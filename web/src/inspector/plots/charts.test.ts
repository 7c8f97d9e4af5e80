import { expect, it } from "vitest";
import type { Reactions } from "../../api/types";
import { state } from "../../testing/state";
import { charts, labelOf, markShared } from "./charts";

it("curves of reactions that are not unique are marked, in the plot of the joint and in its hodograph", () => {
  const force = { joint: "pin", on: "bob", by: "ground", force: [1, 2, 3], moment: [0, 0, 0], at: [0, 0, 0] };
  const available = charts({ ...state(0, 1), forces: [force] } as unknown as Parameters<typeof charts>[0]);
  const labels = (part: string): string[] =>
    available.find(({ label }) => label.startsWith(part))?.curves.map(labelOf) ?? [];
  expect(labels("Force in pin")).toEqual(["Fx", "Fy", "Fz"]);
  const parts = (open: number): { value: number; unique: boolean }[] =>
    [0, 1, 2].map((k) => ({ value: k, unique: k !== open }));
  const found = { reactions: [{ joint: "pin", force: parts(2), moment: parts(0) }] };
  markShared(available, found as unknown as Reactions);
  expect(labels("Force in pin")).toEqual(["Fx", "Fy", "≈ Fz"]);
  expect(labels("Moment in pin")).toEqual(["≈ Mx", "My", "Mz"]);
  expect(labels("Hodograph of the force")).toEqual(["Fy", "≈ Fz", "≈ Fz"]);
  expect(labels("Velocity of bob")).toEqual(["vx", "vy", "vz"]);
  // Another run of the scene may have other joints.
  const all = { reactions: [{ joint: "pin", force: parts(9), moment: parts(9) }] };
  markShared(available, all as unknown as Reactions);
  expect(labels("Force in pin")).toEqual(["Fx", "Fy", "Fz"]);
});
