// Arrows of forces and circles of moments in the drawing, with their names and values and the scale that they share.

import type { SessionState } from "../api/types";
import { num } from "../core/format";
import { type Arrow, arrows, roundDown } from "../mechanics/forces";
import { add, cross, norm, scale, unit } from "../mechanics/vec";
import type { Watched } from "../session/watched";
import type { Eye } from "./eye";
import { freeLabel, labelAt, type Place } from "./labels";
import { letters, type Palette } from "./palette";
import type { Pen, Point } from "./pen";

/** Width of an arrow by the height of the picture: it is seen from the last row. */
const WIDTH_PART = 0.011;
/** Thinnest arrow, CSS pixels. */
const THIN = 3.5;
/** Length of an arrow's head and half its width, in widths of the arrow. */
const HEAD = 3.4;
const HALF_HEAD = 1.7;
/** A short arrow has a head of this part of its length. */
const HEAD_PART = 0.6;
/** Shorter arrows are not drawn, CSS pixels. */
const SHORTEST = 3;
/** Smallest circle of a moment, CSS pixels: of a smaller one the direction could not be seen. */
const SMALLEST_CIRCLE = 18;
/** A moment turns through this angle on the drawing, rad. */
const TURN = 1.5 * Math.PI;
/** Straight pieces of a moment's circle. */
const CIRCLE_PIECES = 28;
/** Of the double circle of a moment that would be larger than it is drawn: the inner radius by the outer one. */
const INNER_CIRCLE = 0.8;
/** More arrows than these are drawn without labels, except that of the selected joint. */
const MOST_LABELS = 6;
/** Where the name of the chosen joint stands if there is no room beside its arrow, CSS pixels from the left. */
const GAP = 10;
/** About the length of the legend's bar, CSS pixels. */
const BAR = 110;
/** A force whose arrow would be shorter than this is rounding and is called zero, CSS pixels. */
const NOTHING = 1e-6;

interface Drawn {
  arrow: Arrow;
  tip: Point;
}

/** Lengths in CSS pixels: of a newton's arrow, of the radius of a newton metre's circle, of the longest arrow. */
interface Sizes {
  force: number;
  moment: number;
  longest: number;
  width: number;
}

export function drawForces(
  pen: Pen,
  session: Watched,
  state: SessionState,
  eye: Eye,
  colours: Palette,
  /** Where no words may stand. */
  covered: readonly Place[] = [],
): void {
  // Forces belong to the run, not to what an analysis shows in its place.
  const list = session.pose ? [] : arrows(state, session.drawn, session.joint, session.convention);
  if (list.length === 0) return;
  // The scale is that of the newest state at all times: one for the whole run.
  const drawing = session.latest?.drawing ?? state.drawing;
  const sizes: Sizes = {
    force: drawing.force_scale * eye.perMetre,
    moment: drawing.moment_scale * eye.perMetre,
    longest: drawing.longest * eye.perMetre,
    width: Math.max(THIN, WIDTH_PART * eye.height),
  };
  const drawn: Drawn[] = list.map((arrow) => {
    const tip = drawArrow(pen, arrow, eye, sizes, colours);
    if (arrow.moment) drawMoment(pen, arrow, eye, sizes, colours);
    return { arrow, tip };
  });
  // Words come last, over all arrows; the joint that is looked at chooses its place first.
  const taken: Place[] = [...covered];
  const marked = ({ arrow }: Drawn): boolean => arrow.label === session.joint;
  for (const one of [...drawn.filter(marked), ...drawn.filter((other) => !marked(other))])
    if (list.length <= MOST_LABELS || marked(one))
      drawLabel(pen, one, eye, sizes, colours, marked(one), taken);
  drawScale(pen, eye, sizes, colours);
}

/** The arrow of a force, as it points in space; nothing where it is too short to be seen. Returns its tip. */
function drawArrow(pen: Pen, arrow: Arrow, eye: Eye, sizes: Sizes, colours: Palette): Point {
  const start = eye.project(arrow.at);
  const wanted = norm(arrow.force) * sizes.force;
  const cut = wanted > sizes.longest;
  if (!(wanted > SHORTEST)) return start;
  const length = cut ? sizes.longest : wanted;
  const tip = eye.project(add(arrow.at, scale(unit(arrow.force), length / eye.perMetre)));
  const [dx, dy] = [tip[0] - start[0], tip[1] - start[1]];
  const seen = Math.hypot(dx, dy);
  if (seen <= SHORTEST) return start;
  const [ux, uy] = [dx / seen, dy / seen];
  const stroke = colours.force[arrow.kind];
  const head = Math.min(HEAD * sizes.width, HEAD_PART * seen);
  const half = (head * HALF_HEAD) / HEAD;
  const neck: Point = [tip[0] - ux * head, tip[1] - uy * head];
  pen.path([start, neck], { stroke: colours.paper, width: sizes.width + 2, butt: true });
  pen.path([start, neck], { stroke, width: sizes.width, butt: true });
  const corners: Point[] = [
    tip,
    [neck[0] - uy * half, neck[1] + ux * half],
    [neck[0] + uy * half, neck[1] - ux * half],
  ];
  pen.path(corners, { fill: stroke }, true);
  // Two strokes across: this arrow would be longer than it is drawn. Just past the middle, away from the head.
  if (cut)
    for (const along of [0.52, 0.6]) {
      const [x, y] = [start[0] + dx * along, start[1] + dy * along];
      const w = 1.6 * sizes.width;
      pen.path(
        [
          [x - uy * w - ux * 3, y + ux * w - uy * 3],
          [x + uy * w + ux * 3, y - ux * w + uy * 3],
        ],
        { stroke, width: 0.7 * sizes.width },
      );
    }
  return tip;
}

