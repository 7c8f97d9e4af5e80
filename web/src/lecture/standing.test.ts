import { afterEach, expect, it, vi } from "vitest";
import type { SessionScene } from "../api/types";
import type { Pose } from "../mechanics/pose";
import { analysisIn, viewOfPose } from "./analysis-view";
import type { Follower } from "./follower";
import { changedTold, statusOf } from "./standing";

const parameter = {
  name: "gravity",
  label: "Gravity",
  unit: "m/s²",
  initial: 9.81,
  value: 9.81,
  pointers: ["/gravity/1"],
};
/** A scene as it runs: its author's has a bob of 2 kg and 9.81 m/s². */
function view(value: number, mass: number, more: object = {}): SessionScene {
  const scene = (g: number, m: number): object => ({
    gravity: [0, -g, 0],
    bodies: [{ name: "bob", mass: m }],
  });
  return {
    parameters: [{ ...parameter, value }],
    scene: { ...scene(value, mass), ...more },
    original: scene(9.81, 2),
  } as unknown as SessionScene;
}

afterEach(() => vi.unstubAllGlobals());

it("followers are told which numbers were changed, from what and to what", () => {
  vi.stubGlobal("navigator", { languages: ["en"] });
  expect(changedTold(undefined)).toBe("");
  expect(changedTold(view(9.81, 2))).toBe("");
  expect(changedTold(view(5, 2))).toBe("Changed by the presenter: Gravity 9.81 → 5\u00a0m/s².");
  expect(changedTold(view(5, 3))).toBe(
    "Changed by the presenter: Gravity 9.81 → 5\u00a0m/s² and bodies › bob › mass 2 → 3.",
  );
});

const placed = { position: [1 / 3, 0, 0], u: [1, 0, 0], v: [0, 1, 0], w: [0, 0, 1] };
const motion = {
  translation: [1, 0, 0],
  rotation: [0, 0, 0],
  translation_later: [0, 0, 0],
  rotation_later: [0, 0, 0],
};
const pose = { bodies: [placed], shape: [motion], size: 0.2 } as unknown as Pose;

it("an analysis is seen by followers as the presenter sees it, or told of where it is too large", () => {
  expect(viewOfPose(undefined)).toBeUndefined();
  const sent: unknown = JSON.parse(JSON.stringify({ time: 1, ...viewOfPose(pose) }));
  const seen = analysisIn(sent, 1);
  expect(seen?.pose?.bodies[0]?.position[0]).toBe(0.333333);
  expect(seen?.pose?.shape).toHaveLength(1);
  expect(viewOfPose({ bodies: Array.from({ length: 2000 }, () => pose.bodies[0] as never) })).toEqual({
    analysis: true,
  });
});

it("a view that is no analysis, or a forged one, poses nothing", () => {
  expect(analysisIn({ time: 1 }, 1)).toBeUndefined();
  expect(analysisIn(null, 1)).toBeUndefined();
  for (const bodies of [
    [],
    "x",
    [{ ...placed, u: [1, 0] }],
    [{ ...placed, w: [1, 0, "0"] }],
    [placed, placed],
  ])
    expect(analysisIn({ analysis: true, pose: { bodies } }, 1)).toEqual({ analysis: true });
});

it("that the presenter looks at an analysis is told plainly", () => {
  const status = (view: unknown, more: object = {}): string =>
    statusOf({
      lecture: { source: { builtin: "x" } },
      analysis: analysisIn(view, 1),
      ...more,
    } as unknown as Follower);
  expect(status({ time: 1 })).toBe("You see what the presenter shows.");
  expect(status({ analysis: true, pose })).toMatch(/^The picture shows the result of an analysis/);
  expect(status({ analysis: true })).toMatch(/^The presenter looks at the result of an analysis/);
  expect(status({ analysis: true }, { roaming: true })).toMatch(/^You look around/);
});
