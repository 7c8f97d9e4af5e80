import { expect, it } from "vitest";
import { local, percent, shares, wrongNumber, wrongShares } from "./policy-fields";

it("a moment keeps its seconds in a field of local time", () => {
  for (const moment of ["2026-12-01T23:59:59.000Z", "2026-12-01T22:15:00.000Z", "2026-07-01T08:00:07.250Z"])
    expect(new Date(local(moment)).toISOString()).toBe(moment);
  expect(local("2026-12-01T23:59:59Z")).toMatch(/:59:59$/);
  // No seconds are shown where there are none.
  expect(local("2026-12-01T23:59:00Z")).toMatch(/T\d\d:59$/);
  expect(local(null)).toBe("");
});

it("one number may have a decimal comma", () => {
  const share = { low: 0, high: 100 };
  for (const text of ["87,5", "87.5", "0", " 100 "]) expect(wrongNumber(text, share)).toBeUndefined();
  for (const text of ["", "875", "87,5,1", "-1", "half"])
    expect(wrongNumber(text, share)).toBe("Write a number from 0 to 100.");
  expect(wrongNumber("1,500", { low: 0 })).toMatch(/two ways/);
  const attempts = { low: 1, whole: true, empty: true } as const;
  for (const text of ["", "3"]) expect(wrongNumber(text, attempts)).toBeUndefined();
  for (const text of ["2,5", "0", "x"])
    expect(wrongNumber(text, attempts)).toBe("Write a whole number, 1 or more.");
});

it("a list of shares is read, or what is wrong with it is told", () => {
  for (const text of ["100, 87.5, 80", "100 87.5% 80", "100; 87.5;80"]) {
    expect(wrongShares(text)).toBeUndefined();
    expect(shares(text)).toEqual([1, 0.875, 0.8]);
  }
  expect(wrongShares("")).toBeUndefined();
  expect(shares("")).toEqual([]);
  expect(wrongShares("100; 87,5")).toMatch(/^87,5: a decimal comma, or two numbers\?/);
  expect(wrongShares("100, 900")).toMatch(/^900 is no share/);
  expect(wrongShares("100, half")).toMatch(/^half is no share/);
});

it("a share is shown in percent without digits of its rounding", () => {
  expect([0.07, 0.57, 0.875, 1].map(percent)).toEqual(["7", "57", "87.5", "100"]);
});