/** Three quarters of a circle about the moment's axis, in its sense; two of them where it would be too large. */
function drawMoment(pen: Pen, arrow: Arrow, eye: Eye, sizes: Sizes, colours: Palette): void {
  const axis = unit(arrow.moment ?? [0, 0, 1]);
  const a = unit(cross(axis, Math.abs(axis[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
  const b = cross(axis, a);
  const wanted = norm(arrow.moment ?? [0, 0, 0]) * sizes.moment;
  const largest = sizes.longest / 2;
  const radius = Math.max(SMALLEST_CIRCLE, Math.min(largest, wanted)) / eye.perMetre;
  const on = (angle: number, r: number): Point =>
    eye.project(add(arrow.at, add(scale(a, r * Math.cos(angle)), scale(b, r * Math.sin(angle)))));
  const stroke = colours.force.reaction;
  for (const r of wanted > largest ? [radius, INNER_CIRCLE * radius] : [radius]) {
    const around = Array.from({ length: CIRCLE_PIECES + 1 }, (_, k) => on((k / CIRCLE_PIECES) * TURN, r));
    pen.path(around, { stroke: colours.paper, width: 0.8 * sizes.width + 2 });
    pen.path(around, { stroke, width: 0.8 * sizes.width });
  }
  const [before, tip] = [on(TURN - 0.3, radius), on(TURN, radius)];
  const [dx, dy] = [tip[0] - before[0], tip[1] - before[1]];
  const seen = Math.hypot(dx, dy) || 1;
  const [ux, uy] = [(dx / seen) * sizes.width, (dy / seen) * sizes.width];
  const corners: Point[] = [
    [tip[0] + 2.2 * ux, tip[1] + 2.2 * uy],
    [tip[0] - 1.5 * uy, tip[1] + 1.5 * ux],
    [tip[0] + 1.5 * uy, tip[1] - 1.5 * ux],
  ];
  pen.path(corners, { fill: stroke }, true);
}

/** What the arrow is, beside its tip, where no other words stand; without its value where there is little room. */
function drawLabel(
  pen: Pen,
  { arrow, tip }: Drawn,
  eye: Eye,
  sizes: Sizes,
  colours: Palette,
  marked: boolean,
  taken: Place[],
): void {
  const zero = norm(arrow.force) * sizes.force < NOTHING;
  const moment = arrow.moment ? `, ${num(norm(arrow.moment), 3)} N m` : "";
  const words = `${arrow.label} ${num(zero ? 0 : norm(arrow.force), 3)} N${moment}`;
  const size = letters(eye.height, colours);
  const named = { start: eye.project(arrow.at), tip, words: [words, arrow.label], size };
  const found = freeLabel(named, eye, taken);
  // The value of the joint that is looked at is seen whatever stands there.
  const label = found ?? (marked ? labelAt(words, "start", [GAP, 1.2 * size], size) : undefined);
  if (!label) return;
  taken.push(label.place);
  pen.text(label.at, label.words, {
    fill: colours.force[arrow.kind],
    size,
    anchor: label.anchor,
    halo: colours.paper,
  });
}

/** A bar as long as the arrow of the force that it names. */
function drawScale(pen: Pen, eye: Eye, sizes: Sizes, colours: Palette): void {
  const newtons = roundDown((BAR * Math.sqrt(colours.size)) / sizes.force);
  const [x, y] = [16, eye.height - 20];
  const end = x + newtons * sizes.force;
  const ink = { stroke: colours.soft, width: 2 };
  pen.path(
    [
      [x, y],
      [end, y],
    ],
    ink,
  );
  for (const tick of [x, end])
    pen.path(
      [
        [tick, y - 6],
        [tick, y + 6],
      ],
      ink,
    );
  const size = 14 * colours.size;
  pen.text([end + 10, y + 0.35 * size], `${num(newtons)} N`, {
    fill: colours.soft,
    size,
    halo: colours.paper,
    bold: false,
  });
}
