// The states that arrived, kept for looking back: thinned out evenly when they become many.
import type { SessionState, Vec3 } from "../api/types";

/** More states than these are thinned out: those of five minutes, at ten a second. */
const MAX_STATES = 3000;

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
    if (this.states.length > MAX_STATES)
      this.states = this.states.filter((_, k, all) => k % 2 === 0 || k === all.length - 1);
  }

  copy(): History {
    const other = new History();
    other.states = [...this.states];
    return other;
  }

  clear(): void {
    this.states = [];
  }

  /** The latest state not after `time`. */
  at(time: number): SessionState | undefined {
    return this.states[this.indexAt(time)];
  }

  /** The bodies at `time`, drawn evenly between the two states around it. */
  between(time: number): SessionState | undefined {
    const at = this.indexAt(time);
    const [a, b] = [this.states[at], this.states[at + 1]];
    if (!a || !b || time <= a.time || b.bodies.length !== a.bodies.length) return a;
    const part = (time - a.time) / (b.time - a.time);
    const mix = (p: Vec3, q: Vec3): Vec3 =>
      [0, 1, 2].map((k) => (p[k] ?? 0) + part * ((q[k] ?? 0) - (p[k] ?? 0))) as Vec3;
    return {
      ...a,
      bodies: a.bodies.map((body, k) => {
        const next = b.bodies[k] ?? body;
        return {
          ...body,
          position: mix(body.position, next.position),
          u: mix(body.u, next.u),
          v: mix(body.v, next.v),
          w: mix(body.w, next.w),
        };
      }),
    };
  }

  /** The latest state strictly before `time`. */
  before(time: number): SessionState | undefined {
    let at = this.indexAt(time);
    if ((this.states[at]?.time ?? -1) >= time) at -= 1;
    return this.states[at];
  }

  /** The earliest state strictly after `time`. */
  after(time: number): SessionState | undefined {
    let at = this.indexAt(time);
    if ((this.states[at]?.time ?? Infinity) <= time) at += 1;
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
