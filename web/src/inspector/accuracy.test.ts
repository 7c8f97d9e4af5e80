import { expect, it } from "vitest";
import { state } from "../testing/state";
import { OF_BODIES, OF_JOINTS, within, worth } from "./accuracy";

const accuracy = { position: 1.2e-10, turn: 3e-11, velocity: 9e-10, angular_velocity: 2e-9, energy: 1e-10 };

it("what bodies and reactions are worth stands beside them", () => {
  const known = { ...state(1.34, 0), accuracy: { ...accuracy, force: 8e-9, moment: 4e-10 } };
  expect(worth(known, OF_JOINTS)).toBe(
    "Estimated error at 1.340 s, the largest of all: forces 8e−9\u00a0N, moments about the joint 4e−10\u00a0N\u00a0m.",
  );
  expect(worth(known, OF_BODIES)).toMatch(/positions 1e−10\u00a0m, velocities 9e−10\u00a0m\/s, directions /);
});

it("where nothing is known of the error, that is said", () => {
  expect(worth({ ...state(50, 0), error_unknown_from: 41.2 }, OF_BODIES)).toMatch(
    /^From 41\.200 s on nothing/,
  );
  expect(worth(state(1, 0), OF_BODIES)).toBe("This run gives no estimate of their error.");
  expect(worth({ ...state(1, 0), accuracy }, OF_JOINTS)).toBe("This run gives no estimate of their error.");
});

it("a unit is not parted from its number", () => {
  expect(within({ ...state(1, 0), accuracy }, "velocity", "m/s")).toBe("about 9e−10\u00a0m/s");
});
