import { expect, it } from "vitest";
import { chosen, grouped, titled } from "./groups";

const of = (...names: string[]) => names.map((name) => ({ name, summary: "" }));

it("each scene stands in one group, also one that no list knows", () => {
  const scenes = of("squeezer", "bricard", "n-four-bar:N", "heavy-top", "quite-new");
  const all = grouped(scenes).flatMap(([, list]) => list.map((scene) => scene.name));
  expect(all.sort()).toEqual(scenes.map((scene) => scene.name).sort());
  expect(chosen(scenes).map((scene) => scene.name)).toEqual([
    "bricard",
    "heavy-top",
    "squeezer",
    "n-four-bar:N",
  ]);
});

it("names become words", () => {
  expect(["n-four-bar:N", "rssr", "squeezer:ivp"].map(titled)).toEqual([
    "N four bar",
    "RSSR",
    "Squeezer, ivp",
  ]);
});
