import { afterEach, expect, it, vi } from "vitest";
import { fixed, num, sci, seconds, typedIn, typedNumber, unclearComma } from "./format";
import { loadLanguage } from "./texts";

afterEach(() => vi.unstubAllGlobals());

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

it("a comma that may part thousands is told, any other is a decimal comma", () => {
  for (const text of ["1,500", "-2,368", " 10,000 kg", "+999,999"]) {
    expect(typedNumber(text)).toBeNaN();
    expect(unclearComma(text)).toMatch(/^The comma in “\d+,\d{3}” can be read in two ways/);
  }
  expect(typedIn("kg", "1,500 kg")).toBeNaN();
  for (const [text, value] of [
    ["1,5", 1.5],
    ["0,125", 0.125],
    ["1,5000", 1.5],
    ["1234,567", 1234.567],
    ["1.500", 1.5],
    ["1,500e3", 1500],
  ] as const) {
    expect(typedNumber(text)).toBe(value);
    expect(unclearComma(text)).toBeUndefined();
  }
});

it("no number of a German page has three digits alone behind a point, which may part thousands", async () => {
  expect([seconds(10), fixed(1.5, 3), num(12.345), num(-1.125)]).toEqual([
    "10.000 s",
    "1.500",
    "12.345",
    "−1.125",
  ]);
  vi.stubGlobal("navigator", { languages: ["de"] });
  vi.stubGlobal("document", { documentElement: {} });
  await loadLanguage();
  expect([seconds(10), fixed(1.5, 3), num(12.345), num(-1.125)]).toEqual([
    "10.0000 s",
    "1.5000",
    "12.3450",
    "−1.1250",
  ]);
  // What cannot be a thousand stays as it is.
  expect([seconds(10, 2), fixed(1.5), num(0.125), num(1234.567, 7), num(12.5), sci(1.234e-9, 4)]).toEqual([
    "10.00 s",
    "1.5000",
    "0.125",
    "1234.567",
    "12.5",
    "1.234e−9",
  ]);
});
