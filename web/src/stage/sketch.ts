// The scene as a line drawing: at once, without WebGL, and while the 3-D view is on its way.

import type { Body, BodyState, Joint, Scene, SessionState, Shape, Vec3 } from "../api/types";
import { svg } from "../core/dom";
import { type Axes, add, along, axesOf, cross, dot, norm, out, scale, sub, unit } from "../mechanics/vec";
import { type Grip, HEIGHT, inPlane, type Layer, type Project, WIDTH } from "./viewport";

interface Piece {
  body: number;
  /** Points along the body's reported axes, from its centre of mass. */
  points: Vec3[];
  element: SVGElement;
  place: (shown: [number, number][]) => void;
}

const GROUND = "ground";
/** Room around a body that flies out of the picture. */
const MARGIN = 120;

export interface Sketch {
  root: SVGSVGElement;
  /** The body under a place of the drawing, and the nearest point of its drawn parts. */
  grip: (target: Element, x: number, y: number) => Grip | undefined;
  /** The world's shift that a shift on the drawing means. */
  move: (dx: number, dy: number) => Vec3;
  update: (state: SessionState) => void;
  /** Draws a changed scene from its start. */
  rebuild: (scene: Scene) => void;
}

export function sketch(given: Scene | undefined, over: Layer[], joint: (name: string) => void): Sketch {
  let scene = given;
  const root = svg("svg", {
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
    class: "sketch",
    role: "img",
    "aria-label": "Line drawing of the mechanism",
  });
  const view = viewAxes(given?.gravity);
  let pieces: Piece[] | undefined;
  let perMetre = 1;
  let project: Project = () => [WIDTH / 2, HEIGHT / 2];

  const clickable = (element: SVGElement, name: string): void =>
    element.addEventListener("click", () => joint(name));

  const build = (state: SessionState): Piece[] => {
    const made: Piece[] = [];
    state.bodies.forEach((frame, at) => {
      const stated = scene?.bodies?.find((body) => body.name === frame.name);
      const toBody = converter(frame, stated?.position, axesOf(stated?.orientation));
      for (const shape of stated?.shape ?? []) made.push(...piecesOf(shape, at, toBody));
    });
    const fixedJoints: { point: Vec3; name: string }[] = [];
    for (const entry of scene?.joints ?? []) {
      const fixed =
        entry.body_i === GROUND ? entry.point_i : entry.body_j === GROUND ? entry.point_j : undefined;
      const onGround = entry.body_i === GROUND || entry.body_j === GROUND;
      const carrier = state.bodies.findIndex((body) => body.name === entry.body_j);
      const frame = state.bodies[carrier];
      const point = fixed ?? entry.point;
      if (onGround && point) fixedJoints.push({ point, name: entry.name });
      else if (!onGround && frame) {
        const pieces = jointOn(
          frame,
          carrier,
          scene?.bodies?.find((body) => body.name === frame.name),
          entry,
        );
        for (const piece of pieces) clickable(piece.element, entry.name);
        made.push(...pieces);
      }
    }
    const grounds = fixedJoints.map((entry) => entry.point);
    // Everything that is drawn, where it stands now.
    const reach = [
      ...grounds,
      ...state.bodies.map((frame) => frame.position),
      ...made.flatMap((piece) => {
        const frame = state.bodies[piece.body];
        return frame
          ? piece.points.map((point) => add(frame.position, out([frame.u, frame.v, frame.w], point)))
          : [];
      }),
    ];
    const span = fit(
      reach.map((p) => flat(view, p)),
      grounds.map((p) => flat(view, p)),
    );
    perMetre = span.scale;
    project = (p) => {
      const [x, y] = flat(view, p);
      return [WIDTH / 2 + (x - span.x) * span.scale, HEIGHT / 2 - (y - span.y) * span.scale];
    };
    for (const piece of made)
      if (piece.element instanceof SVGElement) piece.element.style.setProperty("--px", String(span.scale));
    const axisLength = 46 / span.scale;
    made.push(...state.bodies.flatMap((_, at) => triad(at, axisLength)));
    root.replaceChildren(
      ...made.map((piece) => piece.element),
      ...fixedJoints.map(({ point, name }) => {
        const [cx, cy] = project(point);
        const dot = svg("circle", { cx, cy, r: 5, class: "sketch-joint" });
        clickable(dot, name);
        return dot;
      }),
      ...over.map((layer) => layer.root),
    );
    return made;
  };

  let last: SessionState | undefined;
  // The picture grows when a body flies out of it, and stays so until it is drawn anew.
  let frame: [number, number, number, number] = [0, 0, WIDTH, HEIGHT];
  const follow = (state: SessionState): void => {
    let [left, top, right, bottom] = frame;
    for (const body of state.bodies) {
      const [x, y] = project(body.position);
      if (!Number.isFinite(x + y)) continue;
      if (x < 0 || x > WIDTH) [left, right] = [Math.min(left, x - MARGIN), Math.max(right, x + MARGIN)];
      if (y < 0 || y > HEIGHT) [top, bottom] = [Math.min(top, y - MARGIN), Math.max(bottom, y + MARGIN)];
    }
    if ([left, top, right, bottom].every((side, at) => side === frame[at])) return;
    frame = [left, top, right, bottom];
    root.setAttribute("viewBox", `${left} ${top} ${right - left} ${bottom - top}`);
  };

  return {
    root,
    grip: (target, x, y) => {
      const piece = pieces?.find(
        (entry) => entry.element === target && !entry.element.matches(".sketch-axis, .sketch-joint"),
      );
      const frame = piece && last?.bodies[piece.body];
      if (!piece || !frame) return undefined;
      // The point in the plane through the piece's middle that lies under the mouse.
      const axes: Axes = [frame.u, frame.v, frame.w];
      const middle = add(
        frame.position,
        out(
          axes,
          scale(
            piece.points.reduce((sum, point) => add(sum, point), [0, 0, 0] as Vec3),
            1 / piece.points.length,
          ),
        ),
      );
      const [mx, my] = project(middle);
      return { body: frame.name, at: add(middle, inPlane(view, perMetre)(x - mx, y - my)) };
    },
    move: (dx, dy) => inPlane(view, perMetre)(dx, dy),
    rebuild: (changed) => {
      scene = changed;
      pieces = undefined;
      frame = [0, 0, WIDTH, HEIGHT];
      root.setAttribute("viewBox", frame.join(" "));
    },
    update: (state) => {
      last = state;
      pieces ??= build(state);
      for (const piece of pieces) {
        const frame = state.bodies[piece.body];
        if (!frame) continue;
        const axes: Axes = [frame.u, frame.v, frame.w];
        piece.place(piece.points.map((point) => project(add(frame.position, out(axes, point)))));
      }
      follow(state);
      for (const layer of over) layer.update(state, project, perMetre);
    },
  };
}

