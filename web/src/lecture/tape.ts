// A lecture as a recording: what was shown when, with the motion of each run. It has no sound: long pauses are shortened.

import type { Camera, LectureQuestion, Motion } from "../api/types";
import type { Drawn } from "../mechanics/forces";
import { fromBase64, toBase64 } from "../session/packed";
import { Track } from "../session/track";

/** What is shown beside the moment of a run. */
export interface Look {
  joint: string | null;
  drawn: Drawn;
  camera: Camera;
  blank: boolean;
  question: LectureQuestion | null;
  remark: string | null;
}

/** From when on, s since the lecture began: which run (−1 for none), its time, how fast it goes on, and which look. */
export type Moment = [at: number, part: number, time: number, rate: number, look: number];

export interface Taped {
  title: string;
  /** When it began, as a date and a time of day. */
  began: string;
  parts: Motion[];
  looks: Look[];
  moments: Moment[];
}

/** While a run goes on, a moment is written down where it is further than this from where the one before says, s. */
const OFF = 0.15;
/** More moments are not kept: every second of those that differ in nothing but time goes. */
const MOST_MOMENTS = 4000;
/** Letters of all motions together; beyond them the oldest are thinned. */
const MOST_LETTERS = 3e6;
/** Letters below which a motion is not thinned further. */
const LEAST_LETTERS = 20e3;
/** A pause longer than this is played as one of this length, s. */
const PAUSE = 3;

export class Tape {
  private readonly began: Date;
  private readonly start: number;
  private readonly parts: Motion[];
  private readonly looks: Look[];
  private moments: Moment[];
  private lastLook: string;

  /** `before` is what another page has recorded of the same lecture: it goes on from there. */
  constructor(
    readonly title: string,
    private readonly now: () => number,
    before?: Taped,
  ) {
    this.began = before ? new Date(before.began) : new Date();
    this.start = now();
    // The clock of the day may have been set back meanwhile.
    if (before)
      this.start -= Math.max(1000 * (before.moments.at(-1)?.[0] ?? 0), Date.now() - this.began.getTime());
    this.parts = [...(before?.parts ?? [])];
    this.looks = [...(before?.looks ?? [])];
    this.moments = [...(before?.moments ?? [])];
    this.lastLook = JSON.stringify(this.looks.at(-1));
  }

  /** Writes down what is shown now, if the moments so far do not say so. */
  see(time: number, rate: number, look: Look): void {
    const at = (this.now() - this.start) / 1000;
    const key = JSON.stringify(look);
    if (key !== this.lastLook) {
      this.lastLook = key;
      this.looks.push(structuredClone(look));
    }
    const [part, shown] = [this.parts.length, this.looks.length - 1];
    const last = this.moments.at(-1);
    const said = last && last[1] === part && last[3] === rate && last[4] === shown;
    if (said && Math.abs(last[2] + rate * (at - last[0]) - time) <= (rate > 0 ? OFF : 0)) return;
    const rounded = (value: number): number => Number(value.toFixed(3));
    this.moments.push([rounded(at), part, rounded(time), rate, shown]);
    if (this.moments.length > MOST_MOMENTS) this.moments = thinned(this.moments);
  }

  /** The run that was shown is over: here is its motion, if it is known. */
  cut(motion: Motion | undefined): void {
    if (!motion || this.moments.at(-1)?.[1] !== this.parts.length) return;
    this.parts.push(motion);
    let letters = this.parts.reduce((sum, part) => sum + part.track.length, 0);
    for (const [k, part] of this.parts.entries()) {
      if (letters <= MOST_LETTERS) break;
      if (part.track.length < LEAST_LETTERS) continue;
      const lighter = halved(part);
      letters += lighter.track.length - part.track.length;
      this.parts[k] = lighter;
    }
  }

  /** The recording so far; `motion` is that of the run which is shown now. */
  taped(motion: Motion | undefined): Taped {
    const { title, began, looks, moments } = this;
    const parts = motion ? [...this.parts, motion] : [...this.parts];
    // The end is a moment too: the last one lasts until now.
    const last = moments.at(-1);
    const at = Number(((this.now() - this.start) / 1000).toFixed(3));
    const end: Moment[] = last ? [[at, last[1], last[2] + last[3] * (at - last[0]), 0, last[4]]] : [];
    const known = ([from, part, ...rest]: Moment): Moment => [from, part < parts.length ? part : -1, ...rest];
    return { title, began: began.toISOString(), parts, looks, moments: [...moments, ...end].map(known) };
  }
}

function thinned(moments: Moment[]): Moment[] {
  return moments.filter((moment, k) => {
    const [before, after] = [moments[k - 1], moments[k + 1]];
    const same = (other: Moment | undefined): boolean => other?.[1] === moment[1] && other[4] === moment[4];
    return k % 2 === 0 || !same(before) || !same(after);
  });
}

function halved(motion: Motion): Motion {
  const track = new Track();
  const bytes = fromBase64(motion.track);
  track.add(bytes);
  const lighter = track.pack(bytes.length / 2);
  return lighter ? { ...motion, track: toBase64(lighter) } : motion;
}

/** A moment as it is played: where it begins, s of playing, and how long it lasts. */
export interface Shown {
  from: number;
  lasts: number;
  moment: Moment;
}

/** The moments in the time of playing: pauses are shortened, and what runs keeps its pace. */
export function playing({ moments }: Taped): Shown[] {
  const shown: Shown[] = [];
  let from = 0;
  for (const [k, moment] of moments.entries()) {
    const gap = (moments[k + 1]?.[0] ?? moment[0]) - moment[0];
    const lasts = moment[3] > 0 ? gap : Math.min(gap, PAUSE);
    shown.push({ from, lasts, moment });
    from += lasts;
  }
  return shown;
}

/** What is shown at a time of playing, and the time of the run then. */
export function at(shown: Shown[], time: number): { moment: Moment; run: number } | undefined {
  let [low, high] = [0, shown.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if ((shown[middle]?.from ?? Infinity) <= time) low = middle;
    else high = middle - 1;
  }
  const found = shown[low];
  if (!found) return undefined;
  const { moment, from, lasts } = found;
  const run = moment[2] + moment[3] * Math.max(0, Math.min(time - from, lasts));
  // Where the run had not come as far as it was said to, it waits.
  const next = shown[low + 1]?.moment;
  const bound = next && next[1] === moment[1] && next[2] >= moment[2] ? next[2] : Infinity;
  return { moment, run: Math.min(run, bound) };
}
