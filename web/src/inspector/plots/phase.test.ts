import { describe, expect, it } from "vitest";
import { state } from "../../testing/state";
import { charts, quantities } from "./charts";
import { nearest, phasePlot, phaseSvg, scales } from "./phase";
import type { Samples } from "./samples";

const first = state(0, 0);
const states = [0, 1, 2, 3].map((k) => state(k, Math.cos(k)));
const samples: Samples = {
  times: [0, 1, 2, 3],
  of: (curve) => states.map(curve.of),
  errors: () => [],
  apart: [false, false, false],
};
const chart = charts(first).find(({ label }) => label === "Phase plot of bob");
if (!chart) throw new Error("no phase plot is offered");
const plot = phasePlot(chart, samples, states[1] ?? first);

describe("quantities over each other", () => {
  it("are the place and its rate for a phase plot, and two components of one vector for a hodograph", () => {
    expect(plot.ways.map(({ label }) => label)).toEqual(["vx over x", "vy over y", "vz over z"]);
    expect(plot.axes).toEqual(["m", "m/s"]);
    expect(plot.equal).toBe(false);
    const path = charts(first).find(({ label }) => label === "Path of bob");
    const drawn = path && phasePlot(path, samples, first);
    expect(drawn?.ways.map(({ label }) => label)).toEqual(["y over x", "z over x", "z over y"]);
    expect(drawn?.equal).toBe(true);
    expect(path && quantities(path).map(({ label }) => label)).toEqual(["x", "y", "z"]);
  });

  it("have one scale on both axes where they are of one kind", () => {
    const { x, y } = scales({ ...plot, equal: true }, 600, 340);
    expect(x(1) - x(0)).toBeCloseTo(y(0) - y(1), 9);
  });

  it("lead back to the moment that is nearest to a point of the picture", () => {
    const { x, y } = scales(plot, 600, 340);
    for (const [k, value] of (plot.ways[0]?.x ?? []).entries())
      expect(nearest(plot, 600, 340, [x(value) + 1, y(plot.ways[0]?.y[k] ?? NaN)])).toBe(k);
  });

  it("are a file whose line passes all known points, and none that is missing", () => {
    const colors = { ink: "#000", line: "#ccc", paper: "#fff" };
    const torn = {
      ...plot,
      ways: plot.ways.slice(0, 1).map((way) => ({ ...way, x: [...way.x, NaN], y: [...way.y, 1] })),
    };
    const text = phaseSvg(torn, colors, () => "#123456", 600, 340);
    expect(text).not.toContain("NaN");
    expect(text.match(/C[\d.-]/g)).toHaveLength(3);
    expect(text.match(/<circle/g)).toHaveLength(2);
  });

  it("are joined straight and thin where samples lie far apart, with a mark on each side", () => {
    const colors = { ink: "#000", line: "#ccc", paper: "#fff" };
    const way = (apart: boolean[]): string =>
      phaseSvg(
        { ...plot, ways: plot.ways.slice(0, 1).map((one) => ({ ...one, apart })) },
        colors,
        () => "#123456",
        600,
        340,
      );
    const text = way([false, true, false]);
    const join = text.match(/<path class="join" d="([^"]*)"/)?.[1];
    expect(join?.match(/[A-Z]/g)?.join("")).toBe("ML");
    expect(text.match(/C[\d.-]/g)).toHaveLength(2);
    expect(text.match(/<circle/g)).toHaveLength(4);
    expect(way([false, false, false])).not.toContain("join");
  });
});
