import { expect, it } from "vitest";
import type { GradedSubmission } from "../api/types";
import { standings } from "./standing";

const verdict = (lesson: string, more: Partial<GradedSubmission>): GradedSubmission =>
  ({ lesson, gradable: true, possible: 5, earned: 0, passed: false, ...more }) as GradedSubmission;

it("what was handed in is to mend until it is passed, and passed for ever", () => {
  const found = standings([
    verdict("a", { earned: 3 }),
    verdict("a", { earned: 1 }),
    verdict("b", { earned: 5, passed: true }),
    verdict("b", { earned: 2 }),
    verdict("c", { gradable: false, earned: null }),
  ]);
  expect(found.get("a")).toEqual({ is: "mend", earned: 3, possible: 5 });
  expect(found.get("b")).toEqual({ is: "passed", earned: 5, possible: 5 });
  expect(found.get("c")).toEqual({ is: "mend", earned: undefined, possible: 5 });
  expect(found.get("d")).toBeUndefined();
});
