// What a picture of the mechanism is made from, and its parts in the order in which they hide each other.

import type { SessionState } from "../api/types";
import type { Eye } from "./eye";
import type { Palette } from "./palette";
import type { Parts } from "./solids";

/** Thinnest body, CSS pixels. */
export const THIN = 6;

export interface Shown {
  eye: Eye;
  state: SessionState;
  parts: Parts;
  colours: Palette;
  /** The chosen joint. */
  joint: string | null;
  /** Height of the floor along the upward axis, m; none where nothing says what is down. */
  floor: number | undefined;
  /** Without axes and names: a small picture in a list. */
  plain?: boolean;
}

export interface Item {
  /** How near its middle is. */
  near: number;
  draw: () => void;
}
