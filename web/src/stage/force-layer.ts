// Arrows of forces and circles of moments over the sketch, with the scale that they share.
import { svg } from "../core/dom";
import { num } from "../core/format";
import { type Arrow, arrows, roundDown } from "../mechanics/forces";
import { add, cross, norm, scale, unit } from "../mechanics/vec";
import type { Session } from "../session/session";
import { HEIGHT, type Layer, type Project, WIDTH } from "./viewport";

/** Longest head of a force's arrow, in units of the drawing. */
const HEAD = 11;
/** A short arrow has a head of this part of its length. */
const HEAD_PART = 0.6;
/** Shorter arrows are not drawn, in units of the drawing. */
const MIN_LENGTH = 2;
/** Arrows that the view shortens to less than this are not drawn, in units of the drawing. */
const MIN_SEEN = 3;
/** Circles of moments are not drawn smaller, in units of the drawing: their direction could not be seen. */
const MIN_CIRCLE = 18;
/** A moment turns through this angle on the drawing, rad. */
const TURN = 1.5 * Math.PI;
/** Straight pieces of a moment's circle. */
const CIRCLE_PIECES = 24;
/** Of the double circle of a moment that would be larger than it is drawn: the inner radius by the outer one. */
const INNER_CIRCLE = 0.8;
/** More arrows than these are drawn without labels, except that of the selected joint. */
const MAX_LABELS = 6;
/** About the length of the legend's bar, in units of the drawing. */
const BAR = 120;
/** A force whose arrow would be shorter than this is rounding and is called zero, in units of the drawing. */
const NOTHING = 1e-6;
/** About the width of a letter of a label, in units of the drawing. */
const LETTER_WIDTH = 11;
/** Labels keep away from the left and right edges of the drawing by this much, in units of the drawing. */
const SIDE_MARGIN = 10;
/** Highest baseline of a label, in units of the drawing. */
const FIRST_BASELINE = 24;
/** Lowest baseline of a label, in units of the drawing: the legend stands below it. */
const LAST_BASELINE = HEIGHT - 34;
/** A label stands this far beside the tip of its arrow, in units of the drawing. */
const LABEL_BESIDE = 10;
/** And this far below the tip of an arrow that points down. */
const LABEL_BELOW = 20;
/** And this far above the tip of an arrow that points up. */
const LABEL_ABOVE = 6;
/** Left end of the legend's bar, in units of the drawing. */
const LEGEND = { x: 18, y: HEIGHT - 24 };

type Point = [number, number];

/** Lengths in units of the drawing: of a newton's arrow, of the radius of a newton metre's circle, of the longest arrow. */
interface Sizes {
  force: number;
  moment: number;
  longest: number;
}

export function forceLayer(session: Session): Layer {
  const root = svg("g", { class: "force-layer" });
  const update: Layer["update"] = (state, project, perMetre) => {
    // Forces belong to the run, not to what an analysis shows in its place.
    const list = session.pose ? [] : arrows(state, session.drawn, session.joint, session.convention);
    // The scale is that of the newest state at all times: one for the whole scene.
    const drawing = session.latest?.drawing ?? state.drawing;
    const sizes: Sizes = {
      force: drawing.force_scale * perMetre,
      moment: drawing.moment_scale * perMetre,
      longest: drawing.longest * perMetre,
    };
    if (list.length === 0) {
      root.replaceChildren();
      return;
    }
    // A drawing of a drawing: the arrow points where the force points in space, foreshortened like everything else.
    const parts = list.flatMap((arrow) =>
      draw(arrow, project, sizes, perMetre, list.length <= MAX_LABELS || arrow.label === session.joint),
    );
    root.replaceChildren(...parts, ...legend(sizes.force));
  };
  return { root, update };
}

function draw(arrow: Arrow, project: Project, sizes: Sizes, perMetre: number, labels: boolean): SVGElement[] {
  const { parts, tip } = forceArrow(arrow, project, sizes, perMetre);
  if (arrow.moment) parts.push(...momentArrow(arrow, project, sizes, perMetre));
  if (labels) parts.push(label(arrow, project(arrow.at), tip, norm(arrow.force) * sizes.force < NOTHING));
  return parts;
}

/** The arrow of a force, nothing where it is too short to be seen, and its tip. */
function forceArrow(
  arrow: Arrow,
  project: Project,
  sizes: Sizes,
  perMetre: number,
): { parts: SVGElement[]; tip: Point } {
  const start = project(arrow.at);
  const wanted = norm(arrow.force) * sizes.force;
  const capped = wanted > sizes.longest;
  const length = capped ? sizes.longest : wanted;
  if (wanted <= MIN_LENGTH) return { parts: [], tip: start };
  const tip = project(add(arrow.at, scale(unit(arrow.force), length / perMetre)));
  const [x, y] = start;
  const [dx, dy] = [tip[0] - x, tip[1] - y];
  const seen = Math.hypot(dx, dy);
  if (seen <= MIN_SEEN) return { parts: [], tip: start };
  const [ux, uy] = [dx / seen, dy / seen];
  const head = Math.min(HEAD, HEAD_PART * seen);
  const neck: Point = [tip[0] - ux * head, tip[1] - uy * head];
  const left: Point = [neck[0] - uy * head * 0.5, neck[1] + ux * head * 0.5];
  const right: Point = [neck[0] + uy * head * 0.5, neck[1] - ux * head * 0.5];
  const parts: SVGElement[] = [
    svg("path", { class: `force is-${arrow.kind}`, d: `M${at(start)}L${at(neck)}` }),
    svg("path", { class: `force-head is-${arrow.kind}`, d: `M${at(tip)}L${at(left)}L${at(right)}Z` }),
  ];
  // Just past the middle, so that the strokes keep away from the head.
  if (capped) parts.push(cut(x + dx * 0.55, y + dy * 0.55, ux, uy, arrow.kind));
  return { parts, tip };
}

