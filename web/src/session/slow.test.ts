import { expect, it } from "vitest";
import { onward, SLOWER } from "./slow";

const marks = [{ time: 5, words: "" }];

it("a replay goes on as fast as time where nothing is marked", () => {
  expect(onward(1, 2, [], 10)).toBe(3);
  expect(onward(1, 2, marks, 10)).toBeCloseTo(3, 12);
});

it("a replay lingers near a mark, and passes it", () => {
  // Within 0.3 s of the mark a second of the clock is a fifth of one of the run.
  expect(onward(4.9, 0.5, marks, 10)).toBeCloseTo(4.9 + SLOWER * 0.5, 12);
  expect(onward(4, 4, marks, 10)).toBeGreaterThan(5);
  expect(onward(4, 4, marks, 10)).toBeLessThan(6);
  // In many small steps as in one.
  let time = 4;
  for (let k = 0; k < 400; k += 1) time = onward(time, 0.01, marks, 10);
  expect(time).toBeCloseTo(onward(4, 4, marks, 10), 1);
});
