// The side from which the mechanism is seen. The viewer's own camera can be turned by the mouse but not read, so a
// link and a lecture carry one of these sides.

import type { Camera } from "../api/types";
import { h } from "../core/dom";
import { bind } from "../core/keys";
import { t } from "../core/texts";
import type { Session } from "../session/session";

const SIDES: [Camera, () => string][] = [
  ["corner", () => t("corner")],
  ["front", () => t("front")],
  ["side", () => t("side")],
  ["above", () => t("above")],
];

export function cameras(session: Session): { root: HTMLElement; dispose: () => void } {
  const select = h(
    "select",
    {
      class: "field compact",
      "aria-label": t("Look at the mechanism from"),
      title: t("Look at the mechanism from (C)"),
    },
    ...SIDES.map(([value, label]) => h("option", { value }, label())),
  );
  select.addEventListener("change", () => session.lookFrom(select.value as Camera));
  const silence = session.on("view", () => {
    select.value = session.camera;
  });
  const release = bind([
    {
      keys: ["c", "C"],
      shown: "C",
      does: t("Camera: corner, front, side, above"),
      run: () => {
        const at = SIDES.findIndex(([side]) => side === session.camera);
        session.lookFrom(SIDES[(at + 1) % SIDES.length]?.[0] ?? "corner");
      },
    },
  ]);
  return {
    root: select,
    dispose: () => {
      silence();
      release();
    },
  };
}
