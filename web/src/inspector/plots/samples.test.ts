import { describe, expect, it } from "vitest";
import { Track } from "../../session/track";
import { block } from "../../testing/block";
import { state } from "../../testing/state";
import { charts } from "./charts";
import { marksOf } from "./marks";
import { apart, lonely, samplesOf } from "./samples";
import { plotSvg } from "./svg-file";

const joint = { joint: "pin", on: "bob", by: "ground", at: [0, 0, 0], force: [0, 0, 0], moment: [0, 0, 0] };
const known = (time: number, x: number): ReturnType<typeof state> => ({
  ...state(time, x),
  forces: [joint as never],
});
/** A body that swings along x, as frames have it a hundred times a second for 3 s. */
const swing = (time: number): number => Math.cos(3 * time);
const track = new Track();
track.add(
  block(Array.from({ length: 301 }, (_, k) => ({ time: k / 100, x: swing(k / 100), force: swing(k / 100) }))),
);
/** The states that arrived: few, and the last of them before the last frame. */
const states = [0, 0.31, 0.82, 0.984, 1.7, 2.3].map((time) => known(time, swing(time)));
const offered = charts(known(0, 1));
const chart = (label: string): (typeof offered)[number] => {
  const found = offered.find((one) => one.label === label);
  if (!found) throw new Error(`no plot ${label}`);
  return found;
};

describe("the samples of a plot", () => {
  it("are every frame of what the track holds, with the states between, as far as the run is told", () => {
    for (const label of [
      "Position of bob",
      "Path of bob",
      "Velocity of bob",
      "Acceleration of bob",
      "Force in pin on bob",
    ]) {
      const { times, apart: gaps } = samplesOf(chart(label), { past: { all: states }, track });
      // 231 frames until 2.3 s, of which the states replace five, and one state between two frames.
      expect(times).toHaveLength(232);
      expect(times).toContain(0.984);
      expect(times.at(-1)).toBe(2.3);
      expect(gaps).not.toContain(true);
      expect([...times].sort((a, b) => a - b)).toEqual(times);
    }
    const position = chart("Position of bob");
    const samples = samplesOf(position, { past: { all: states }, track });
    const [x] = position.curves;
    const values = x ? samples.of(x) : [];
    for (const [k, time] of samples.times.entries()) expect(values[k]).toBeCloseTo(swing(time), 6);
    // A state has all its digits.
    expect(values[samples.times.indexOf(0.31)]).toBe(swing(0.31));
    // Frames of this track have twice the place as velocity, thrice as angular velocity, four times as acceleration.
    for (const [label, times, axis] of [
      ["Velocity of bob", 2, 0],
      ["Angular velocity of bob", 3, 2],
      ["Acceleration of bob", 4, 0],
    ] as const) {
      const curve = chart(label).curves[axis];
      const moving = samplesOf(chart(label), { past: { all: states }, track });
      const at = moving.times.indexOf(0.5);
      expect(curve && moving.of(curve)[at]).toBeCloseTo(times * swing(0.5), 5);
    }
    const words = marksOf(position, samples).map((mark) => mark.words);
    expect(words).toContain("x smallest −1 m at 1.05 s");
  });

  it("are the states for all else, which lie far apart, and their extremes are told roughly", () => {
    const energy = chart("Energy drift");
    const samples = samplesOf(energy, { past: { all: states }, track });
    expect(samples.times).toEqual(states.map(({ time }) => time));
    expect(samples.apart).toEqual([true, true, true, true, true]);
    const moving = states.map((one) => ({
      ...one,
      energy_drift: -3 * Math.sin(3 * one.time),
    }));
    const words = marksOf(energy, samplesOf(energy, { past: { all: moving }, track })).map(
      (mark) => mark.words,
    );
    expect(words).toContain("ΔE smallest about −2.4 J near 0.3 s");
  });
});

describe("the samples of a plot where little is known", () => {
  it("have no extremes told of a curve that is zero but for rounding", () => {
    const position = chart("Position of bob");
    const wavering = states.map((one) => ({
      ...one,
      bodies: one.bodies.map((body) => ({
        ...body,
        position: [body.position[0], 1e-9 * Math.sin(9 * one.time), 0.01 * Math.sin(9 * one.time)] as never,
      })),
    }));
    const run = { past: { all: wavering }, track: new Track() };
    const words = marksOf(position, samplesOf(position, run)).map((mark) => mark.words);
    expect(words.some((said) => said.startsWith("y "))).toBe(false);
    expect(words.some((said) => said.startsWith("z "))).toBe(true);
  });

  it("are the states where there is no track, or one of another mechanism", () => {
    const position = chart("Position of bob");
    expect(samplesOf(position, { past: { all: states }, track: new Track() }).times).toHaveLength(6);
    const others = states.map((one) => ({ ...one, bodies: [...one.bodies, ...one.bodies] }));
    expect(samplesOf(position, { past: { all: others }, track }).times).toHaveLength(6);
    expect(samplesOf(position, { past: { all: [] }, track }).times).toEqual([]);
  });
});

it("samples are far apart where more than three frames are missing and that can be seen", () => {
  expect(apart([0, 0.03, 0.06, 0.1, 0.13], 0.01)).toEqual([false, false, true, false]);
  expect(apart([0, 0.1, 0.2, 100], 0.01)).toEqual([false, false, true]);
  expect(lonely([false, false, true, false])).toEqual([2, 3]);
  expect(lonely([true])).toEqual([0, 1]);
});

it("a file joins what lies far apart by thin lines between marks", () => {
  const line = { label: "x", unit: "m", values: [0, 1, 2, 3], color: "red", dash: [] };
  const colors = { ink: "#000", line: "#ccc", paper: "#fff" };
  const text = plotSvg("x", [0, 1, 2, 3], [line], colors, [false, true, false]);
  expect(text.match(/<circle/g)).toHaveLength(2);
  const drawn = [...text.matchAll(/<path d="([^"]*)" fill="none"/g)].map((found) =>
    found[1]?.replace(/[^ML]/g, ""),
  );
  expect(drawn).toEqual(["ML", "MLML"]);
  expect(plotSvg("x", [0, 1, 2, 3], [line], colors)).not.toContain("<circle");
});
