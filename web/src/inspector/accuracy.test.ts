import { expect, it, vi } from "vitest";
import { fakePage, found } from "../testing/page";
import { state } from "../testing/state";
import { OF_BODIES, OF_JOINTS, within, worth, worthLine } from "./accuracy";

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

it("where rows lose their hold, nothing is known of the error of forces at that moment: the run does estimate it elsewhere", () => {
  const joint = { joint: "A", force: [-4, 0, 0] };
  const singular = { ...state(0, 0), accuracy, forces: [joint as never] };
  expect(worth(singular, OF_JOINTS)).toBe(
    "At 0.000 s nothing is known of their error: these numbers may be far off.",
  );
  expect(worth(singular, OF_BODIES)).toMatch(/^Estimated error/);
  expect(within(singular, "force", "N")).toBe("unknown here");
  expect(within({ ...singular, accuracy: null, error_unknown_from: 0.5 }, "force", "N")).toBe(
    "unknown from 0.500 s",
  );
});

it("why nothing is known stands below it, in the notes of the run", () => {
  fakePage();
  const line = worthLine(OF_JOINTS);
  const notes = ["the start is a singular position"];
  line.show({ ...state(0, 0), accuracy, notes, forces: [{} as never] });
  expect(found(line.root, "ul").textContent).toBe(notes[0]);
  line.show({ ...state(1, 0), accuracy: { ...accuracy, force: 1e-9 }, notes, forces: [{} as never] });
  expect(found(line.root, "ul").textContent).toBe("");
  vi.unstubAllGlobals();
});
