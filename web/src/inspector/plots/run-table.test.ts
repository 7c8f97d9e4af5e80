import { expect, it } from "vitest";
import type { Scene } from "../../api/types";
import { chosen } from "./run-table";

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
