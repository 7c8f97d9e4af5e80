import { describe, expect, it } from "vitest";
import { type Arrow, type Diagram, forceAt, placesThere } from "./arrows";

const arrow = (at: string, along: Arrow["along"]): Arrow => ({ kind: "force", at, on: "mass", along });

describe("forces at a point where several things stand", () => {
  const there = ["bar", "plane", "centre"];

  it("belong to the joint, and where it has one on the line, to the centre of mass", () => {
    expect(forceAt([], there, "mass", "+y")).toBe("bar");
    expect(forceAt([arrow("bar", "+x")], there, "mass", "+y")).toBe("bar");
    expect(forceAt([arrow("bar", "+y")], there, "mass", "-y")).toBe("centre");
  });

  it("turn round in place where no weight acts", () => {
    expect(forceAt([arrow("hinge", "+y")], ["hinge", "motor"], "mass", "-y")).toBe("hinge");
  });

  it("can be given to whatever else stands there", () => {
    const places = [
      { id: "bar", label: "bar", at: [10, 20] },
      { id: "centre", label: "centre of mass", at: [10, 20] },
      { id: "tip", label: "tip", at: [30, 20] },
    ];
    const diagram = { bodies: [{ name: "mass", places }] } as unknown as Diagram;
    expect(placesThere(diagram, arrow("bar", "+y")).map((place) => place.id)).toEqual(["bar", "centre"]);
    expect(placesThere(diagram, arrow("tip", "+y")).map((place) => place.id)).toEqual(["tip"]);
  });
});
