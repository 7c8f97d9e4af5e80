// Where bodies were, how they moved and what joints did at every recorded moment, as the server packs them (server/src/stream/track.rs).

import type { SessionState, Vec3 } from "../api/types";
import { unit } from "../mechanics/vec";

/** Numbers before the times of a block. */
const HEAD_BYTES = 16;
const OF_BODY = 21;
const OF_JOINT = 9;
/** Bytes that a page keeps of a run. */
const MOST_BYTES = 48e6;

/** One recorded moment. */
export interface Frame {
  time: number;
  bodies: number;
  joints: number;
  /** Of each body position, u, v, w, velocity, angular velocity, acceleration; then of each joint point, force, moment. */
  numbers: Float32Array;
}

export class Track {
  private frames: Frame[] = [];
  private bytes = 0;

  /** Beyond so many bytes every second frame goes. */
  constructor(private readonly most = MOST_BYTES) {}

  clear(): void {
    this.frames = [];
    this.bytes = 0;
  }

  /** The time of the last frame, s; nothing where there is none. */
  get end(): number | undefined {
    return this.frames.at(-1)?.time;
  }

  /** Between two frames on the average, s; 0 where there are none. */
  get every(): number {
    const [first, last] = [this.frames[0], this.frames.at(-1)];
    return first && last && first !== last ? (last.time - first.time) / (this.frames.length - 1) : 0;
  }

  /** The frames with as many bodies and joints as a state; of more than `most` every second, third … and the last. */
  framesLike(state: SessionState, most: number): readonly Frame[] {
    const [bodies, joints] = [state.bodies.length, state.forces.length];
    const like = this.frames.filter((frame) => frame.bodies === bodies && frame.joints === joints);
    const stride = Math.max(1, Math.ceil(like.length / most));
    return like.filter((_, k) => k % stride === 0 || k === like.length - 1);
  }

  copy(): Track {
    const other = new Track(this.most);
    [other.frames, other.bytes] = [[...this.frames], this.bytes];
    return other;
  }

  /** Adds a block as it came. */
  add(block: Uint8Array): void {
    const view = new DataView(block.buffer, block.byteOffset, block.byteLength);
    if (block.byteLength < HEAD_BYTES) return;
    const [bodies, joints, count] = [0, 4, 8].map((at) => view.getUint32(at, true)) as [
      number,
      number,
      number,
    ];
    const size = OF_BODY * bodies + OF_JOINT * joints;
    if (block.byteLength !== HEAD_BYTES + count * (8 + 4 * size)) return;
    for (let k = 0; k < count; k += 1) {
      const from = HEAD_BYTES + 8 * count + 4 * size * k;
      const numbers = Float32Array.from({ length: size }, (_, j) => view.getFloat32(from + 4 * j, true));
      const time = view.getFloat64(HEAD_BYTES + 8 * k, true);
      // A run that goes on from an earlier time replaces what came after it.
      while ((this.frames.at(-1)?.time ?? -1) >= time) this.frames.pop();
      this.frames.push({ time, bodies, joints, numbers });
    }
    this.bytes += block.byteLength;
    if (this.bytes > this.most) {
      this.frames = this.frames.filter((_, k, all) => k % 2 === 0 || k === all.length - 1);
      this.bytes /= 2;
    }
  }

  /** The motion as one block of at most about so many bytes: every frame, or as many at equal distances as fit. */
  pack(most: number): Uint8Array | undefined {
    const last = this.frames.at(-1);
    if (!last) return undefined;
    const { bodies, joints } = last;
    const same = this.frames.filter((frame) => frame.bodies === bodies && frame.joints === joints);
    const size = OF_BODY * bodies + OF_JOINT * joints;
    const every = Math.max(1, Math.ceil((same.length * (8 + 4 * size)) / most));
    const kept = same.filter((frame, k) => k % every === 0 || frame === last);
    const block = new Uint8Array(HEAD_BYTES + kept.length * (8 + 4 * size));
    const view = new DataView(block.buffer);
    for (const [k, count] of [bodies, joints, kept.length].entries()) view.setUint32(4 * k, count, true);
    for (const [k, { time, numbers }] of kept.entries()) {
      view.setFloat64(HEAD_BYTES + 8 * k, time, true);
      const from = HEAD_BYTES + 8 * kept.length + 4 * size * k;
      for (const [j, number] of numbers.entries()) view.setFloat32(from + 4 * j, number, true);
    }
    return block;
  }

  /** The time of the latest frame not after `time`, s. */
  before(time: number): number | undefined {
    const found = this.frames[this.indexAt(time)]?.time;
    return found !== undefined && found <= time ? found : undefined;
  }

  private indexAt(time: number): number {
    let [low, high] = [0, Math.max(0, this.frames.length - 1)];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if ((this.frames[middle]?.time ?? Infinity) <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** `state` with bodies and forces as they were at `time`; `undefined` where that is not recorded. */
  at(time: number, state: SessionState): SessionState | undefined {
    const { frames } = this;
    const [first, last] = [frames[0], frames.at(-1)];
    if (!first || !last || time < first.time || time > last.time) return undefined;
    const low = this.indexAt(time);
    const a = frames[low] ?? first;
    const b = frames[low + 1] ?? a;
    if (a.bodies !== state.bodies.length || b.bodies !== a.bodies || b.joints !== a.joints) return undefined;
    const part = b.time > a.time ? (time - a.time) / (b.time - a.time) : 0;
    const vector = (at: number): Vec3 => mixed(a.numbers, b.numbers, at, part);
    const bodies = state.bodies.map((body, k) => {
      const at = OF_BODY * k;
      const [u, v, w] = [3, 6, 9].map((off) => unit(vector(at + off))) as [Vec3, Vec3, Vec3];
      const [velocity, angular_velocity, acceleration] = [12, 15, 18].map((off) => vector(at + off)) as [
        Vec3,
        Vec3,
        Vec3,
      ];
      return { ...body, position: vector(at), u, v, w, velocity, angular_velocity, acceleration };
    });
    const known = a.joints === state.forces.length;
    const forces = state.forces.map((entry, k) => {
      const at = OF_BODY * a.bodies + OF_JOINT * k;
      if (!known || Number.isNaN(a.numbers[at] ?? NaN) || Number.isNaN(b.numbers[at] ?? NaN)) return entry;
      return { ...entry, at: vector(at), force: vector(at + 3), moment: vector(at + 6) };
    });
    return { ...state, time, bodies, forces };
  }
}

/** Where a body's numbers begin. */
const PLACES = { position: 0, velocity: 12, angular_velocity: 15, acceleration: 18 };

/** A component of a body's position, m, velocity, m/s, angular velocity, rad/s, or acceleration, m/s². */
export const motionIn = (frame: Frame, body: number, what: keyof typeof PLACES, axis: number): number =>
  frame.numbers[OF_BODY * body + PLACES[what] + axis] ?? NaN;

/** A component of a joint's force, N, or of its moment, N m. */
export const reactionIn = (frame: Frame, joint: number, what: "force" | "moment", axis: number): number =>
  frame.numbers[OF_BODY * frame.bodies + OF_JOINT * joint + (what === "force" ? 3 : 6) + axis] ?? NaN;

function mixed(a: Float32Array, b: Float32Array, at: number, part: number): Vec3 {
  const one = (k: number): number => {
    const [x, y] = [a[at + k] ?? 0, b[at + k] ?? 0];
    return x + part * (y - x);
  };
  return [one(0), one(1), one(2)];
}
