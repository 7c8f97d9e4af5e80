// What a follower and the hall are told of a lecture beside its picture: what is looked at, and which numbers were changed.

import { at, leaves } from "../api/numbers";
import type { SessionScene } from "../api/types";
import { h, setText } from "../core/dom";
import { num } from "../core/format";
import { listed, t } from "../core/texts";
import type { Follower } from "./follower";

/** So many changed numbers are named; more cannot be read beside a run. */
const MOST = 4;

export function statusOf({ lecture, over, roaming, analysis }: Follower): string {
  if (over) return t("The lecture is over. What was shown can still be looked at here.");
  if (!lecture?.source) return t("The presenter shows nothing at the moment.");
  if (roaming) return t("You look around on your own; the lecture goes on.");
  return analysis ? analysisTold(analysis.pose !== undefined) : t("You see what the presenter shows.");
}

/** That the presenter looks at no moment of the run; `seen` is whether the picture shows what they look at. */
export const analysisTold = (seen: boolean): string =>
  seen
    ? t("The picture shows the result of an analysis, not the run.")
    : t("The presenter looks at the result of an analysis. The picture here is that of the run.");

/** Which numbers differ from those of the scene's author, each with the author's and the present one. */
export function changedTold(view: SessionScene | undefined): string {
  const changed = view ? changedNumbers(view) : [];
  if (changed.length === 0) return "";
  const more = changed.length - MOST;
  const named = more > 0 ? [...changed.slice(0, MOST), t("{n} further | {n} further", { n: more })] : changed;
  return t("Changed by the presenter: {numbers}.", { numbers: listed(named) });
}

/** The line that tells it; that all stands as it was is told where something was changed before. */
export function changedLine(follower: Follower): HTMLElement {
  const line = h("p", { class: "lecture-changed", role: "status" });
  follower.on("scene", () => {
    const before = line.textContent ? t("All numbers stand as the author wrote them.") : "";
    setText(line, changedTold(follower.view) || before);
  });
  return line;
}

function changedNumbers({ parameters, scene, original }: SessionScene): string[] {
  const told = (label: string, before: number, now: number, unit: string | null = null): string =>
    `${label} ${num(before)} → ${num(now)}${unit ? `\u00a0${unit}` : ""}`;
  const offered = parameters
    .filter(({ value, initial }) => value !== initial)
    .map(({ label, initial, value, unit }) => told(label, initial, value, unit));
  const places = new Set(parameters.flatMap(({ pointers }) => pointers));
  const others = leaves(scene).flatMap(({ pointer, label, value }) => {
    const before = at(original, pointer);
    return places.has(pointer) || typeof before !== "number" || before === value
      ? []
      : [told(label, before, value)];
  });
  return [...offered, ...others];
}
