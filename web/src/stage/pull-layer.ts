// Pulling a body by the mouse in the sketch: a spring joins hand and body.

import type { Vec3 } from "../api/types";
import { svg } from "../core/dom";
import { type Axes, add, along, out, sub } from "../mechanics/vec";
import type { Session } from "../session/session";
import type { Sketch } from "./sketch";
import type { Layer } from "./viewport";

/** Radius of the circle that stands for the hand, in units of the drawing. */
const HAND_RADIUS = 8;

/** The hand's spring as a line from the grabbed point to the hand. */
export function pullLayer(session: Session): Layer {
  const line = svg("path", { class: "pull-line" });
  const hand = svg("circle", { class: "pull-hand", r: HAND_RADIUS });
  const root = svg("g", { class: "pull-layer" }, line, hand);
  return {
    root,
    update: (state, project) => {
      const pull = session.latest?.pull;
      const body = pull && state.bodies.find((entry) => entry.name === pull.body);
      root.toggleAttribute("hidden", !body);
      root.style.display = body ? "" : "none";
      if (!pull || !body) return;
      const [x, y] = project(add(body.position, out([body.u, body.v, body.w], pull.point ?? [0, 0, 0])));
      const [hx, hy] = project(pull.to);
      line.setAttribute("d", spring(x, y, hx, hy));
      hand.setAttribute("cx", hx.toFixed(1));
      hand.setAttribute("cy", hy.toFixed(1));
    },
  };
}

/** Straight pieces of the zigzag of a spring. */
const SPRING_PIECES = 20;
/** Distance of the corners of a spring from its axis, in units of the drawing. */
const SPRING_WIDTH = 5;

/** A spring between two points of the drawing. */
function spring(x: number, y: number, hx: number, hy: number): string {
  const [dx, dy] = [hx - x, hy - y];
  const length = Math.hypot(dx, dy) || 1;
  const [nx, ny] = [-dy / length, dx / length];
  const points = Array.from({ length: SPRING_PIECES + 1 }, (_, k) => {
    const end = k === 0 || k === SPRING_PIECES;
    const side = end ? 0 : k % 2 === 0 ? SPRING_WIDTH : -SPRING_WIDTH;
    const along = k / SPRING_PIECES;
    return `${(x + dx * along + nx * side).toFixed(1)} ${(y + dy * along + ny * side).toFixed(1)}`;
  });
  return `M${points.join("L")}`;
}

/** Makes bodies of the drawing follow the mouse. */
export function dragging(session: Session, sketch: Sketch): void {
  const { root } = sketch;
  let held: { body: string; point: Vec3; from: Vec3; x: number; y: number } | undefined;
  let wanted: Vec3 | null | undefined;
  let sending = false;

  const send = async (to: Vec3 | null): Promise<void> => {
    wanted = to;
    if (sending) return;
    sending = true;
    try {
      while (wanted !== undefined) {
        const target: Vec3 | null = wanted;
        wanted = undefined;
        await session.pull(target && held ? { body: held.body, point: held.point, to: target } : null);
      }
    } catch {
      // A body that has been let go, or a session that is gone: the next grip starts anew.
    } finally {
      sending = false;
    }
  };
  const onScreen = (event: PointerEvent): [number, number] => {
    const matrix = root.getScreenCTM();
    return matrix
      ? [(event.clientX - matrix.e) / matrix.a, (event.clientY - matrix.f) / matrix.d]
      : [event.offsetX, event.offsetY];
  };

  root.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !(event.target instanceof Element)) return;
    const [x, y] = onScreen(event);
    const found = sketch.grip(event.target, x, y);
    const body = found && session.latest?.bodies.find((entry) => entry.name === found.body);
    if (!found || !body) return;
    const axes: Axes = [body.u, body.v, body.w];
    held = { body: found.body, point: along(axes, sub(found.at, body.position)), from: found.at, x, y };
    root.setPointerCapture(event.pointerId);
    root.classList.add("is-pulling");
    event.preventDefault();
  });
  root.addEventListener("pointermove", (event) => {
    if (!held) return;
    const [x, y] = onScreen(event);
    void send(add(held.from, sketch.move(x - held.x, y - held.y)));
  });
  const letGo = (): void => {
    if (!held) return;
    root.classList.remove("is-pulling");
    void send(null).then(() => {
      held = undefined;
    });
  };
  root.addEventListener("pointerup", letGo);
  root.addEventListener("pointercancel", letGo);
}
