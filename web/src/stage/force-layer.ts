// Arrows of forces and turning arrows of moments over the sketch, with the one scale that they share.
import { svg } from "../core/dom";
import { num } from "../core/format";
import { type Arrow, arrows, roundDown } from "../mechanics/forces";
import { add, cross, norm, scale, unit } from "../mechanics/vec";
import type { Session } from "../session/session";
import { HEIGHT, type Layer, type Project, WIDTH } from "./viewport";

const HEAD = 11;
/** Circles of moments are not drawn smaller, in units of the drawing: what turns could not be seen. */
const MIN_CIRCLE = 18;
/** About the length of the legend's bar. */
const BAR = 120;
/** What would be drawn shorter than this is rounding, and is called zero. */
const NOTHING = 1e-6;
/** About the width of a letter of a label, in units of the drawing. */
const LETTER_WIDTH = 11;
/** Labels keep away from the left and right edges of the drawing by this much, in units of the drawing. */
const SIDE_MARGIN = 10;
/** Baselines of labels stay between these, in units of the drawing: the legend stands below them. */
const FIRST_BASELINE = 24;
const LAST_BASELINE = HEIGHT - 34;
/** Left end of the legend's bar, in units of the drawing. */
const LEGEND = { x: 18, y: HEIGHT - 24 };

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
      draw(arrow, project, sizes, perMetre, list.length <= 6 || arrow.label === session.joint),
    );
    root.replaceChildren(...parts, ...legend(sizes.force));
  };
  return { root, update };
}

function draw(arrow: Arrow, project: Project, sizes: Sizes, perMetre: number, labels: boolean): SVGElement[] {
  const size = norm(arrow.force);
  const [x, y] = project(arrow.at);
  const parts: SVGElement[] = [];
  const wanted = size * sizes.force;
  let end: [number, number] = [x, y];
  if (wanted > 2) {
    const capped = wanted > sizes.longest;
    const length = capped ? sizes.longest : wanted;
    const tip = project(add(arrow.at, scale(unit(arrow.force), length / perMetre)));
    const [dx, dy] = [tip[0] - x, tip[1] - y];
    const seen = Math.hypot(dx, dy);
    if (seen > 3) {
      const [ux, uy] = [dx / seen, dy / seen];
      const head = Math.min(HEAD, 0.6 * seen);
      const neck = [tip[0] - ux * head, tip[1] - uy * head] as const;
      parts.push(
        svg("path", { class: `force is-${arrow.kind}`, d: `M${p(x)} ${p(y)}L${p(neck[0])} ${p(neck[1])}` }),
        svg("path", {
          class: `force-head is-${arrow.kind}`,
          d: `M${p(tip[0])} ${p(tip[1])}L${p(neck[0] - uy * head * 0.5)} ${p(neck[1] + ux * head * 0.5)}L${p(neck[0] + uy * head * 0.5)} ${p(neck[1] - ux * head * 0.5)}Z`,
        }),
      );
      if (capped) parts.push(cut(x + dx * 0.55, y + dy * 0.55, ux, uy, arrow.kind));
      end = tip;
    }
  }
  if (arrow.moment) parts.push(...turn(arrow, project, sizes, perMetre));
  if (labels) {
    const words = `${arrow.label} ${num(wanted < NOTHING ? 0 : size, 3)} N${arrow.moment ? `, ${num(norm(arrow.moment), 3)} N m` : ""}`;
    // Beside the tip, on the side where the words have room.
    const room = LETTER_WIDTH * words.length;
    const right = end[0] >= x ? end[0] + room < WIDTH - SIDE_MARGIN : end[0] - room < SIDE_MARGIN;
    const text = svg("text", {
      class: `force-label is-${arrow.kind}`,
      x: p(end[0] + (right ? 10 : -10)),
      y: p(Math.min(LAST_BASELINE, Math.max(FIRST_BASELINE, end[1] + (end[1] > y ? 20 : -6)))),
      "text-anchor": right ? "start" : "end",
    });
    text.textContent = words;
    parts.push(text);
  }
  return parts;
}

/** Two strokes across: this arrow would be longer than it is drawn. */
function cut(x: number, y: number, ux: number, uy: number, kind: string): SVGElement {
  const stroke = (at: number): string =>
    `M${p(x + ux * at - uy * 8 - ux * 3)} ${p(y + uy * at + ux * 8 - uy * 3)}L${p(x + ux * at + uy * 8 + ux * 3)} ${p(y + uy * at - ux * 8 + uy * 3)}`;
  return svg("path", { class: `force-cut is-${kind}`, d: `${stroke(-3)}${stroke(4)}` });
}

/** Three quarters of a circle about the moment's axis, turning as it turns; two of them where it would be too large. */
function turn(arrow: Arrow, project: Project, sizes: Sizes, perMetre: number): SVGElement[] {
  const axis = unit(arrow.moment ?? [0, 0, 1]);
  const a = unit(cross(axis, Math.abs(axis[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
  const b = cross(axis, a);
  const wanted = norm(arrow.moment ?? [0, 0, 0]) * sizes.moment;
  const largest = sizes.longest / 2;
  const radius = Math.max(MIN_CIRCLE, Math.min(largest, wanted)) / perMetre;
  const at = (angle: number, r = radius): [number, number] =>
    project(add(arrow.at, add(scale(a, r * Math.cos(angle)), scale(b, r * Math.sin(angle)))));
  const last = 1.5 * Math.PI;
  const around = (r: number): string =>
    Array.from({ length: 25 }, (_, k) => at((k / 24) * last, r))
      .map(([x, y], k) => `${k === 0 ? "M" : "L"}${p(x)} ${p(y)}`)
      .join("");
  const path = wanted > largest ? around(radius) + around(0.8 * radius) : around(radius);
  const [tx, ty] = at(last);
  const [sx, sy] = at(last - 0.3);
  const seen = Math.hypot(tx - sx, ty - sy) || 1;
  const [ux, uy] = [(tx - sx) / seen, (ty - sy) / seen];
  const head = `M${p(tx + ux * 7)} ${p(ty + uy * 7)}L${p(tx - uy * 5)} ${p(ty + ux * 5)}L${p(tx + uy * 5)} ${p(ty - ux * 5)}Z`;
  return [svg("path", { class: "moment", d: path }), svg("path", { class: "moment-head", d: head })];
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