/** Turns a point of the body's own frame into the axes that the server reports, using the first state. */
function converter(frame: BodyState, origin: Vec3 = frame.position, stated: Axes): (p: Vec3) => Vec3 {
  const axes: Axes = [frame.u, frame.v, frame.w];
  return (p) => along(axes, sub(add(origin, out(stated, p)), frame.position));
}

function piecesOf(shape: Shape, body: number, toBody: (p: Vec3) => Vec3): Piece[] {
  if (shape.kind === "rod") {
    const element = svg("line", { class: "sketch-rod" });
    element.style.setProperty("--r", String(shape.radius));
    return [
      {
        body,
        points: [toBody(shape.from), toBody(shape.to)],
        element,
        place: ([a, b]) => a && b && set(element, { x1: a[0], y1: a[1], x2: b[0], y2: b[1] }),
      },
    ];
  }
  if (shape.kind === "sphere") {
    const element = svg("circle", { class: "sketch-ball" });
    element.style.setProperty("--r", String(shape.radius));
    return [
      {
        body,
        points: [toBody(shape.center)],
        element,
        place: ([c]) => c && set(element, { cx: c[0], cy: c[1] }),
      },
    ];
  }
  const [a, b, c] = scale(shape.size, 0.5);
  const corner = (i: number): Vec3 =>
    toBody(add(shape.center, [i & 1 ? a : -a, i & 2 ? b : -b, i & 4 ? c : -c]));
  const edges = [
    [0, 1],
    [2, 3],
    [4, 5],
    [6, 7],
    [0, 2],
    [1, 3],
    [4, 6],
    [5, 7],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
  ] as const;
  const element = svg("path", { class: "sketch-box" });
  return [
    {
      body,
      points: Array.from({ length: 8 }, (_, i) => corner(i)),
      element,
      place: (at) =>
        set(element, { d: edges.map(([i, j]) => `M${at[i]?.join(" ")}L${at[j]?.join(" ")}`).join("") }),
    },
  ];
}

