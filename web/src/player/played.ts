// What a file that plays holds beside the player.
import type { Camera, Motion } from "../api/types";
import type { Taped } from "../lecture/tape";
import type { Drawn } from "../mechanics/forces";

/** A run. */
export interface PlayedRun {
  motion: Motion;
  drawn?: Drawn;
  camera?: Camera;
}

/** A run, or a lecture. */
export type Played = PlayedRun | { lecture: Taped };

/** Where the player's file takes it. `server/src/page/player.rs` looks for the same. */
export const PLACE = '<script type="application/json" id="motion"></script>';
