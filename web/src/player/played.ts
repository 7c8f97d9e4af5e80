// What a file that plays holds beside the player.
import type { Camera, Motion } from "../api/types";
import type { Drawn } from "../mechanics/forces";

export interface Played {
  motion: Motion;
  drawn?: Drawn;
  camera?: Camera;
}

/** Where the player's file takes it. `server/src/page/player.rs` looks for the same. */
export const PLACE = '<script type="application/json" id="motion"></script>';
