import { expect, it } from "vitest";
import { block } from "../testing/block";
import { state } from "../testing/state";
import { Track } from "./track";

const joint = { joint: "pin", on: "bob", by: "ground", at: [0, 0, 0], force: [0, 0, 0], moment: [0, 0, 0] };
const known = { ...state(0, 0), forces: [joint as never] };

it("bodies and forces stand where they were between two frames", () => {
  const track = new Track();
  track.add(
    block([
      { time: 0, x: 0, force: 10 },
      { time: 0.01, x: 1, force: 20 },
    ]),
  );
  track.add(block([{ time: 0.02, x: 4, force: Number.NaN }]));
  const at = track.at(0.0025, known);
  expect(at?.time).toBe(0.0025);
  expect(at?.bodies[0]?.position[0]).toBeCloseTo(0.25);
  expect(at?.bodies[0]?.velocity[0]).toBeCloseTo(0.5);
  expect(at?.bodies[0]?.angular_velocity[2]).toBeCloseTo(0.75);
  expect(at?.bodies[0]?.acceleration[0]).toBeCloseTo(1);
  expect(at?.forces[0]?.at[0]).toBeCloseTo(0.25);
  expect(at?.forces[0]?.force[0]).toBeCloseTo(12.5);
  // No reaction is known at the third: it stays as the state has it.
  expect(track.at(0.015, known)?.forces[0]?.force[0]).toBe(0);
  expect(track.at(0.015, known)?.bodies[0]?.position[0]).toBeCloseTo(2.5);
  expect(track.at(0.03, known)).toBeUndefined();
});

it("a run that goes on from an earlier time replaces what came after it, and a torn block is left out", () => {
  const track = new Track();
  track.add(
    block([
      { time: 0, x: 0, force: 0 },
      { time: 1, x: 1, force: 0 },
    ]),
  );
  track.add(block([{ time: 0.5, x: 7, force: 0 }]));
  expect(track.at(0.5, known)?.bodies[0]?.position[0]).toBe(7);
  expect(track.at(0.75, known)).toBeUndefined();
  track.add(block([{ time: 0.6, x: 8, force: 0 }]).subarray(0, 40));
  expect(track.at(0.6, known)).toBeUndefined();
});

it("an hour of watching does not grow: what is oldest becomes sparse, and the end stays as it is", () => {
  const most = 100_000;
  const track = new Track(most);
  for (let minute = 0; minute < 60; minute += 1)
    track.add(block(Array.from({ length: 60 }, (_, k) => ({ time: minute * 60 + k, x: k, force: 1 }))));
  const packed = track.pack(Number.POSITIVE_INFINITY) ?? new Uint8Array();
  expect(packed.byteLength).toBeLessThanOrEqual(most);
  const count = new DataView(packed.buffer).getUint32(8, true);
  const times = Array.from({ length: count }, (_, k) =>
    new DataView(packed.buffer).getFloat64(16 + 8 * k, true),
  );
  expect([times[0], times.at(-1)]).toEqual([0, 3599]);
  const gap = (from: number): number => (times[from + 1] ?? 0) - (times[from] ?? 0);
  expect(gap(count - 3)).toBeLessThan(gap(0));
  expect(track.at(1800.5, known)?.time).toBe(1800.5);
});

it("packs what it has into one block that reads back, thinned where it would be too large", () => {
  const track = new Track();
  track.add(block([0, 1, 2, 3, 4].map((time) => ({ time, x: time, force: 1 }))));
  const again = new Track();
  again.add(track.pack(Number.POSITIVE_INFINITY) ?? new Uint8Array());
  expect(again.at(2.5, state(2.5, 0))).toEqual(track.at(2.5, state(2.5, 0)));
  const few = track.pack(3 * (8 + 4 * 30)) ?? new Uint8Array();
  expect(new DataView(few.buffer).getUint32(8, true)).toBe(3);
  const thin = new Track();
  thin.add(few);
  expect(thin.at(4, state(4, 0))?.bodies[0]?.position[0]).toBe(4);
  expect(new Track().pack(100)).toBeUndefined();
});
