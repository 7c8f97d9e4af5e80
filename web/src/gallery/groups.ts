// The built-in scenes in groups, and the ten that show what there is.

import type { SceneEntry } from "../api/types";
import { t } from "../core/texts";

/** A family of scenes takes a number in place of N. */
const FAMILY = /^(.+):N$/;
/** The number with which the link to a family begins. */
const FAMILY_START = "2";

/** The groups of the list, each with its scenes; what is in none stands last. */
const GROUPS: [title: () => string, names: string[]][] = [
  [
    () => t("Linkages and loops"),
    ["crank-rocker", "rssr", "spatial-slider-crank", "bricard", "n-four-bar:N"],
  ],
  [() => t("Pendulums and chains"), ["simple-pendulum", "spatial-double-pendulum", "spatial-chain:N"]],
  [() => t("Bodies that turn and fly"), ["heavy-top", "free-body", "free-body-flip", "free-fall"]],
  [() => t("Machines, and other readings of the printed data"), []],
];
/** Ten that show what there is. */
const CHOSEN = [
  "rssr",
  "bricard",
  "spatial-slider-crank",
  "crank-rocker",
  "governor",
  "spatial-double-pendulum",
  "heavy-top",
  "free-body-flip",
  "squeezer",
  "n-four-bar:N",
];

/** The name to run an entry by. */
export const runName = (name: string): string => {
  const family = FAMILY.exec(name)?.[1];
  return family ? `${family}:${FAMILY_START}` : name;
};

/** The name of a scene in words. */
export const titled = (name: string): string => {
  const words = (FAMILY.exec(name)?.[1] ?? name).replaceAll("-", " ").replace(":", ", ");
  // Letters that name joints, such as R and S, are no word.
  if (!/[aeiou]/.test(words)) return words.toUpperCase();
  return words.charAt(0).toUpperCase() + words.slice(1);
};

/** The chosen ten of what the server offers. */
export const chosen = (scenes: SceneEntry[]): SceneEntry[] =>
  CHOSEN.flatMap((name) => scenes.find((scene) => scene.name === name) ?? []);

/** The scenes in their groups; each name stands in one. */
export function grouped(scenes: SceneEntry[]): [title: string, scenes: SceneEntry[]][] {
  const named = new Set(GROUPS.flatMap(([, names]) => names));
  return GROUPS.map(([title, names]): [string, SceneEntry[]] => [
    title(),
    names.length > 0
      ? names.flatMap((name) => scenes.find((scene) => scene.name === name) ?? [])
      : scenes.filter((scene) => !named.has(scene.name)),
  ]).filter(([, list]) => list.length > 0);
}
