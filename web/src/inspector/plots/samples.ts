// What a plot is drawn from: every frame that the track holds of a quantity, or the states that arrived, and where these lie far
// apart.

import type { SessionState } from "../../api/types";
import type { Track } from "../../session/track";
import { type Chart, type Curve, errorOf, quantities } from "./charts";
import { resample } from "./compare";

/** What is known of a run. */
export interface Known {
  past: { readonly all: readonly SessionState[] };
  track: Track;
}

/** The quantities of one plot at the times at which they are known. */
export interface Samples {
  times: number[];
  /** The values of a curve at these times. */
  of(curve: Curve): number[];
  /** Its estimated errors, where it has some. */
  errors(curve: Curve): (number | null)[];
  /** Whether sample k and the next are so far apart that a line between them only joins them. */
  apart: boolean[];
}

/** More frames than these are not drawn: a screen has fewer columns. */
const MOST_FRAMES = 3000;
/** Samples are far apart where more frames than this would fit between them, … */
const FRAMES_APART = 3;
/** … and where that is more than this part of the plot: about 5 pixels. */
const SEEN_APART = 1 / 150;
/** A frame nearer to a state than this part of the time between frames gives way to it: a state has more digits. */
const BESIDE = 0.1;

interface Sample {
  time: number;
  value(curve: Curve): number;
}

/** The samples of a plot's quantities. */
export function samplesOf(chart: Chart, { past, track }: Known): Samples {
  const states = past.all;
  const last = states.at(-1);
  const framed = last !== undefined && quantities(chart).every((curve) => curve.inFrame);
  const frames = framed ? track.framesLike(last, MOST_FRAMES) : [];
  const found = merged(
    states.map((state) => ({ time: state.time, value: (curve) => curve.of(state) })),
    frames.map((frame) => ({ time: frame.time, value: (curve) => curve.inFrame?.(frame) ?? NaN })),
  );
  const times = found.map(({ time }) => time);
  return {
    times,
    of: (curve) => found.map((sample) => sample.value(curve)),
    errors: (curve) =>
      curve.error === undefined
        ? []
        : resample(
            states.map(({ time }) => time),
            states.map((state) => errorOf(curve, state) ?? NaN),
            times,
          ).map((error) => (Number.isFinite(error) ? error : null)),
    apart: apart(times, track.every),
  };
}

/** Both in the order of time; frames after the newest state may be those of a run that begins anew. */
function merged(states: Sample[], frames: Sample[]): Sample[] {
  const end = states.at(-1)?.time ?? -1;
  const within = frames.filter(({ time }) => time <= end);
  const length = (within.at(-1)?.time ?? 0) - (within[0]?.time ?? 0);
  const beside = (BESIDE * length) / Math.max(1, within.length - 1);
  let k = 0;
  const others = within.filter(({ time }) => {
    while ((states[k]?.time ?? Infinity) < time - beside) k += 1;
    return (states[k]?.time ?? Infinity) > time + beside;
  });
  return [...states, ...others].sort((a, b) => a.time - b.time);
}

/** Between which samples a line says nothing of the curve, where frames are `every` seconds apart. */
export function apart(times: readonly number[], every: number): boolean[] {
  const seen = SEEN_APART * ((times.at(-1) ?? 0) - (times[0] ?? 0));
  const least = Math.max(FRAMES_APART * every, seen) * (1 + 1e-6);
  return times.slice(1).map((time, k) => time - (times[k] ?? time) > least);
}

/** The samples beside which a line only joins: each of them is marked. */
export const lonely = (gaps: readonly boolean[]): number[] =>
  [...gaps, false].flatMap((gap, k) => (gap || gaps[k - 1] ? [k] : []));
