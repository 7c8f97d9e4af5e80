import { expect, it } from "vitest";
import { freeLabel, overlap, type Place } from "./labels";

it("on a phone's stage no name covers another or leaves the picture, and a short one takes the place of a long one", () => {
  const picture = { width: 360, height: 240 };
  const taken: Place[] = [];
  const said: string[] = [];
  // Six arrows from nearly one point, as at the hub of a mechanism.
  for (let k = 0; k < 6; k += 1) {
    const turn = (2 * Math.PI * k) / 6;
    const label = freeLabel(
      {
        start: [180, 120],
        tip: [180 + 12 * Math.cos(turn), 120 + 12 * Math.sin(turn)],
        words: [`connecting-rod-${k} 1234.5 N, 0.123 N m`, `connecting-rod-${k}`],
        size: 13,
      },
      picture,
      taken,
    );
    if (!label) continue;
    expect(label.place[0]).toBeGreaterThanOrEqual(0);
    expect(label.place[2]).toBeLessThanOrEqual(picture.width);
    expect(taken.some((other) => overlap(label.place, other))).toBe(false);
    taken.push(label.place);
    said.push(label.words);
  }
  expect(said).toEqual(Array.from({ length: 6 }, (_, k) => `connecting-rod-${k}`));
});

it("where there is room a name stands beside its tip, away from the arrow", () => {
  const picture = { width: 800, height: 500 };
  const named = { start: [300, 200], tip: [400, 100], words: ["pin 20 N"], size: 17 } as const;
  const label = freeLabel({ ...named, start: [300, 200], tip: [400, 100] }, picture, []);
  expect(label).toMatchObject({ words: "pin 20 N", at: [410, 94], anchor: "start" });
  const below = freeLabel({ ...named, start: [400, 100], tip: [300, 200] }, picture, []);
  expect(below).toMatchObject({ at: [290, 217], anchor: "end" });
  expect(freeLabel({ ...named, start: [0, 0], tip: [10, 10], size: 200 }, picture, [])).toBeUndefined();
});
