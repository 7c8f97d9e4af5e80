// Another run of the same mechanism, seen behind the one that plays: its author's, or one that was kept.

import type { Scene, SessionState } from "../api/types";

export interface Ghost {
  /** Which run it is, in words. */
  name: string;
  scene: Scene | undefined;
  /** Its first state, which tells where the parts of the bodies are. */
  start: SessionState;
  /** The mechanism as it was at a time; undefined where the run has not come. */
  moment(time: number): SessionState | undefined;
}
