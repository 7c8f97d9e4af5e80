import { expect, it } from "vitest";
import { parseSlides } from "./kept-slides";

it("slides that were kept are read back, and what is damaged is left out", () => {
  const slides = [
    { view: { time: 2, joint: "pin" }, notes: "ask first", picture: "data:image/webp;base64,AA" },
  ];
  expect(parseSlides(JSON.stringify(slides))).toEqual(slides);
  // As an earlier version kept them.
  expect(parseSlides(JSON.stringify([{ time: 2, joint: "pin" }, "x", { time: -1 }]))).toEqual([
    { view: { time: 2, joint: "pin" } },
    { view: {} },
  ]);
  const odd = [{ view: { time: 1 }, notes: 3, picture: "https://elsewhere/x.png" }, { view: 3 }];
  expect(parseSlides(JSON.stringify(odd))).toEqual([{ view: { time: 1 } }]);
  expect(parseSlides("{")).toEqual([]);
  expect(parseSlides(null)).toEqual([]);
});
