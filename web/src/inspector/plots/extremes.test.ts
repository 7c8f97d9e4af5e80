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

describe("extremes of a curve of few samples", () => {
  it("are those of a sample, and not sure, where the samples do not tell where the curve turns", () => {
    // The height of a pendulum of 1 m, at 16 uneven times of 2.3 s: a parabola through three of them turns below -1.
    const sparse = Array.from({ length: 16 }, (_, k) => (2.3 * (k + (k % 3) * 0.4)) / 15.4);
    const height = (time: number): number => -Math.cos((Math.PI / 2) * Math.cos(2.7 * time));
    const found = extremes(sparse, sparse.map(height));
    expect(found.filter(({ sure }) => !sure).length).toBeGreaterThan(1);
    for (const { time, value } of found) {
      expect(value).toBeGreaterThanOrEqual(-1);
      expect(value).toBeCloseTo(height(time), 3);
    }
    // The same curve at the frames of a run.
    const frames = Array.from({ length: 231 }, (_, k) => k / 100);
    const lowest = extremes(frames, frames.map(height)).filter(({ kind }) => /minimum|smallest/.test(kind));
    expect(lowest.length).toBeGreaterThan(1);
    for (const { value, sure } of lowest) {
      expect(sure).toBe(true);
      expect(value).toBeCloseTo(-1, 4);
    }
  });

  it("are not sure at a corner, however close the samples are", () => {
    const corner = extremes(
      times,
      times.map((t) => Math.min(t, 9.13 - t)),
    ).find(({ kind }) => kind === "largest");
    expect(corner).toMatchObject({ sure: false });
    expect(corner?.value).toBeLessThanOrEqual(9.13 / 2);
  });

  it("are not sure where the digits that are told are more than the samples give, though the time is", () => {
    const fine = Array.from({ length: 21 }, (_, k) => k / 100);
    const sure = (rate: number): boolean[] =>
      extremes(
        fine,
        fine.map((t) => Math.sin(rate * t)),
      ).map((one) => one.sure);
    expect(sure(60)).toContain(false);
    expect(sure(8)).toEqual([true, true]);
    // And where the time is not known, though the value is.
    const high = extremes(
      times,
      times.map((t) => 100 + Math.sin(6 * t)),
    );
    expect(high.map((one) => one.sure)).toContain(false);
  });
});
