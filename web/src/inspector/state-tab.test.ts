import { expect, it } from "vitest";
import { state } from "../testing/state";
import { between } from "./state-tab";

it("a state that is not of the moment that the picture shows says so", () => {
  const kept = state(0.5, 1);
  expect(between(kept, { time: 0.5, reviewing: true, moving: false })).toBe("");
  expect(between(kept, { time: 0.53, reviewing: false, moving: false })).toBe("");
  expect(between(kept, { time: 0.53, reviewing: true, moving: true })).toBe("");
  expect(between(kept, { time: 0.5, reviewing: false, moving: false, pose: {} })).toMatch(/an analysis/);
  const told = between(kept, { time: 0.53, reviewing: true, moving: false });
  expect(told).toMatch(/^The picture shows 0\.53\S* s\..*those here are of 0\.5\S* s/);
});
