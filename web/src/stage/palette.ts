// The colours of the drawing: those of the page's theme, and one for each body.

/** Apart for all eyes, after Okabe and Ito; the 3-D recording has the same. */
const BODIES = ["#56b4e9", "#e69f00", "#009e73", "#f0e442", "#0072b2", "#cc79a7"];
/** How much of the paper is mixed into the colour of a body, and of the ink into its edge. */
const PALE = 0.22;
const DARK = 0.45;
/** Height of the letters of a name, CSS pixels; on a projector twice that. */
const LETTERS = 17;
/** On a stage lower than this letters are smaller, but not smaller than these, CSS pixels. */
const SMALL_STAGE = 330;
const LEAST_LETTERS = 13;

export interface Palette {
  paper: string;
  grid: string;
  ink: string;
  soft: string;
  edge: string;
  accent: string;
  force: Record<"reaction" | "weight" | "load", string>;
  /** Of the axes u, v, w, and of x, y, z. */
  axes: [string, string, string];
  /** Times this are letters and lines larger, for the back of a room. */
  size: number;
}

/** What the style sheet says at present. */
export function palette(): Palette {
  const style = getComputedStyle(document.documentElement);
  const of = (name: string): string => style.getPropertyValue(`--${name}`).trim();
  return {
    paper: of("paper"),
    grid: of("paper-grid"),
    ink: of("ink"),
    soft: of("ink-2"),
    edge: of("rod-edge"),
    accent: of("accent"),
    force: { reaction: of("force"), weight: of("weight"), load: of("load") },
    axes: [of("curve-2"), of("curve-1"), of("curve-3")],
    size: document.documentElement.hasAttribute("data-projector") ? 1.9 : 1,
  };
}

/** Height of the letters of names in a picture so high, CSS pixels: of arrows, markers and axes alike, as they are read from one distance. */
export const letters = (height: number, { size }: Palette): number =>
  LETTERS * size * Math.max(LEAST_LETTERS / LETTERS, Math.min(1, height / SMALL_STAGE));

export interface Paint {
  fill: string;
  edge: string;
  light: string;
}

/** The colours of a body. */
export function paint(body: number, colours: Palette): Paint {
  const own = BODIES[body % BODIES.length] ?? colours.edge;
  return {
    fill: mix(own, colours.paper, PALE),
    edge: mix(own, colours.ink, DARK),
    light: mix(own, "#ffffff", 0.62),
  };
}

/** A colour between two, `part` of the way to the second. */
export function mix(a: string, b: string, part: number): string {
  const [x, y] = [numbers(a), numbers(b)];
  const between = x.map((value, k) => Math.round(value + part * ((y[k] ?? value) - value)));
  return `#${between.map((value) => value.toString(16).padStart(2, "0")).join("")}`;
}

const numbers = (hex: string): number[] => [1, 3, 5].map((at) => Number.parseInt(hex.slice(at, at + 2), 16));
