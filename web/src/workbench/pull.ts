// Pulling a body: by the mouse in the sketch, by number fields for everybody else. A spring joins hand and body.
import { h, svg } from "../core/dom";
import type { Vec3 } from "../core/types";
import { problemNotice } from "../ui/notice";
import type { Session } from "./session";
import type { Over } from "./sketch";
import { type Axes, add, along, out, scale, sub } from "./vec";

/** The hand's spring as a line from the grabbed point to the hand. */
export function pullLayer(session: Session): Over {
  const line = svg("path", { class: "pull-line" });
  const hand = svg("circle", { class: "pull-hand", r: 8 });
  const root = svg("g", { class: "pull-layer" }, line, hand);
  return {
    root,
    update: (state, project) => {
      const pull = session.latest?.pull;
      const body = pull && state.bodies.find((entry) => entry.name === pull.body);
      root.toggleAttribute("hidden", !body);
      root.style.display = body ? "" : "none";
      if (!pull || !body) return;
      const [x, y] = project(add(body.position, out([body.u, body.v, body.w], pull.point)));
      const [hx, hy] = project(pull.to);
      line.setAttribute("d", spring(x, y, hx, hy));
      hand.setAttribute("cx", hx.toFixed(1));
      hand.setAttribute("cy", hy.toFixed(1));
    },
  };
}

/** A zigzag of ten turns. */
function spring(x: number, y: number, hx: number, hy: number): string {
  const [dx, dy] = [hx - x, hy - y];
  const length = Math.hypot(dx, dy) || 1;
  const [nx, ny] = [-dy / length, dx / length];
  const points = Array.from({ length: 21 }, (_, k) => {
    const side = k === 0 || k === 20 ? 0 : k % 2 === 0 ? 5 : -5;
    return `${(x + (dx * k) / 20 + nx * side).toFixed(1)} ${(y + (dy * k) / 20 + ny * side).toFixed(1)}`;
  });
  return `M${points.join("L")}`;
}

export interface Grip {
  body: string;
  /** Where it was grabbed, in the world. */
  at: Vec3;
}

/** Makes bodies of the drawing follow the mouse. `move` turns a shift on the screen into one in the world. */
export function dragging(
  session: Session,
  root: SVGSVGElement,
  grip: (target: Element, x: number, y: number) => Grip | undefined,
  move: (dx: number, dy: number) => Vec3,
): void {
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
    const found = grip(event.target, x, y);
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
    void send(add(held.from, move(x - held.x, y - held.y)));
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

/** The same by numbers. */
export function pullPanel(session: Session): { root: HTMLElement; refresh: () => void } {
  const body = h("select", { class: "field compact", "aria-label": "Body to pull" });
  const fields = ["x", "y", "z"].map((axis) =>
    h("input", {
      type: "text",
      inputmode: "decimal",
      autocomplete: "off",
      class: "field number compact",
      value: "0",
      "aria-label": `Pull to ${axis}, in metres`,
    }),
  );
  const trouble = h("div", { "aria-live": "polite" });
  const release = h(
    "button",
    { type: "button", class: "button small", onclick: () => void attempt(() => session.pull(null)) },
    "Let go",
  );
  let offered = "";

  const attempt = async (run: () => Promise<void>): Promise<void> => {
    try {
      await run();
      trouble.replaceChildren();
    } catch (error) {
      trouble.replaceChildren(problemNotice(error));
    }
  };
  const pull = (): void => {
    const to = fields.map((field) => Number(field.value.trim().replace(",", ".").replace("−", "-"))) as Vec3;
    for (const [k, field] of fields.entries())
      field.setAttribute("aria-invalid", String(!Number.isFinite(to[k])));
    if (to.every(Number.isFinite))
      void attempt(() => session.pull({ body: body.value, point: [0, 0, 0], to }));
  };
  const here = (): void => {
    const found = session.latest?.bodies.find((entry) => entry.name === body.value);
    fields.forEach((field, k) => {
      field.value = String(Number((found?.position[k] ?? 0).toFixed(3)));
    });
  };
  body.addEventListener("change", here);
  const refresh = (): void => {
    const names = session.latest?.bodies.map((entry) => entry.name) ?? [];
    if (names.join("|") !== offered) {
      offered = names.join("|");
      body.replaceChildren(...names.map((name) => h("option", { value: name }, name)));
      here();
    }
    release.disabled = !session.latest?.pull;
  };
  const root = h(
    "details",
    { class: "expert" },
    h("summary", null, "Pull a body"),
    h(
      "div",
      { class: "stack" },
      h(
        "p",
        { class: "help" },
        "In the sketch, drag a body: a spring pulls it to the hand while the run goes on. Or pull the centre of mass by numbers, in metres.",
      ),
      h(
        "div",
        { class: "row wrap" },
        body,
        h("span", null, "to"),
        ...fields,
        h("button", { type: "button", class: "button small", onclick: pull }, "Pull"),
        release,
      ),
      trouble,
    ),
  );
  return { root, refresh };
}

/** A shift on the screen in the plane of the drawing. */
export const inPlane =
  (view: Axes, perMetre: number) =>
  (dx: number, dy: number): Vec3 =>
    add(scale(view[0], dx / perMetre), scale(view[1], -dy / perMetre));
