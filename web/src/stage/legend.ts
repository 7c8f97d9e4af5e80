// The scale of the arrows in the 3-D view, in words, and the force of the selected joint in big type.

import { h, setText } from "../core/dom";
import { num } from "../core/format";
import { t } from "../core/texts";
import { arrows, roundDown } from "../mechanics/forces";
import { norm } from "../mechanics/vec";
import type { Session } from "../session/session";

/** It follows the session by itself, also while the picture shows no moment of the run and has no forces to tell. */
export function legend(session: Session): { root: HTMLElement; dispose: () => void } {
  const scale = h("span");
  const selected = h("b", { class: "stage-selected" });
  const root = h("p", { class: "stage-legend", hidden: true }, selected, scale);
  const update = (): void => {
    const drawing = session.latest?.drawing;
    const state = session.shown;
    root.hidden =
      !drawing ||
      !state ||
      session.drawn.what === "none" ||
      state.forces.length === 0 ||
      session.pose !== undefined;
    if (root.hidden || !drawing || !state) return;
    const newtons = roundDown((0.4 * drawing.longest) / drawing.force_scale);
    const moments = roundDown((0.2 * drawing.longest) / drawing.moment_scale);
    const turning = state.forces.some((entry) => norm(entry.moment) > 0);
    const arrowText = t("Arrow {length} m long: {force} N.", {
      length: num(newtons * drawing.force_scale, 2),
      force: num(newtons),
    });
    const circleText = turning
      ? t("Circle of {length} m: {moment} N m.", {
          length: num(moments * drawing.moment_scale, 2),
          moment: num(moments),
        })
      : "";
    setText(scale, [arrowText, circleText, t("Drawn double: more than shown.")].filter(Boolean).join(" "));
    const [arrow] =
      session.joint === null ? [] : arrows(state, { what: "joint" }, session.joint, session.convention);
    setText(
      selected,
      arrow
        ? `${arrow.label}: ${num(norm(arrow.force), 3)} N${arrow.moment ? `, ${num(norm(arrow.moment), 3)} N m` : ""}`
        : "",
    );
  };
  const undo = (["shown", "view", "selected", "scene"] as const).map((event) => session.on(event, update));
  update();
  return {
    root,
    dispose: () => {
      for (const step of undo) step();
    },
  };
}
