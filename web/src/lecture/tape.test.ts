import { expect, it } from "vitest";
import type { Motion } from "../api/types";
import { fromBase64, toBase64 } from "../session/packed";
import { at, type Look, playing, Tape } from "./tape";

const look: Look = {
  joint: null,
  drawn: { what: "all" },
  camera: "corner",
  blank: false,
  question: null,
  remark: null,
};

/** A block of `count` frames of one body, 0.01 s apart. */
function motion(count: number): Motion {
  const block = new Uint8Array(16 + count * (8 + 4 * 21));
  const view = new DataView(block.buffer);
  for (const [k, value] of [1, 0, count].entries()) view.setUint32(4 * k, value, true);
  for (let k = 0; k < count; k += 1) view.setFloat64(16 + 8 * k, k / 100, true);
  return { title: "one body", track: toBase64(block), until: (count - 1) / 100 } as unknown as Motion;
}

it("a lecture is played as it was shown, and long pauses are shortened", () => {
  let clock = 5000;
  const tape = new Tape("a lecture", () => clock);
  tape.see(0, 0, look);
  // A minute of talk, then two seconds of a run, seen often: one moment tells them.
  clock += 60_000;
  for (let k = 0; k <= 20; k += 1, clock += 100) tape.see(k / 10, 1, look);
  tape.see(2.2, 0, look);
  // A short step while it stands is seen too.
  tape.see(2.1, 0, look);
  clock += 10_000;
  tape.see(2.1, 0, { ...look, joint: "pin" });
  clock += 1000;
  const taped = tape.taped(motion(211));
  expect(taped.moments.map(([, part]) => part)).toEqual([0, 0, 0, 0, 0, 0]);
  const shown = playing(taped);
  expect(shown.map(({ from }) => Number(from.toFixed(6)))).toEqual([0, 3, 5.1, 5.1, 8.1, 9.1]);
  expect(at(shown, 1)?.run).toBe(0);
  expect(at(shown, 4.5)?.run).toBeCloseTo(1.5);
  expect(at(shown, 6)?.run).toBe(2.1);
  expect(taped.looks[at(shown, 9)?.moment[4] ?? -1]?.joint).toBe("pin");
});

it("runs one after the other keep their motions, the oldest are thinned, and an unknown one is told", () => {
  let clock = 0;
  const tape = new Tape("a lecture", () => clock);
  const long = motion(2000);
  for (let k = 0; k < 30; k += 1, clock += 1000) {
    tape.see(0, 0, look);
    tape.cut(long);
  }
  // The same run cannot be cut twice, as after a connection that was lost.
  tape.cut(long);
  tape.see(0, 0, look);
  const taped = tape.taped(undefined);
  expect(taped.parts.length).toBe(30);
  expect(taped.moments.map(([, part]) => part).slice(-3)).toEqual([29, -1, -1]);
  const letters = taped.parts.map((part) => part.track.length);
  expect(letters.reduce((sum, each) => sum + each, 0)).toBeLessThanOrEqual(3e6);
  expect(letters[0]).toBeLessThan(letters[29] ?? 0);
  expect(fromBase64(taped.parts[29]?.track ?? "").length).toBe(16 + 2000 * 92);
});

it("an hour of moments is bounded, and nothing that was shown is lost", () => {
  let clock = 0;
  const tape = new Tape("a lecture", () => clock);
  for (let k = 0; k < 20_000; k += 1, clock += 200)
    tape.see(k, 0, { ...look, joint: k % 1000 < 3 ? "pin" : null });
  const { moments, looks } = tape.taped(undefined);
  expect(moments.length).toBeLessThanOrEqual(4001);
  expect(new Set(moments.map((moment) => moment[4])).size).toBe(looks.length);
});

it("a lecture goes on after the page was reloaded", () => {
  let clock = 1000;
  const tape = new Tape("a lecture", () => clock);
  tape.see(0, 1, look);
  clock += 1000;
  tape.see(1, 0, { ...look, joint: "pin" });
  tape.cut(motion(101));
  const kept = JSON.parse(JSON.stringify(tape.taped(undefined)));
  // The clock of another page begins anew, and another run with it.
  clock = 0;
  const again = new Tape(kept.title, () => clock, kept);
  clock += 500;
  again.see(0, 0, { ...look, joint: "pin" });
  clock += 500;
  const taped = again.taped(motion(11));
  expect([taped.parts.length, taped.looks.length, taped.began]).toEqual([2, 2, kept.began]);
  expect(taped.moments.map(([, part]) => part)).toEqual([0, 0, 0, 1, 1]);
  const times = taped.moments.map(([at]) => at);
  expect(times).toEqual([...times].sort((a, b) => a - b));
  expect(at(playing(taped), 0.5)?.run).toBeCloseTo(0.5);
});
