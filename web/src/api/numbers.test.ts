import { describe, expect, it } from "vitest";
import { at, between, leaves, none, tidy } from "./numbers";
import type { Scene, SessionScene } from "./types";

const original: Scene = {
  name: "pendulum",
  gravity: [0, -9.81, 0],
  bodies: [{ name: "bob", mass: 1, shape: [{ kind: "sphere", center: [0, 0, 0], radius: 1 }] }],
  coordinates: "full",
};
const view: SessionScene = {
  parameters: [
    {
      name: "mass",
      label: "Mass",
      pointers: ["/bodies/0/mass"],
      value: 1,
      initial: 1,
      low: 0,
      high: 5,
      step: null,
      unit: "kg",
      on_change: "continue",
    },
  ],
  scene: original,
  original,
};

describe("numbers of a scene", () => {
  it("are found by pointers and called by the names of their elements", () => {
    expect(at(original, "/bodies/0/mass")).toBe(1);
    expect(at(original, "/bodies/4/mass")).toBeUndefined();
    expect(leaves(original).map((leaf) => `${leaf.pointer} ${leaf.label}`)).toEqual([
      "/gravity/0 gravity › x",
      "/gravity/1 gravity › y",
      "/gravity/2 gravity › z",
      "/bodies/0/mass bodies › bob › mass",
    ]);
  });
  it("go back to what the author wrote when a deviation ends", () => {
    const changed = { values: { mass: 3 }, places: { "/coordinates": "reduced", "/gravity/1": -1 } };
    expect(between(none(), changed, view)).toEqual(changed);
    expect(between(changed, none(), view)).toEqual({
      values: { mass: 1 },
      places: { "/coordinates": "full", "/gravity/1": -9.81 },
    });
    expect(between(changed, { ...changed, values: { mass: 2 } }, view)).toEqual({
      values: { mass: 2 },
      places: {},
    });
  });
  it("are no deviation where they equal the original", () => {
    expect(
      tidy({ values: { mass: 1 }, places: { "/gravity/1": -9.81, "/coordinates": "reduced" } }, view),
    ).toEqual({ values: {}, places: { "/coordinates": "reduced" } });
  });
});
