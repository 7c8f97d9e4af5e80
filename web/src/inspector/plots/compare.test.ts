import { describe, expect, it } from "vitest";
import { type ModeMotion, type Placed, swung, turned } from "../../mechanics/pose";
import { norm } from "../../mechanics/vec";
import { columnsOf, difference, resample } from "./compare";
import { plotSvg, tickLabels, ticks } from "./svg-file";

describe("two runs", () => {
  it("are compared at the times of the present one, where both exist", () => {
    const kept = resample([0, 1, 2], [0, 10, 0], [0, 0.5, 1, 1.5, 2, 3]);
    expect(kept).toEqual([0, 5, 10, 5, 0, null]);
    expect(difference([1, 5, 9, 5, 0, 7], kept)).toEqual({ values: [1, 0, -1, 0, 0, null], largest: 1 });
    expect(resample([1, 2], [3, 4], [0])).toEqual([null]);
  });
  it("make a picture that is well-formed whatever the names", () => {
    const text = plotSvg(
      "a < b & c",
      [0, 1],
      [{ label: "<x>", unit: "m", values: [0, null], color: "red", dash: [2, 2] }],
      { ink: "#000", line: "#ccc", paper: "#fff" },
    );
    expect(text).toContain("a &lt; b &amp; c");
    expect(text).not.toContain("NaN");
  });
  it("show the estimated error as a band, which ends where it is not known", () => {
    const line = { label: "x", unit: "m", values: [0, 1, 2, 3], color: "red", dash: [] };
    const colors = { ink: "#000", line: "#ccc", paper: "#fff" };
    const bands = (errors: (number | null)[]): string | undefined =>
      plotSvg("x", [0, 1, 2, 3], [{ ...line, errors }], colors).match(/<path d="([^"]*)" fill="red"/)?.[1];
    expect(bands([0.1, 0.1, 0.1, 0.1])?.match(/[MLZ]/g)?.join("")).toBe("MLLLLLLLZ");
    expect(bands([0.1, 0.1, null, 0.1])?.match(/[MLZ]/g)?.join("")).toBe("MLLLZMLZ");
    expect(bands([])).toBeUndefined();
  });
  it("have axes whose labels are the values there", () => {
    const told = (text: string): number => Number(text.replace("−", "-").replace("e−", "e-"));
    for (const values of [
      [0, 5e-10, 1e-9, 1.5e-9, 2e-9],
      [-2.5e-4, 0, 2.5e-4, 5e-4],
      [150_000, 200_000, 250_000],
      [1.000_002, 1.000_004, 1.000_006],
      [9.806_649_75, 9.806_65],
      [0.1, 0.2, 0.30000000000000004],
      [1e-12, 1e-9, 1e-6, 1],
    ]) {
      const labels = tickLabels(values);
      for (const [k, value] of values.entries())
        expect(Math.abs(told(labels[k] ?? "") - value)).toBeLessThanOrEqual(1e-9 * Math.abs(value));
      expect(Math.max(...labels.map((label) => label.length))).toBeLessThan(11);
    }
    expect(tickLabels([0.1, 0.2, 0.30000000000000004, null])).toEqual(["0.1", "0.2", "0.3", ""]);
    expect(tickLabels([-1e5, 0, 1e5])).toEqual(["−1e5", "0", "1e5"]);
  });
  it("have round ticks", () => {
    expect(ticks(0, 10)).toEqual([0, 2, 4, 6, 8, 10]);
    expect(ticks(-0.3, 0.3).map((tick) => Number(tick.toFixed(3)))).toContain(0.1);
  });
});

describe("a mode", () => {
  const body = { position: [1, 0, 0], u: [1, 0, 0], v: [0, 1, 0], w: [0, 0, 1] } as const;
  const shape: ModeMotion = {
    translation: [0, 1, 0],
    rotation: [0, 0, 1],
    translation_later: [0, 0, 1],
    rotation_later: [0, 0, 0],
  };
  it("moves bodies by its parts and keeps their axes square", () => {
    const [start] = swung([body as unknown as Placed], [shape], 0, 0.5);
    expect(start?.position).toEqual([1, 0.5, 0]);
    expect(start?.u[0]).toBeCloseTo(Math.cos(0.5));
    expect(start?.u[1]).toBeCloseTo(Math.sin(0.5));
    const [quarter] = swung([body as unknown as Placed], [shape], Math.PI / 2, 0.5);
    expect(quarter?.position[2]).toBeCloseTo(0.5);
    expect(norm(turned([1, 2, 3], [0.3, -2, 1]))).toBeCloseTo(Math.sqrt(14));
  });
});

describe("a reference file", () => {
  it("is read with its names and remarks, and refused where it is no table", () => {
    const read = columnsOf("# from a paper\ntime,bob.x,bob.y\ns,m,m\n0,1,2\n1,3,4\n");
    expect(read).toEqual({
      times: [0, 1],
      columns: [
        { label: "bob.x", values: [1, 3] },
        { label: "bob.y", values: [2, 4] },
      ],
    });
    expect(columnsOf("no table at all\n1\n2")).toBeUndefined();
  });
});
