// What a picture of a run is made from: a live session, or a run that was recorded.
import type { Camera, SessionState } from "../api/types";
import type { Drawn, ReactionConvention, Traced } from "./events";
import type { Ghost } from "./ghost";

export interface Watched {
  /** The newest state: its time is how far the run has come. */
  readonly latest: SessionState | undefined;
  readonly past: { readonly all: readonly SessionState[] };
  readonly joint: string | null;
  readonly convention: ReactionConvention;
  readonly drawn: Drawn;
  readonly camera: Camera;
  /** What is shown in place of the run. */
  readonly pose: unknown;
  /** The points that leave traces, and another run behind this one. */
  readonly traced?: Traced;
  readonly ghost?: Ghost | undefined;
  /** Whether what is shown goes on by itself. */
  readonly moving: boolean;
  /** The mechanism as it was at a time. */
  moment(time: number): SessionState | undefined;
}