/** A joint between two moving bodies is carried by the second one. */
function jointOn(frame: BodyState, body: number, stated: Body | undefined, joint: Joint): Piece[] {
  const point = joint.point
    ? along([frame.u, frame.v, frame.w], sub(joint.point, frame.position))
    : joint.point_j && converter(frame, stated?.position, axesOf(stated?.orientation))(joint.point_j);
  if (!point) return [];
  const element = svg("circle", { r: 5, class: "sketch-joint" });
  return [{ body, points: [point], element, place: ([c]) => c && set(element, { cx: c[0], cy: c[1] }) }];
}

function triad(body: number, length: number): Piece[] {
  return (["u", "v", "w"] as const).map((name, k) => {
    const element = svg("line", { class: `sketch-axis axis-${name}` });
    const tip: Vec3 = [0, 0, 0];
    tip[k] = length;
    return {
      body,
      points: [[0, 0, 0], tip],
      element,
      place: ([a, b]) => a && b && set(element, { x1: a[0], y1: a[1], x2: b[0], y2: b[1] }),
    };
  });
}

function set(element: SVGElement, values: Record<string, string | number>): void {
  for (const [key, value] of Object.entries(values))
    element.setAttribute(key, typeof value === "number" ? value.toFixed(1) : value);
}

/** To the right and up on the paper: looks along the horizontal, a little from the side and above. */
function viewAxes(gravity: Vec3 | undefined): Axes {
  const up: Vec3 = gravity && norm(gravity) > 0 ? unit(scale(gravity, -1)) : [0, 0, 1];
  const flatAxis: Vec3 = Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const right = unit(sub(flatAxis, scale(up, dot(flatAxis, up))));
  const toward = cross(right, up);
  const [turn, tilt] = [0.42, 0.26];
  const r2 = add(scale(right, Math.cos(turn)), scale(toward, -Math.sin(turn)));
  const f2 = add(scale(toward, Math.cos(turn)), scale(right, Math.sin(turn)));
  const u2 = add(scale(up, Math.cos(tilt)), scale(f2, -Math.sin(tilt)));
  return [r2, u2, f2];
}

const flat = (view: Axes, p: Vec3): [number, number] => [dot(view[0], p), dot(view[1], p)];

/** Mechanisms swing about their ground: the circle that holds their first picture around it is kept in view. */
function fit(points: [number, number][], about: [number, number][]): { x: number; y: number; scale: number } {
  const around = about.length > 0 ? about : points;
  const middle = (k: 0 | 1): number =>
    around.reduce((sum, point) => sum + point[k], 0) / Math.max(1, around.length);
  const [x, y] = [middle(0), middle(1)];
  const reach = Math.max(0.2, ...points.map(([px, py]) => Math.hypot(px - x, py - y)));
  return { x, y, scale: Math.min(WIDTH, HEIGHT) / (reach * 2.2) };
}
