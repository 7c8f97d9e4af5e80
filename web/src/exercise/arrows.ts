// Arrows of a free-body diagram: their places, senses and words, and how they are drawn.

import type { Answer, Question } from "../api/types";
import { h, svg } from "../core/dom";
import { t } from "../core/texts";

export type Arrow = NonNullable<Answer["diagram"]>[number];
export type Diagram = NonNullable<Question["diagram"]>;
export type Sense = Arrow["along"];

/** Length of a force, radius of a moment, and the least way of a drag, px of the picture. */
const FORCE = 52;
const MOMENT = 24;
export const LEAST_DRAG = 12;

/** The six things that can be drawn at a point: four forces in the picture, two moments out of it. */
export interface Choice {
  kind: Arrow["kind"];
  along: Sense;
  label: string;
}

export function choicesOf(diagram: Diagram): Choice[] {
  const [right, up, out] = diagram.axes;
  const turn: [Sense, Sense] = diagram.anticlockwise ? [`+${out}`, `-${out}`] : [`-${out}`, `+${out}`];
  return [
    { kind: "force", along: `+${right}`, label: t("force to the right (+{right})", { right }) },
    { kind: "force", along: `-${right}`, label: t("force to the left (−{right})", { right }) },
    { kind: "force", along: `+${up}`, label: t("force upwards (+{up})", { up }) },
    { kind: "force", along: `-${up}`, label: t("force downwards (−{up})", { up }) },
    { kind: "moment", along: turn[0], label: t("moment anticlockwise ({turn})", { turn: written(turn[0]) }) },
    { kind: "moment", along: turn[1], label: t("moment clockwise ({turn})", { turn: written(turn[1]) }) },
  ];
}

const written = (sense: Sense): string => sense.replace("-", "−");

/** Where a point of a body lies in the picture, and its name for people. */
export function placeOf(diagram: Diagram, arrow: { on: string; at: string }) {
  return diagram.bodies.find((body) => body.name === arrow.on)?.places.find((place) => place.id === arrow.at);
}

export function inWords(diagram: Diagram, arrow: Arrow): string {
  const choice = choicesOf(diagram).find((one) => one.kind === arrow.kind && one.along === arrow.along);
  return t("{label} at {label2} on {on}", {
    label: choice?.label ?? arrow.kind,
    label2: placeOf(diagram, arrow)?.label ?? arrow.at,
    on: arrow.on,
  });
}

/** Whether two arrows differ in their sense at most. */
export function sameLine(a: Arrow, b: Arrow): boolean {
  return a.kind === b.kind && a.at === b.at && a.on === b.on && a.along[1] === b.along[1];
}

/** The point on the diagram's list where weights act. */
const CENTRE = "centre";

/**
 * To which of several things that stand at one point a dragged force belongs: to the first of them, or, if it has one on this line
 * already, to the centre of mass, where the weight acts.
 */
export function forceAt(arrows: Arrow[], places: string[], on: string, along: Sense): string {
  const [first = ""] = places;
  const taken = arrows.some((other) => sameLine(other, { kind: "force", at: first, on, along }));
  return taken && places.includes(CENTRE) ? CENTRE : first;
}

/** What else stands where an arrow begins, itself among it. */
export function placesThere(diagram: Diagram, arrow: Arrow) {
  const at = `${placeOf(diagram, arrow)?.at}`;
  const body = diagram.bodies.find((one) => one.name === arrow.on);
  return (body?.places ?? []).filter((place) => `${place.at}` === at);
}

/** The force that a drag over the picture means: along the axis that it follows best; nothing for a click. */
export function dragged(diagram: Diagram, dx: number, dy: number): Sense | undefined {
  if (Math.hypot(dx, dy) < LEAST_DRAG) return undefined;
  const [right, up] = diagram.axes;
  return Math.abs(dx) > Math.abs(dy) ? `${dx > 0 ? "+" : "-"}${right}` : `${dy < 0 ? "+" : "-"}${up}`;
}

/** An arrow as it stands in the picture. */
export function drawn(diagram: Diagram, arrow: Arrow): SVGElement | undefined {
  const place = placeOf(diagram, arrow);
  if (!place) return undefined;
  const [x, y] = place.at as [number, number];
  const sign = arrow.along[0] === "+" ? 1 : -1;
  if (arrow.kind === "moment") {
    const turn = diagram.anticlockwise ? sign : -sign;
    const sweep = turn < 0 ? 1 : 0;
    const end = x - MOMENT * turn;
    const path = `M${x + MOMENT * turn} ${y}A${MOMENT} ${MOMENT} 0 0 ${sweep} ${end} ${y}m-6 -6l6 6l6 -6`;
    return svg("path", { d: path, class: "drawn-moment" });
  }
  const across = arrow.along[1] === diagram.axes[0];
  const [dx, dy] = across ? [sign, 0] : [0, -sign];
  const [ex, ey] = [x + FORCE * dx, y + FORCE * dy];
  const [bx, by] = [ex - 9 * dx, ey - 9 * dy];
  const head = `M${bx - 5 * dy} ${by + 5 * dx}L${ex} ${ey}L${bx + 5 * dy} ${by - 5 * dx}`;
  return svg("path", { d: `M${x} ${y}L${ex} ${ey}${head}`, class: "drawn-force" });
}

/** Arrows that were drawn before, as far as they still fit. */
export function drafted(diagram: Diagram, draft: string[] | undefined): Arrow[] {
  const read = (text: string): Arrow | undefined => {
    try {
      return JSON.parse(text) as Arrow;
    } catch {
      return undefined;
    }
  };
  return (draft ?? [])
    .map(read)
    .filter((arrow): arrow is Arrow => arrow !== undefined && placeOf(diagram, arrow) !== undefined);
}

/** A list to choose from, with its label. */
export function labelledSelect(
  id: string,
  label: string,
  described: string,
): { root: HTMLElement; select: HTMLSelectElement } {
  const select = h("select", { id, class: "field", "aria-describedby": described });
  return { root: h("div", { class: "setting" }, h("label", { for: id }, label), select), select };
}
