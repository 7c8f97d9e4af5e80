// Where a curve is largest and smallest, and where it turns.

export interface Extreme {
  time: number;
  value: number;
  kind: "largest" | "smallest" | "maximum" | "minimum";
}

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
        : { time: times[k] ?? 0, value: values[k] ?? 0 }),
      kind,
    };
  });
  const others = turns
    .filter((turn) => !ends.some((end) => end.time === turn.time))
    .sort((a, b) => b.stands - a.stands)
    .slice(0, MOST - ends.length)
    .map(({ time, value, kind }) => ({ time, value, kind }));
  return [...ends, ...others].sort((a, b) => a.time - b.time);
}

/** The top of the parabola through a highest or lowest value and its neighbours. */
function peak(
  times: readonly number[],
  values: readonly number[],
  known: number[],
  place: number,
): { time: number; value: number } {
  const [i, j, k] = [known[place - 1], known[place], known[place + 1]].map(
    (one) => one ?? known[place] ?? 0,
  ) as [number, number, number];
  const [t0, t1, t2] = [i, j, k].map((one) => times[one] ?? 0) as [number, number, number];
  const [y0, y1, y2] = [i, j, k].map((one) => values[one] ?? 0) as [number, number, number];
  const [up, down] = [(y1 - y0) / (t1 - t0), (y2 - y1) / (t2 - t1)];
  const curved = (down - up) / (t2 - t0);
  const time = (t0 + t1) / 2 - up / (2 * curved);
  if (!(time > t0 && time < t2)) return { time: t1, value: y1 };
  return { time, value: y0 + up * (time - t0) + curved * (time - t0) * (time - t1) };
}
