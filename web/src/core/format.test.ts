import { expect, it } from "vitest";
import { typedIn } from "./format";

it("a number may be typed with the unit that stands behind its field", () => {
  expect(typedIn("kg", "2 kg")).toBe(2);
  expect(typedIn("kg", " 2,5kg ")).toBe(2.5);
  expect(typedIn("kg", "2.5")).toBe(2.5);
  expect(typedIn("kg m²", "0.3 kg m²")).toBe(0.3);
  expect(typedIn("N s/m", "−4 Ns/m")).toBe(-4);
  expect(typedIn("1/s", "5 1/s")).toBe(5);
  expect(typedIn("", "7")).toBe(7);
});

it("another unit, a part of one or a unit alone is no number", () => {
  for (const text of ["2 g", "2 k", "kg", "2 kg kg", "", "kg 2"]) expect(typedIn("kg", text)).toBeNaN();
  expect(typedIn("m", "2 mm")).toBeNaN();
  expect(typedIn("m/s²", "2 s²")).toBeNaN();
  expect(typedIn("1/s", "51/s")).toBeNaN();
});
