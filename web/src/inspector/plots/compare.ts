// Two runs laid over each other: the kept one is read at the times of the present one.

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

/** Present less kept, and the largest of it. */
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

export interface Line {
  label: string;
  unit: string;
  values: (number | null)[];
  color: string;
  dash: number[];
}

const [W, H, LEFT, RIGHT, TOP, BOTTOM] = [900, 520, 88, 24, 46, 60];

/** A plot as a file of its own, readable in print and on a slide. */
export function plotSvg(
  title: string,
  times: number[],
  lines: Line[],
  colors: { ink: string; line: string; paper: string },
): string {
  const numbers = lines.flatMap((line) =>
    line.values.filter((value): value is number => value !== null && Number.isFinite(value)),
  );
  const [x0, x1] = [times[0] ?? 0, times.at(-1) ?? 1];
  let [y0, y1] = [Math.min(...numbers, Infinity), Math.max(...numbers, -Infinity)];
  if (!(y1 > y0)) [y0, y1] = [(Number.isFinite(y0) ? y0 : 0) - 1, (Number.isFinite(y0) ? y0 : 0) + 1];
  const x = (t: number): number => LEFT + ((t - x0) / (x1 - x0 || 1)) * (W - LEFT - RIGHT);
  const y = (v: number): number => H - BOTTOM - ((v - y0) / (y1 - y0)) * (H - TOP - BOTTOM);
  const text = (at: string, body: string): string =>
    `<text ${at} fill="${colors.ink}">${escapeXml(body)}</text>`;
  const grid = [
    ...ticks(x0, x1).map(
      (t) =>
        `<path d="M${r(x(t))} ${TOP}V${H - BOTTOM}" stroke="${colors.line}"/>${text(`x="${r(x(t))}" y="${H - BOTTOM + 22}" text-anchor="middle"`, short(t))}`,
    ),
    ...ticks(y0, y1).map(
      (v) =>
        `<path d="M${LEFT} ${r(y(v))}H${W - RIGHT}" stroke="${colors.line}"/>${text(`x="${LEFT - 10}" y="${r(y(v) + 5)}" text-anchor="end"`, short(v))}`,
    ),
  ];
  const curves = lines.map((line) => {
    let pen = "M";
    const d = line.values
      .map((value, k) => {
        if (value === null || !Number.isFinite(value)) {
          pen = "M";
          return "";
        }
        const point = `${pen}${r(x(times[k] ?? 0))} ${r(y(value))}`;
        pen = "L";
        return point;
      })
      .join("");
    return `<path d="${d}" fill="none" stroke="${line.color}" stroke-width="2.5"${line.dash.length > 0 ? ` stroke-dasharray="${line.dash.join(" ")}"` : ""}/>`;
  });
  const names = lines.map(
    (line, k) =>
      `<path d="M${LEFT + k * 190} 30h28" stroke="${line.color}" stroke-width="3"${line.dash.length > 0 ? ` stroke-dasharray="${line.dash.join(" ")}"` : ""}/>${text(`x="${LEFT + 36 + k * 190}" y="35"`, `${line.label}${line.unit ? `, ${line.unit}` : ""}`)}`,
  );
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${W} ${H}" width="${W}" height="${H}" font-family="sans-serif" font-size="16"><title>${escapeXml(title)}</title><rect width="${W}" height="${H}" fill="${colors.paper}"/>${grid.join("")}${curves.join("")}${names.join("")}${text(`x="${(LEFT + W - RIGHT) / 2}" y="${H - 14}" text-anchor="middle"`, "Time, s")}</svg>\n`;
}

/** About six round values from low to high. */
export function ticks(low: number, high: number): number[] {
  const rough = (high - low) / 6;
  if (!(rough > 0) || !Number.isFinite(rough)) return [low];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5, 10].find((lead) => lead * power >= rough) ?? 10);
  const found: number[] = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step && found.length < 20; k += 1)
    found.push(k * step);
  return found;
}

const r = (value: number): string => value.toFixed(1);
const short = (value: number): string => String(Number(value.toPrecision(6))).replace("-", "−");
const escapeXml = (text: string): string => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
