// The states that arrived, kept for looking back: thinned out evenly when they become many.
import type { SessionState } from "../core/types";

const MOST = 3000;

export class History {
  private states: SessionState[] = [];

  get all(): readonly SessionState[] {
    return this.states;
  }

  add(state: SessionState): void {
    const last = this.states.at(-1);
    if (last && state.time < last.time) this.states = [];
    if (last && state.time === last.time) this.states[this.states.length - 1] = state;
    else this.states.push(state);
    // Every second state goes; the first and the last stay.
    if (this.states.length > MOST) this.states = this.states.filter((_, k, all) => k % 2 === 0 || k === all.length - 1);
  }

  clear(): void {
    this.states = [];
  }

  /** The latest state not after `time`. */
  at(time: number): SessionState | undefined {
    return this.states[this.indexAt(time)];
  }

  /** The latest state strictly before `time`. */
  before(time: number): SessionState | undefined {
    let at = this.indexAt(time);
    if ((this.states[at]?.time ?? -1) >= time) at -= 1;
    return this.states[at];
  }

  private indexAt(time: number): number {
    let low = 0;
    let high = this.states.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if ((this.states[middle]?.time ?? Infinity) <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }
}
