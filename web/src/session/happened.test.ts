import { expect, it, vi } from "vitest";
import type { SessionState } from "../api/types";
import { announce } from "../core/dom";
import { state } from "../testing/state";
import { Clock } from "./clock";
import { endedBy, happenings, leftOut, shareLists } from "./happened";

vi.mock("../core/dom", () => ({ announce: vi.fn() }));
vi.stubGlobal("navigator", { languages: ["en"] });

const event = (name: string, time: number, stop = false): SessionState["events"][number] => ({
  name,
  time,
  rate: 1,
  stop,
});

const passed = (time: number, ...joints: string[]): SessionState["passages"][number] => ({ time, joints });

it("events and passages stand in the order of time, with what their times are worth", () => {
  const now = {
    ...state(3, 0),
    events: [{ ...event("lowest", 0.5919832), error: 2.3e-9 }, event("halt", 2, true)],
    passages: [passed(1.25, "a", "b"), passed(1.5, ..."abcdefgh")],
  };
  expect(happenings(now).map(({ kind, when, words }) => [kind, when, words])).toEqual([
    ["event", "0.591983 s ± 2e−9 s", "lowest"],
    ["passage", "1.250000 s", "singular position passed, at a and b"],
    ["passage", "1.500000 s", "singular position passed, at a, b, c, d, and 4 more"],
    ["stop", "2.000000 s", "“halt”: the run ends there"],
  ]);
  expect(happenings(now).map(({ sentence }) => sentence)).toEqual([
    "“lowest” at 0.591983 s",
    "Singular position passed at 1.250000 s, at a and b",
    "Singular position passed at 1.500000 s, at a, b, c, d, and 4 more",
    "“halt” ended the run at 2.000000 s",
  ]);
  expect(leftOut({ ...now, earlier_events: 3, earlier_passages: 4 })).toBe(7);
});

it("a run is ended by the event at which it stands, and by none that it has left behind", () => {
  const at = (time: number, finished: boolean): SessionState => ({
    ...state(time, 0),
    finished,
    events: [event("lowest", 1), event("halt", 2, true)],
  });
  expect(endedBy(at(2, true))?.name).toBe("halt");
  expect(endedBy({ ...at(2, true), events: [event("halt", 2, true), event("gate", 2)] })?.name).toBe("halt");
  // With other numbers it went on, and has come to its end.
  expect(endedBy(at(10, true))).toBeUndefined();
  expect(endedBy(at(2, false))).toBeUndefined();
  expect(endedBy({ ...at(1, true), events: [event("lowest", 1)] })).toBeUndefined();
  expect(endedBy(undefined)).toBeUndefined();
});

it("who hears the page hears by which event the run was ended", () => {
  class Told extends Clock {
    tell(now: SessionState): void {
      this.latest = now;
      this.announceState();
    }
  }
  const clock = new Told();
  const said = (): string => vi.mocked(announce).mock.lastCall?.[0] ?? "";
  clock.tell({ ...state(2, 0), finished: true, events: [event("halt", 2, true)] });
  expect(said()).toMatch(/^“halt” ended the run at 2.000 s after 0 steps/);
  clock.tell({ ...state(10, 0), finished: true });
  expect(said()).toMatch(/^The run is complete at 10.000 s/);
});

it("lists that are those of the state before are kept once", () => {
  const [one, same, more] = [1, 1, 2].map((n) => ({
    ...state(n, 0),
    events: Array.from({ length: n }, (_, k) => event("lowest", k)),
    passages: [passed(0.5, "a")],
  })) as [SessionState, SessionState, SessionState];
  shareLists(one, same);
  expect(same.events).toBe(one.events);
  shareLists(same, more);
  expect(more.events).toHaveLength(2);
  expect(more.passages).toBe(one.passages);
  const moved = { ...more, earlier_events: 1, events: [...more.events] };
  shareLists(more, moved);
  expect(moved.events).not.toBe(more.events);
});
