import { expect, it } from "vitest";
import type { Scene } from "../../api/types";
import { chosen, offeredOf } from "./run-table";

it("keeps the single elements that a scene chooses", () => {
  const scene = {
    name: "s",
    bodies: [],
    simulation: { outputs: ["reactions:pin", "reactions:rail", "energy"] },
  };
  const of = scene as unknown as Scene;
  expect(chosen(["reactions", "joints"], of)).toEqual(["reactions:pin", "reactions:rail", "joints"]);
  expect(chosen(["joints"], { ...of, simulation: {} })).toEqual(["joints"]);
});

it("offers errors of a run that estimates them", () => {
  const of = (simulation: object): string[] =>
    offeredOf({ simulation } as unknown as Scene).map(([kind]) => kind);
  expect(of({})).toContain("errors");
  expect(of({ error_estimate: false })).toEqual(of({}).filter((kind) => kind !== "errors"));
});