/** What the arrow is, beside its tip, on the side where the words fit. */
function label(arrow: Arrow, start: Point, tip: Point, zero: boolean): SVGElement {
  const moment = arrow.moment ? `, ${num(norm(arrow.moment), 3)} N m` : "";
  const words = `${arrow.label} ${num(zero ? 0 : norm(arrow.force), 3)} N${moment}`;
  const width = LETTER_WIDTH * words.length;
  const right = tip[0] >= start[0] ? tip[0] + width < WIDTH - SIDE_MARGIN : tip[0] - width < SIDE_MARGIN;
  const baseline = tip[1] + (tip[1] > start[1] ? LABEL_BELOW : -LABEL_ABOVE);
  const text = svg("text", {
    class: `force-label is-${arrow.kind}`,
    x: p(tip[0] + (right ? LABEL_BESIDE : -LABEL_BESIDE)),
    y: p(Math.min(LAST_BASELINE, Math.max(FIRST_BASELINE, baseline))),
    "text-anchor": right ? "start" : "end",
  });
  text.textContent = words;
  return text;
}

/** Two strokes across: this arrow would be longer than it is drawn. */
function cut(x: number, y: number, ux: number, uy: number, kind: string): SVGElement {
  const stroke = (along: number): string => {
    const from: Point = [x + ux * (along - 3) - uy * 8, y + uy * along + ux * 8 - uy * 3];
    const to: Point = [x + ux * (along + 3) + uy * 8, y + uy * along - ux * 8 + uy * 3];
    return `M${at(from)}L${at(to)}`;
  };
  return svg("path", { class: `force-cut is-${kind}`, d: `${stroke(-3)}${stroke(4)}` });
}

/** Three quarters of a circle about the moment's axis, in its sense; two of them where it would be too large. */
function momentArrow(arrow: Arrow, project: Project, sizes: Sizes, perMetre: number): SVGElement[] {
  const axis = unit(arrow.moment ?? [0, 0, 1]);
  const a = unit(cross(axis, Math.abs(axis[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
  const b = cross(axis, a);
  const wanted = norm(arrow.moment ?? [0, 0, 0]) * sizes.moment;
  const largest = sizes.longest / 2;
  const radius = Math.max(MIN_CIRCLE, Math.min(largest, wanted)) / perMetre;
  const on = (angle: number, r = radius): Point =>
    project(add(arrow.at, add(scale(a, r * Math.cos(angle)), scale(b, r * Math.sin(angle)))));
  const around = (r: number): string =>
    Array.from({ length: CIRCLE_PIECES + 1 }, (_, k) => on((k / CIRCLE_PIECES) * TURN, r))
      .map((point, k) => `${k === 0 ? "M" : "L"}${at(point)}`)
      .join("");
  const path = wanted > largest ? around(radius) + around(INNER_CIRCLE * radius) : around(radius);
  return [
    svg("path", { class: "moment", d: path }),
    svg("path", { class: "moment-head", d: momentHead(on(TURN - 0.3), on(TURN)) }),
  ];
}

/** The head of a moment's circle that ends at `end`, 7 long and 10 wide in units of the drawing. */
function momentHead(before: Point, end: Point): string {
  const [tx, ty] = end;
  const [dx, dy] = [tx - before[0], ty - before[1]];
  const seen = Math.hypot(dx, dy) || 1;
  const [ux, uy] = [dx / seen, dy / seen];
  const corners: Point[] = [
    [tx + ux * 7, ty + uy * 7],
    [tx - uy * 5, ty + ux * 5],
    [tx + uy * 5, ty - ux * 5],
  ];
  return `M${corners.map(at).join("L")}Z`;
}

function legend(perNewton: number): SVGElement[] {
  const newtons = roundDown(BAR / perNewton);
  const length = newtons * perNewton;
  const { x, y } = LEGEND;
  const text = svg("text", { class: "force-legend", x: p(x + length + 10), y: p(y + 6) });
  text.textContent = `${num(newtons)} N`;
  return [
    svg("path", {
      class: "force-bar",
      d: `M${x} ${y - 6}V${y + 6}M${x} ${y}H${p(x + length)}M${p(x + length)} ${y - 6}V${y + 6}`,
    }),
    text,
  ];
}

const p = (value: number): string => value.toFixed(1);
const at = ([x, y]: Point): string => `${p(x)} ${p(y)}`;
