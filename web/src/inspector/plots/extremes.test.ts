import { describe, expect, it } from "vitest";
import { extremes } from "./extremes";

const times = Array.from({ length: 101 }, (_, k) => k / 10);

describe("extremes of a curve", () => {
  it("stand where a sine turns, between the values that are known", () => {
    const found = extremes(times, times.map(Math.sin));
    expect(found.map(({ kind }) => kind)).toEqual(["largest", "smallest", "maximum"]);
    for (const [k, { time, value }] of found.entries()) {
      expect(time).toBeCloseTo((k + 0.5) * Math.PI, 3);
      expect(Math.abs(value)).toBeCloseTo(1, 5);
    }
  });

  it("are the ends where a curve only rises, and none where it is constant", () => {
    expect(extremes(times, times).map(({ time, kind }) => [time, kind])).toEqual([
      [0, "smallest"],
      [10, "largest"],
    ]);
    expect(
      extremes(
        times,
        times.map(() => 3),
      ),
    ).toEqual([]);
  });

  it("are not made by noise, nor by values that are missing", () => {
    const noisy = times.map((t, k) => (k === 50 ? NaN : Math.sin(t / 3) + (k % 2) * 0.005));
    expect(extremes(times, noisy).length).toBeLessThanOrEqual(3);
  });

  it("are bounded, and those that stand out most", () => {
    const found = extremes(
      times,
      times.map((t) => t * Math.sin(8 * t)),
    );
    expect(found).toHaveLength(6);
    expect(Math.min(...found.map(({ time }) => time))).toBeGreaterThan(6);
  });
});
