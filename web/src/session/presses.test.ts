import { expect, test } from "vitest";
import { type Kind, Presses } from "./presses";

/** Presses of a run that is there, or not yet; what was asked, and how what was asked last is answered. */
function pressed(there = true): {
  presses: Presses;
  press: (kind: Kind, name?: string) => Promise<void>;
  asked: string[];
  answer: (error?: Error) => Promise<void>;
  arrive: () => void;
} {
  const asked: string[] = [];
  let settle: (error?: Error) => void = () => {};
  const presses = new Presses(() => there);
  return {
    presses,
    asked,
    press: (kind, name = kind) =>
      presses.add(kind, () => {
        asked.push(name);
        return new Promise((done, failed) => {
          settle = (error) => (error ? failed(error) : done());
        });
      }),
    answer: async (error) => {
      settle(error);
      for (let turn = 0; turn < 4; turn++) await Promise.resolve();
    },
    arrive: () => {
      there = true;
      presses.go();
    },
  };
}

test("what is pressed before there is a run is asked for when it is there, in order", async () => {
  const { press, asked, answer, arrive, presses } = pressed(false);
  const done: string[] = [];
  for (const name of ["first", "second"]) void press("step", name).then(() => done.push(name));
  void press("play");
  expect(asked).toEqual([]);
  expect(presses.pending && !presses.busy && presses.plays).toBe(true);
  arrive();
  expect(asked).toEqual(["first"]);
  await answer();
  expect([asked, done]).toEqual([["first", "second"], ["first"]]);
  await answer();
  await answer();
  expect(asked).toEqual(["first", "second", "play"]);
  expect(presses.pending).toBe(false);
  expect(presses.plays).toBeUndefined();
});

test("of play and pause the last one wins, but none passes a step", async () => {
  const { press, asked, answer, presses } = pressed();
  void press("step");
  let superseded = false;
  void press("play").then(() => {
    superseded = true;
  });
  void press("pause");
  expect(presses.plays).toBe(false);
  void press("play", "play again");
  void press("step", "step again");
  void press("pause", "pause again");
  expect(presses.plays).toBe(false);
  for (let n = 0; n < 5; n++) await answer();
  expect(asked).toEqual(["step", "play again", "step again", "pause again"]);
  expect(superseded).toBe(true);
});

test("a reset takes the place of all that waits but changes and the camera", async () => {
  const { press, asked, answer, presses } = pressed();
  for (const kind of ["step", "step", "camera", "play", "change", "reset", "play"] as const) void press(kind);
  expect([presses.resets, presses.plays]).toEqual([true, true]);
  for (let n = 0; n < 6; n++) await answer();
  expect(asked).toEqual(["step", "camera", "change", "reset", "play"]);
});

test("after a refusal what was to follow is left out, up to a reset; its caller learns of it", async () => {
  const { press, asked, answer, presses } = pressed();
  const first = press("change");
  for (const kind of ["step", "play", "camera"] as const) void press(kind);
  presses.refused();
  void press("step", "anew");
  void answer(new Error("refused"));
  await expect(first).rejects.toThrow("refused");
  for (let n = 0; n < 3; n++) await answer();
  expect(asked).toEqual(["change", "camera", "anew"]);
  void press("step");
  void press("reset");
  presses.refused();
  await answer();
  expect(asked.at(-1)).toBe("reset");
});

test("steps do not wait without end", () => {
  const { press, presses } = pressed(false);
  for (let n = 0; n < 100; n++) {
    expect(presses.full).toBe(false);
    void press("step");
  }
  expect(presses.full).toBe(true);
});
