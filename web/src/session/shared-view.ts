// One link holds what somebody looks at: numbers that were changed, the time, the selected joint, panel and picture.

import type { Numbers } from "../api/numbers";
import { addressOf } from "../core/address";
import { t } from "../core/texts";

/** What a link holds beside the lesson or scene of its path. Its keys are published: old links use them. */
export interface SharedView {
  numbers?: Numbers;
  time?: number;
  /** The time lies behind the newest one. */
  back?: boolean;
  /** The run goes on from there by itself. */
  plays?: boolean;
  joint?: string;
  panel?: string;
  /** The plot that is chosen, by its key: energy drift, a body's velocity, a joint's force. */
  plot?: string;
  picture?: "drawing" | "viewer";
  /** From where the mechanism is looked at. */
  camera?: string;
  /** Which forces are drawn: joint, all, none, or body:NAME. */
  drawn?: string;
  /** The reaction convention: on which body, about which point, in which frame, such as j.joint.world. */
  told?: string;
  /** The text of a scene of one's own. */
  scene?: string;
}

/** Longest link, characters: mail programs and chats cut longer ones. */
export const MAX_LENGTH = 16_000;
/** Largest text that a link may unpack to, bytes: more than the text of any scene. */
const MAX_TEXT = 2_000_000;
/** The link's one parameter. */
const NAME = "show";

/** A view as the value of the link's parameter. */
export async function pack(seen: SharedView): Promise<string> {
  const bytes = new TextEncoder().encode(JSON.stringify(seen));
  const packed = await through(bytes, new CompressionStream("deflate-raw"), Infinity);
  let text = "";
  for (const byte of packed) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** What a link holds; undefined where it cannot be read. */
export async function unpack(text: string): Promise<SharedView | undefined> {
  try {
    const raw = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(raw, (sign) => sign.charCodeAt(0));
    const json = new TextDecoder().decode(
      await through(bytes, new DecompressionStream("deflate-raw"), MAX_TEXT),
    );
    return parseView(JSON.parse(json));
  } catch {
    return undefined;
  }
}

/** The page's address with this view in it. */
export async function linkTo(path: string, seen: SharedView): Promise<string> {
  const url = new URL(addressOf(path), location.href);
  url.search = "";
  url.hash = "";
  url.searchParams.set(NAME, await pack(seen));
  return url.href;
}

/** What the page's own address asks to be shown: null if nothing, undefined if it cannot be read. */
export async function viewOfAddress(): Promise<SharedView | null | undefined> {
  const text = new URLSearchParams(location.search).get(NAME);
  return text === null ? null : unpack(text);
}

/** Keeps what has the right type; a link may come from anybody. */
export function parseView(value: unknown): SharedView | undefined {
  if (typeof value !== "object" || value === null || Array.isArray(value)) return undefined;
  const given = value as Record<string, unknown>;
  const seen: SharedView = {};
  for (const key of ["joint", "panel", "plot", "drawn", "told", "scene", "camera"] as const)
    if (typeof given[key] === "string") seen[key] = given[key];
  if (given.back === true) seen.back = true;
  if (given.plays === true) seen.plays = true;
  if (given.picture === "drawing" || given.picture === "viewer") seen.picture = given.picture;
  if (typeof given.time === "number" && Number.isFinite(given.time) && given.time >= 0)
    seen.time = given.time;
  const numbers = given.numbers as { values?: unknown; places?: unknown } | undefined;
  if (
    isRecord(numbers?.values) &&
    isRecord(numbers.places) &&
    Object.values(numbers.values).every((part) => typeof part === "number")
  ) {
    seen.numbers = { values: numbers.values as Record<string, number>, places: numbers.places };
  }
  return seen;
}

const isRecord = (value: unknown): value is Record<string, unknown> =>
  typeof value === "object" && value !== null && !Array.isArray(value);

async function through(
  bytes: Uint8Array<ArrayBuffer>,
  change: CompressionStream | DecompressionStream,
  most: number,
): Promise<Uint8Array<ArrayBuffer>> {
  const reader = new Blob([bytes]).stream().pipeThrough(change).getReader();
  const parts: Uint8Array[] = [];
  let size = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    size += value.byteLength;
    if (size > most) throw new Error(t("the link unpacks to more than a scene may have"));
    parts.push(value);
  }
  const whole = new Uint8Array(size);
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.byteLength;
  }
  return whole;
}
