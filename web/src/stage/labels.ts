// Where words stand beside arrows: none covers another, and none leaves the picture.
import type { Point } from "./pen";

/** Where words stand: left, top, right, bottom. */
export type Place = [number, number, number, number];

/** Where an element stands in the one that it is placed in. */
export const placeOf = (it: HTMLElement): Place => [
  it.offsetLeft,
  it.offsetTop,
  it.offsetLeft + it.offsetWidth,
  it.offsetTop + it.offsetHeight,
];

/** About the width of a letter by its height. */
const LETTER_WIDTH = 0.6;
/** Between the tip of an arrow and its words, CSS pixels. */
const GAP = 10;
/** From one line to the next, by the height of the letters. */
const LINE = 1.15;
/** Words further than this from their arrow would be read as another's, lines. */
const MOST_LINES = 5;
/** Lines below the words that are kept for the legend's bar. */
const BELOW = 2.6;

/** An arrow that is to be named. */
export interface Named {
  start: Point;
  tip: Point;
  /** What is said, the longest first; where that finds no place the next does. */
  words: readonly string[];
  size: number;
}

export interface Label {
  words: string;
  at: Point;
  anchor: "start" | "end";
  place: Place;
}

/** The nearest free place for a name; nothing where there is none. */
export function freeLabel(
  { start, tip, words, size }: Named,
  picture: { width: number; height: number },
  taken: readonly Place[],
): Label | undefined {
  const away = tip[1] > start[1] ? 1 : -1;
  const [highest, lowest] = [1.2 * size, picture.height - BELOW * size];
  const sides: Label["anchor"][] = tip[0] >= start[0] ? ["start", "end"] : ["end", "start"];
  const first = Math.min(lowest, Math.max(highest, tip[1] + (away > 0 ? size : -6)));
  for (const said of words)
    for (let line = 0; line <= MOST_LINES; line += 1)
      for (const direction of line > 0 ? [away, -away] : [away])
        for (const anchor of sides) {
          const y = first + direction * line * LINE * size;
          const label = labelAt(said, anchor, [tip[0] + (anchor === "start" ? GAP : -GAP), y], size);
          const [left, , right] = label.place;
          const inside = y >= highest && y <= lowest && left >= 0 && right <= picture.width;
          if (inside && !taken.some((other) => overlap(label.place, other))) return label;
        }
  return undefined;
}

/** Words at a place that somebody has chosen, whatever else stands there. */
export function labelAt(words: string, anchor: Label["anchor"], at: Point, size: number): Label {
  const [x, y] = at;
  const width = LETTER_WIDTH * size * words.length;
  const place: Place = anchor === "start" ? [x, y - size, x + width, y + 4] : [x - width, y - size, x, y + 4];
  return { words, at, anchor, place };
}

export const overlap = (a: Place, b: Place): boolean =>
  a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
