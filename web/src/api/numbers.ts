// Numbers of a scene that differ from what its author wrote, and how to get from one set of them to another.
import type { SessionScene } from "./types";

/** Deviations from the author's scene: parameters by name, any other numbers by JSON pointer. */
export interface Numbers {
  values: Record<string, number>;
  places: Record<string, unknown>;
}

export const none = (): Numbers => ({ values: {}, places: {} });
export const isNone = (set: Numbers): boolean =>
  Object.keys(set.values).length + Object.keys(set.places).length === 0;
export const count = (set: Numbers): number =>
  Object.keys(set.values).length + Object.keys(set.places).length;

/** The value at a JSON pointer. */
export function at(document: unknown, pointer: string): unknown {
  let value = document;
  for (const step of pointer.split("/").slice(1)) {
    if (typeof value !== "object" || value === null) return undefined;
    value = (value as Record<string, unknown>)[step.replaceAll("~1", "/").replaceAll("~0", "~")];
  }
  return value;
}

/** What has to be sent so that the deviations `from` become the deviations `to`. */
export function between(from: Numbers, to: Numbers, view: SessionScene): Numbers {
  const sent = none();
  for (const parameter of view.parameters) {
    const wanted = to.values[parameter.name] ?? parameter.initial;
    const now = from.values[parameter.name] ?? parameter.initial;
    if (wanted !== now) sent.values[parameter.name] = wanted;
  }
  for (const pointer of new Set([...Object.keys(from.places), ...Object.keys(to.places)])) {
    const wanted = pointer in to.places ? to.places[pointer] : at(view.original, pointer);
    const now = pointer in from.places ? from.places[pointer] : at(view.original, pointer);
    if (wanted !== undefined && JSON.stringify(wanted) !== JSON.stringify(now)) sent.places[pointer] = wanted;
  }
  return sent;
}

/** A set without the numbers that stand as the author wrote them. */
export function tidy(set: Numbers, view: SessionScene): Numbers {
  const kept = none();
  for (const parameter of view.parameters) {
    const value = set.values[parameter.name];
    if (value !== undefined && value !== parameter.initial) kept.values[parameter.name] = value;
  }
  for (const [pointer, value] of Object.entries(set.places)) {
    if (JSON.stringify(value) !== JSON.stringify(at(view.original, pointer))) kept.places[pointer] = value;
  }
  return kept;
}

export interface Leaf {
  pointer: string;
  /** The way to it in words, such as "bodies › bob › mass". */
  label: string;
  value: number;
}

/** What has no influence on the motion, or is shown elsewhere. */
const LEFT_OUT = new Set(["parameters", "shape"]);

/** All numbers of a scene, in its own order; elements of lists are called by their names. */
export function leaves(scene: unknown, most = 4000): Leaf[] {
  const found: Leaf[] = [];
  const walk = (value: unknown, pointer: string, names: string[]): void => {
    if (found.length >= most) return;
    if (typeof value === "number") found.push({ pointer, label: names.join(" › "), value });
    else if (Array.isArray(value)) {
      const triple = value.length === 3 && value.every((part) => typeof part === "number");
      value.forEach((part: unknown, k) => {
        const name = (part as { name?: string } | null)?.name;
        walk(part, `${pointer}/${k}`, [
          ...names,
          name ?? (triple ? (["x", "y", "z"][k] ?? String(k)) : String(k + 1)),
        ]);
      });
    } else if (typeof value === "object" && value !== null) {
      for (const [key, part] of Object.entries(value)) {
        if (LEFT_OUT.has(key)) continue;
        walk(part, `${pointer}/${key.replaceAll("~", "~0").replaceAll("/", "~1")}`, [
          ...names,
          key.replaceAll("_", " "),
        ]);
      }
    }
  };
  walk(scene, "", []);
  return found;
}
