import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Clock } from "../session/clock";
import type { Session } from "../session/session";
import { fake, fakePage } from "../testing/page";
import { state } from "../testing/state";
import { legend } from "./legend";

beforeEach(fakePage);
afterEach(() => vi.unstubAllGlobals());

const joint = {
  joint: "pin",
  on: "bob",
  by: "ground",
  at: [0, 0, 0],
  force: [0, 4.86, 0],
  moment: [0, 0, 0],
};

it("the force of the run is not told while an analysis stands in its place, and is again at any moment of the run", () => {
  const clock = new Clock();
  const convention = { on: "j", about: "joint", in: "world" };
  const session = Object.assign(clock, {
    joint: "pin",
    drawn: { what: "all" },
    convention,
  }) as unknown as Session;
  const made = legend(session);
  const shown = (): [boolean, string] => [
    !made.root.hidden,
    fake(made.root).querySelector("b")?.textContent ?? "",
  ];
  for (const time of [0, 1]) session.past.add({ ...state(time, 0), forces: [joint as never] });
  session.latest = { ...state(1, 0), forces: [joint as never] };
  session.seek(1);
  expect(shown()).toEqual([true, "pin: 4.86 N"]);
  session.setPose({ bodies: [] });
  expect(shown()[0]).toBe(false);
  session.seek(0);
  expect(session.pose).toBeUndefined();
  expect(shown()[0]).toBe(true);
  session.setPose({ bodies: [] });
  made.dispose();
  session.seek(1);
  expect(shown()[0]).toBe(false);
});
