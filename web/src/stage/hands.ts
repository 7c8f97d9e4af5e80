// What pointer, wheel and keys do on the drawing: choose a joint, pull a body, look from elsewhere.

import type { Vec3 } from "../api/types";
import { type Axes, add, along, sub } from "../mechanics/vec";
import type { Session } from "../session/session";
import type { Drawing } from "./drawing";
import type { Point } from "./pen";

/** Turn by a pixel of the pointer, rad. */
const TURN_PER_PIXEL = 0.008;
/** Turn by a key, rad. */
const TURN_PER_KEY = 0.12;
/** Nearer by a notch of the wheel, by a key. */
const ZOOM_PER_KEY = 1.15;
const ZOOM_PER_WHEEL = 0.0016;
/** A pointer that has moved less than this has pressed, not dragged, CSS pixels. */
const CLICK = 4;

type Held =
  | { what: "press"; from: Point; at: Point; joint: string | undefined }
  | { what: "body"; body: string; point: Vec3; from: Vec3; at: Point };

/** Lets hands at the drawing; the body that is grabbed is pulled where the page steers the run. */
export function hands(session: Session, drawing: Drawing): void {
  const { root } = drawing;
  const pull = puller(session);
  let held: Held | undefined;
  const where = (event: PointerEvent | WheelEvent): Point => [event.offsetX, event.offsetY];

  root.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    const at = where(event);
    const joint = drawing.jointAt(at);
    const grip = joint === undefined && session.controls && !session.pose ? drawing.grip(at) : undefined;
    const body = grip && session.latest?.bodies.find((entry) => entry.name === grip.body);
    if (grip && body) {
      const axes: Axes = [body.u, body.v, body.w];
      held = {
        what: "body",
        body: grip.body,
        point: along(axes, sub(grip.at, body.position)),
        from: grip.at,
        at,
      };
      root.classList.add("is-pulling");
    } else held = { what: "press", from: at, at, joint };
    root.setPointerCapture(event.pointerId);
  });
  root.addEventListener("pointermove", (event) => {
    const at = where(event);
    if (!held) {
      const over =
        drawing.jointAt(at) !== undefined ? "pointer" : session.controls && drawing.grip(at) ? "grab" : "";
      if (root.style.cursor !== over) root.style.cursor = over;
      return;
    }
    if (held.what === "body") {
      pull({
        body: held.body,
        point: held.point,
        to: add(held.from, drawing.move(at[0] - held.at[0], at[1] - held.at[1])),
      });
      return;
    }
    if (Math.hypot(at[0] - held.from[0], at[1] - held.from[1]) < CLICK && held.at === held.from) return;
    drawing.turn(-TURN_PER_PIXEL * (at[0] - held.at[0]), TURN_PER_PIXEL * (at[1] - held.at[1]));
    held = { ...held, at, joint: undefined };
  });
  const letGo = (): void => {
    if (held?.what === "body") pull(null);
    if (held?.what === "press" && held.joint !== undefined)
      session.select(session.joint === held.joint ? null : held.joint);
    root.classList.remove("is-pulling");
    held = undefined;
  };
  root.addEventListener("pointerup", letGo);
  root.addEventListener("pointercancel", letGo);
  touches(session, drawing);
  looking(drawing);
}

type Pull = Parameters<Session["pull"]>[0];

/** Sends one pull at a time, the newest. */
function puller(session: Session): (pull: Pull) => void {
  let wanted: Pull | undefined;
  let sending = false;
  const send = async (): Promise<void> => {
    sending = true;
    try {
      while (wanted !== undefined) {
        const next: Pull = wanted;
        wanted = undefined;
        await session.pull(next);
      }
    } catch {
      // A body that has been let go, or a session that is gone: the next grip starts anew.
    } finally {
      sending = false;
    }
  };
  return (pull) => {
    wanted = pull;
    if (!sending) void send();
  };
}

function touches(session: Session, drawing: Drawing): void {
  const { root } = drawing;
  // A finger on a body pulls it; elsewhere it scrolls the page up and down, as `touch-action` says.
  root.addEventListener(
    "touchstart",
    (event) => {
      const touch = event.touches[0];
      const box = root.getBoundingClientRect();
      if (touch && session.controls && drawing.grip([touch.clientX - box.left, touch.clientY - box.top]))
        event.preventDefault();
    },
    { passive: false },
  );
}

/** Lets pointer, wheel and keys look from elsewhere; nothing is chosen or pulled. */
export function turning(drawing: Drawing): void {
  const { root } = drawing;
  let held: Point | undefined;
  root.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    held = [event.offsetX, event.offsetY];
    root.setPointerCapture(event.pointerId);
  });
  root.addEventListener("pointermove", (event) => {
    if (!held) return;
    const [x, y] = held;
    held = [event.offsetX, event.offsetY];
    drawing.turn(-TURN_PER_PIXEL * (held[0] - x), TURN_PER_PIXEL * (held[1] - y));
  });
  for (const end of ["pointerup", "pointercancel"] as const)
    root.addEventListener(end, () => {
      held = undefined;
    });
  looking(drawing);
}

/** Turns the picture and comes closer, by wheel and keys. */
function looking(drawing: Drawing): void {
  const { root } = drawing;
  // Without Ctrl the wheel scrolls the page.
  root.addEventListener(
    "wheel",
    (event) => {
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      drawing.zoom(Math.exp(-ZOOM_PER_WHEEL * event.deltaY), [event.offsetX, event.offsetY]);
    },
    { passive: false },
  );
  root.addEventListener("keydown", (event) => {
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [TURN_PER_KEY, 0],
      ArrowRight: [-TURN_PER_KEY, 0],
      ArrowUp: [0, TURN_PER_KEY],
      ArrowDown: [0, -TURN_PER_KEY],
    };
    const turn = event.shiftKey ? turns[event.key] : undefined;
    if (turn) drawing.turn(...turn);
    else if (event.key === "+" || event.key === "=") drawing.zoom(ZOOM_PER_KEY);
    else if (event.key === "-") drawing.zoom(1 / ZOOM_PER_KEY);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
}
