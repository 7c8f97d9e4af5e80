import { describe, expect, it } from "vitest";
import { state } from "../testing/state";
import { History } from "./history";

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
