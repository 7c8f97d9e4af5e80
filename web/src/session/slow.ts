// Slow motion: a replay lingers where something is marked.

/** A moment on the time line that is marked, and why, in words. */
export interface Mark {
  time: number;
  words: string;
}

/** How much slower a replay goes near a mark. */
export const SLOWER = 0.2;
/** Near is within this part of what is replayed. */
const NEAR = 0.03;

/** The time after some seconds of a replay that has `until` seconds and goes slowly near its marks. */
export function onward(from: number, seconds: number, marks: readonly Mark[], until: number): number {
  const near = NEAR * until;
  if (marks.length === 0 || !(near > 0)) return from + seconds;
  let [time, left] = [from, seconds];
  while (left > 0 && time < until) {
    const slow = marks.some((mark) => Math.abs(mark.time - time) < near) ? SLOWER : 1;
    // No step reaches past the beginning of what is near.
    const step = Math.min(left, near / 4 / slow);
    time += step * slow;
    left -= step;
  }
  return time + Math.max(0, left);
}
