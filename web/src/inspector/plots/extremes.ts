// Where a curve is largest and smallest, and where it turns.

export interface Extreme {
  time: number;
  value: number;
  kind: "largest" | "smallest" | "maximum" | "minimum";
  /** False where the samples are too far apart to know it to `DIGITS`: time and value are those of a sample then. */
  sure: boolean;
}

/** Digits to which a value is told, and decimals of its time in s. */
export const DIGITS = 4;
export const DECIMALS = 2;
/** Turns that rise or fall by less than this part of the curve's range are noise. */
const NOISE = 0.02;
/** Extremes of a curve at most: the largest, the smallest, and the turns that stand out most. */
const MOST = 6;

/** The extremes of a curve, in the order of their times; values that are not finite count as gaps. */
export function extremes(times: readonly number[], values: readonly number[]): Extreme[] {
  const known = values.map((value, k) => (Number.isFinite(value) ? k : -1)).filter((k) => k >= 0);
  const at = (k: number): number => values[known[k] ?? -1] ?? NaN;
  const [low, high] = [
    Math.min(...known.map((k) => values[k] ?? 0)),
    Math.max(...known.map((k) => values[k] ?? 0)),
  ];
  const range = high - low;
  if (known.length < 3 || !(range > 1e-12 * Math.max(Math.abs(low), Math.abs(high)))) return [];
  const turns: (Extreme & { stands: number })[] = [];
  // The curve turns where it has come back by more than noise from the highest or lowest point since the last turn.
  let [way, best] = [0, 0];
  for (let k = 1; k < known.length; k += 1) {
    if (way === 0) way = Math.sign(at(k) - at(best));
    if ((at(k) - at(best)) * way >= 0) best = k;
    else if (Math.abs(at(k) - at(best)) > NOISE * range) {
      if (best > 0)
        turns.push({ ...peak(times, values, known, best), kind: way > 0 ? "maximum" : "minimum", stands: 0 });
      [way, best] = [-way, k];
    }
  }
  for (const [k, turn] of turns.entries()) {
    const beside = [turns[k - 1]?.value ?? at(0), turns[k + 1]?.value ?? at(known.length - 1)];
    turn.stands = Math.min(...beside.map((value) => Math.abs(value - turn.value)));
  }
  const ends = (["largest", "smallest"] as const).map((kind): Extreme => {
    const k = known.find((one) => values[one] === (kind === "largest" ? high : low)) ?? 0;
    const place = known.indexOf(k);
    return {
      ...(place > 0 && place < known.length - 1
        ? peak(times, values, known, place)
        : { time: times[k] ?? 0, value: values[k] ?? 0, sure: true }),
      kind,
    };
  });
  const others = turns
    .filter((turn) => !ends.some((end) => end.time === turn.time))
    .sort((a, b) => b.stands - a.stands)
    .slice(0, MOST - ends.length)
    .map(({ time, value, kind, sure }) => ({ time, value, kind, sure }));
  return [...ends, ...others].sort((a, b) => a.time - b.time);
}

/**
 * The top of the parabola through a highest or lowest value and its neighbours. The samples beyond them say how far the curve is
 * from a parabola: where that could be seen in the digits that are told, the sample itself is told, as one that is about there.
 */
function peak(
  times: readonly number[],
  values: readonly number[],
  known: number[],
  place: number,
): Omit<Extreme, "kind"> {
  const point = (at: number): [number, number] | undefined => {
    const k = known[at];
    return k === undefined ? undefined : [times[k] ?? 0, values[k] ?? 0];
  };
  const [a, b, c] = [point(place - 1), point(place), point(place + 1)];
  if (!a || !b || !c) return { time: b?.[0] ?? 0, value: b?.[1] ?? 0, sure: true };
  const [[t0, y0], [t1, y1], [t2, y2]] = [a, b, c];
  const [up, down] = [(y1 - y0) / (t1 - t0), (y2 - y1) / (t2 - t1)];
  const curved = (down - up) / (t2 - t0);
  const time = (t0 + t1) / 2 - up / (2 * curved);
  const value = y0 + up * (time - t0) + curved * (time - t0) * (time - t1);
  // Newton's next coefficient, with the sample before and with the one after.
  const bends = [point(place - 2), point(place + 2)].flatMap((beyond) => {
    if (!beyond) return [];
    const [t3, y3] = beyond;
    const curvedThere = ((y3 - y2) / (t3 - t2) - down) / (t3 - t1);
    return [Math.abs((curvedThere - curved) / (t3 - t0))];
  });
  const bend = bends.length > 0 ? Math.max(...bends) : Infinity;
  const span = Math.max(t1 - t0, t2 - t1);
  const off = bend * Math.abs((time - t0) * (time - t1) * (time - t2));
  const late = (bend * span * span) / Math.abs(curved);
  const told = 0.5 * 10 ** (Math.floor(Math.log10(Math.abs(value))) + 1 - DIGITS);
  const sure = time > t0 && time < t2 && off < told && late < 0.5 * 10 ** -DECIMALS;
  return sure ? { time, value, sure } : { time: t1, value: y1, sure: false };
}
