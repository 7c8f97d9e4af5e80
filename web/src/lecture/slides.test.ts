import { expect, it } from "vitest";
import { parseSlides } from "./kept-slides";

it("slides that were kept are read back, and what is damaged is left out", () => {
  const slides = [{ time: 2, joint: "pin" }, "x", { time: -1 }];
  expect(parseSlides(JSON.stringify(slides))).toEqual([{ time: 2, joint: "pin" }, {}]);
  expect(parseSlides("{")).toEqual([]);
  expect(parseSlides(null)).toEqual([]);
});
