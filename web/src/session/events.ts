// Events of a session and their listeners; the convention for forces.
import type { Drawn } from "../mechanics/forces";

export interface ReactionConvention {
  on: "i" | "j";
  about: "joint" | "center";
  in: "world" | "joint" | "body";
}

export type { Drawn };

/** The points that leave traces. */
export type Traced = "none" | "bodies" | "joints" | "joint" | "markers";

type Events = {
  /** A state arrived, or the cursor moved: what is shown has changed. */
  shown: () => void;
  /** Blocks of the recording for the 3-D viewer, complete in themselves. */
  blocks: (bytes: Uint8Array) => void;
  /** Another joint was selected, in the viewer or in the page. */
  selected: () => void;
  /** What is known of the motion is about to be forgotten. */
  parting: () => void;
  /** A new connection, or a run from the start: the motion follows from its beginning. */
  opened: () => void;
  /** The scene's numbers are known, or were changed. */
  scene: () => void;
  /** Forces are stated or drawn in another way. */
  view: () => void;
  /** A lecture's presenter shows or asks something else. */
  lecture: () => void;
  problem: (error: unknown) => void;
};

/** Calls the listeners. */
export class Emitter {
  private listeners: { [K in keyof Events]: Set<Events[K]> } = {
    shown: new Set(),
    blocks: new Set(),
    parting: new Set(),
    opened: new Set(),
    problem: new Set(),
    selected: new Set(),
    scene: new Set(),
    view: new Set(),
    lecture: new Set(),
  };

  on<K extends keyof Events>(event: K, listener: Events[K]): () => void {
    this.listeners[event].add(listener);
    return () => this.listeners[event].delete(listener);
  }

  protected emit<K extends keyof Events>(event: K, ...what: Parameters<Events[K]>): void {
    for (const listener of this.listeners[event])
      (listener as (...what: Parameters<Events[K]>) => void)(...what);
  }
}
