// What the address of a frame asks for.
import type { Camera } from "../api/types";
import type { Drawn } from "../mechanics/forces";

const CAMERAS: Camera[] = ["corner", "front", "side", "above"];

/** What the address asks for beside the mechanism. */
export interface EmbedWish {
  drawn: Drawn;
  camera: Camera;
  plays: boolean;
  /** Where it stands at first, s. */
  time: number;
  theme: "light" | "dark" | undefined;
}

/** Reads the part of an address behind the question mark; what is unknown or out of range is as if it were not there. */
export function wishOf(search: string): EmbedWish {
  const asked = new URLSearchParams(search);
  const camera = CAMERAS.find((side) => side === asked.get("from")) ?? "corner";
  const time = Number(asked.get("time") ?? 0);
  const theme = asked.get("theme");
  return {
    drawn: { what: asked.get("forces") === "all" ? "all" : "none" },
    camera,
    plays: asked.get("play") === "1",
    time: Number.isFinite(time) && time > 0 ? time : 0,
    theme: theme === "light" || theme === "dark" ? theme : undefined,
  };
}
