import { expect, it } from "vitest";
import type { Reaction } from "../../api/types";
import { components, errorAtRest, errorOfMotion } from "./results";

const part = (value: number, unique = true): Reaction["force"][number] => ({ value, unique });

it("forces and moments are told with their signs", () => {
  const force: Reaction["force"] = [part(-132.694764), part(2e-16), part(3, false)];
  const moment: Reaction["moment"] = [part(0), part(0), part(-44.196949)];
  expect(components({ force, moment }, 6)).toEqual(["−132.695", "0", "≈ 3", "0", "0", "−44.1969"]);
});

it("the error of positions is told as the command line tells it", () => {
  expect(errorAtRest({ error: 4.440892098500774e-15 })).toBe("Error: positions right to about 4e−15 m.");
  expect(errorAtRest({ error: 0 })).toBe("Error: positions right to about 2e−16 m.");
  expect(errorAtRest({ error: null })).toContain("not known along motions that meet no stiffness");
  expect(errorOfMotion({ correction: 1.23e-14 })).toMatch(
    /^Error: positions right to about 1\.2e−14 m, axes/,
  );
});
