import { expect, it } from "vitest";
import { block } from "../testing/block";
import { state } from "../testing/state";
import { Clock } from "./clock";

it("numbers are those of the latest recorded moment, as the picture is, and nothing between two of them", () => {
  const clock = new Clock();
  const end = state(1, 10);
  for (const one of [state(0, 0), end]) clock.past.add(one);
  clock.latest = end;
  clock.track.add(
    block([
      { time: 0, x: 0, force: 0 },
      { time: 0.5, x: 2, force: 0 },
      { time: 0.6, x: 3, force: 0 },
    ]),
  );
  const seen = (time: number): [number, number] => {
    clock.seek(time);
    return [clock.lastRecorded?.time ?? Number.NaN, clock.lastRecorded?.bodies[0]?.position[0] ?? Number.NaN];
  };
  expect(seen(0.5)).toEqual([0.5, 2]);
  expect(seen(0.53)).toEqual([0.5, 2]);
  expect(seen(0.9)).toEqual([0.6, 3]);
  expect(seen(0.2)).toEqual([0, 0]);
  expect(seen(1)).toEqual([1, 10]);
});
