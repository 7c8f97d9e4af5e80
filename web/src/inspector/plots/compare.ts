// Two runs laid over each other: the earlier one, or a table from a file, is read at the times of the present one.

export interface Columns {
  times: number[];
  columns: { label: string; values: number[] }[];
}

/** A table of numbers as CSV: time first; a line of names before them, if there is one; # begins a remark. */
export function columnsOf(text: string): Columns | undefined {
  let names: string[] = [];
  const rows: number[][] = [];
  for (const line of text.split(/\r?\n/)) {
    if (line.trim() === "" || line.startsWith("#")) continue;
    const cells = line.split(/[,;\t]/).map((cell) => cell.trim());
    const numbers = cells.map(Number);
    if (cells.length > 1 && cells.every((cell) => cell !== "") && numbers.every(Number.isFinite))
      rows.push(numbers);
    else if (rows.length === 0 && names.length === 0) names = cells;
  }
  const width = rows[0]?.length ?? 0;
  if (rows.length < 2 || width < 2 || rows.some((row) => row.length !== width)) return undefined;
  rows.sort((a, b) => (a[0] ?? 0) - (b[0] ?? 0));
  return {
    times: rows.map((row) => row[0] ?? 0),
    columns: Array.from({ length: width - 1 }, (_, k) => ({
      label: names[k + 1] ?? "",
      values: rows.map((row) => row[k + 1] ?? NaN),
    })),
  };
}

/** The kept values at other times: straight between two of them, none outside of the run. */
export function resample(times: number[], values: number[], at: number[]): (number | null)[] {
  let k = 0;
  return at.map((time) => {
    while (k + 1 < times.length && (times[k + 1] ?? Infinity) <= time) k += 1;
    const [t0, t1] = [times[k], times[k + 1]];
    const [v0, v1] = [values[k], values[k + 1]];
    if (t0 === undefined || v0 === undefined || time < t0) return null;
    if (time === t0) return v0;
    if (t1 === undefined || v1 === undefined) return null;
    return v0 + ((v1 - v0) * (time - t0)) / (t1 - t0);
  });
}

/** Present values less earlier ones, and the largest size among them. */
export function difference(
  now: number[],
  before: (number | null)[],
): { values: (number | null)[]; largest: number } {
  const values = now.map((value, k) => {
    const other = before[k];
    return other === null || other === undefined ? null : value - other;
  });
  return { values, largest: values.reduce<number>((most, value) => Math.max(most, Math.abs(value ?? 0)), 0) };
}
