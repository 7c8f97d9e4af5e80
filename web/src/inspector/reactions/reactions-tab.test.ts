import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { SessionState } from "../../api/types";
import { Clock } from "../../session/clock";
import type { Session } from "../../session/session";
import { fake, fakePage } from "../../testing/page";
import { state } from "../../testing/state";
import { ReactionsTab } from "./reactions-tab";

vi.mock("../../core/keys", () => ({ bind: vi.fn() }));

beforeEach(() => {
  fakePage();
  vi.useFakeTimers();
});
afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

const accuracy = {
  position: 0,
  turn: 0,
  velocity: 0,
  angular_velocity: 0,
  energy: 0,
  force: 2e-10,
  moment: 0,
};
const entry = {
  joint: "A",
  on: "a",
  by: "ground",
  about: "the joint",
  about_at: [0, 0, 0],
  expressed_in: "world",
  force: [0, 0, 0].map((value) => ({ value, unique: true })),
  moment: [0, 0, 0].map((value) => ({ value, unique: true })),
};

it("what reactions are worth is told of the moment that they are of, while those of another are asked for", async () => {
  const answers: (() => void)[] = [];
  vi.stubGlobal("fetch", (path: string) => {
    const told = path.includes("multipliers") ? [] : { time: 0.5, reactions: [entry], redundancies: [] };
    return new Promise<Response>((done) => answers.push(() => done(Response.json(told))));
  });
  const at = (time: number, known: boolean): SessionState => ({
    ...state(time, 0),
    forces: [
      { joint: "A", on: "a", by: "ground", at: [0, 0, 0], force: [0, 0, 0], moment: [0, 0, 0] } as never,
    ],
    accuracy: known ? accuracy : { ...accuracy, force: null, moment: null },
  });
  const clock = Object.assign(new Clock(), {
    convention: { on: "j", about: "joint", in: "world" },
    drawn: { what: "all" },
    joint: null,
    controls: true,
  });
  for (const one of [at(0, false), at(0.5, true)]) clock.past.add(one);
  clock.latest = at(0.5, true);
  const tab = new ReactionsTab(clock as unknown as Session);
  const settled = async (): Promise<void> => {
    for (const answer of answers.splice(0)) answer();
    await vi.advanceTimersByTimeAsync(1000);
  };
  tab.refresh();
  await settled();
  const told = (): string => fake(tab.root).textContent;
  expect(told()).toContain("At 0.500 s.Estimated error at 0.500 s");
  clock.seek(0);
  tab.refresh();
  clock.trace("none");
  expect(told()).toContain("At 0.500 s.Estimated error at 0.500 s");
  await settled();
  expect(told()).toContain("At 0.000 s nothing is known of their error");
});
