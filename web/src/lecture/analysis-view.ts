// The result of an analysis over the presenter's picture, as followers and the hall are told of it.

import type { Vec3 } from "../api/types";
import type { ModeMotion, Placed, Pose } from "../mechanics/pose";

/** Letters of a pose that is sent along; a larger mechanism's is only told of, as the server takes views of 64 kB. */
const MOST_LETTERS = 32e3;
/** Digits of what is only drawn. */
const DIGITS = 6;

export interface AnalysisView {
  analysis: true;
  pose?: Pose;
}

/** What is sent beside the view while a pose stands in place of the run. */
export function viewOfPose(pose: Pose | undefined): AnalysisView | undefined {
  if (!pose) return undefined;
  const text = JSON.stringify(pose, (_, value: unknown) =>
    typeof value === "number" ? Number(value.toPrecision(DIGITS)) : value,
  );
  return text.length > MOST_LETTERS ? { analysis: true } : { analysis: true, pose: JSON.parse(text) as Pose };
}

/** Whether the presenter looks at an analysis, and where its bodies are if that is known; a view may come from anybody. */
export function analysisIn(view: unknown, bodies: number): AnalysisView | undefined {
  const given = record(view);
  if (given.analysis !== true) return undefined;
  const pose = record(given.pose);
  const placed = list(pose.bodies, ["position", "u", "v", "w"], bodies) as Placed[] | undefined;
  if (!placed) return { analysis: true };
  const parts = ["translation", "rotation", "translation_later", "rotation_later"];
  const shape = list(pose.shape, parts, bodies) as ModeMotion[] | undefined;
  const size = typeof pose.size === "number" && Number.isFinite(pose.size) ? pose.size : undefined;
  const swings = shape && size !== undefined ? { shape, size } : {};
  return { analysis: true, pose: { bodies: placed, ...swings } };
}

const record = (value: unknown): Record<string, unknown> =>
  typeof value === "object" && value !== null ? (value as Record<string, unknown>) : {};

/** A list of so many elements that have vectors under these names. */
function list(value: unknown, names: string[], length: number): Record<string, Vec3>[] | undefined {
  if (!Array.isArray(value) || value.length !== length) return undefined;
  const whole = value.every((one) => names.every((name) => isVector(record(one)[name])));
  return whole ? (value as Record<string, Vec3>[]) : undefined;
}

const isVector = (value: unknown): boolean =>
  Array.isArray(value) && value.length === 3 && value.every((part) => Number.isFinite(part));
