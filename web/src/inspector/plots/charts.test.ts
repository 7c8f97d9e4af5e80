import { expect, it } from "vitest";
import type { Reactions } from "../../api/types";
import { state } from "../../testing/state";
import { charts, labelOf, lostIn, markShared, within } from "./charts";
import { plotSvg } from "./svg-file";

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

it("where nothing is known of the error any more, plots and values say so", () => {
  const lost = { ...state(9, 1), error_unknown_from: 4.5 };
  const available = charts(lost);
  const of = (label: string) =>
    available.find((chart) => chart.label === label) as (typeof available)[number];
  expect(lostIn(of("Position of bob"), lost)).toBe(4.5);
  expect(lostIn(of("Position of bob"), state(9, 1))).toBeUndefined();
  expect(lostIn(of("Constraint violation"), lost)).toBeUndefined();
  const [x] = of("Position of bob").curves;
  expect(x && within(x, lost)).toBe(" ± ?");
  expect(x && within(x, state(9, 1))).toBe("");
  // Of a force at a singular position, beside quantities whose errors are known.
  const here = {
    ...state(0, 1),
    accuracy: { position: 1e-9 } as never,
    forces: [{ joint: "A", on: "a" } as never],
  };
  const [force] = charts(here).find(({ key }) => key === "joint:A:force")?.curves ?? [];
  expect(force && within(force, here)).toBe(" ± ?");
  const line = { label: "x", unit: "m", values: [0, 1], color: "red", dash: [] };
  const picture = (from?: number) =>
    plotSvg("x", [0, 9], [line], { ink: "#000", line: "#ccc", paper: "#fff" }, [], from);
  expect(picture(4.5)).toMatch(/<rect x="482.0" [^>]*fill-opacity="0\.16"\/>.*error unknown/);
  expect(picture()).not.toContain("error unknown");
  expect(picture(9)).not.toContain("error unknown");
});
