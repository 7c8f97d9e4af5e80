// The paths that points have drawn in space, over the time that the run has covered.

import type { SessionState, Vec3 } from "../api/types";
import type { Traced } from "../session/events";
import type { Watched } from "../session/watched";
import { type Palette, paint } from "./palette";
import type { Pen } from "./pen";
import type { Shown } from "./shown";
import { GROUND, inWorld, type Parts } from "./solids";

/** Between two moments of a path, s: those of a film; closer where the whole run is short. */
const EVERY = 1 / 60;
const LEAST = 300;
/** Points of all paths together; beyond them every second moment goes. */
const MOST = 8000;

interface Followed {
  body: number;
  at(state: SessionState): Vec3;
}

/** The points whose paths are wanted. */
function followed(parts: Parts, state: SessionState, traced: Traced, joint: string | null): Followed[] {
  if (traced === "bodies")
    return state.bodies.map((_, body) => ({ body, at: (s) => inWorld(s, body, [0, 0, 0]) }));
  const points =
    traced === "markers"
      ? parts.markers
      : parts.joints.filter(
          (one) => one.body !== GROUND && (traced === "joints" ? !one.grounded : one.name === joint),
        );
  return points.map(({ body, point }) => ({ body, at: (s) => inWorld(s, body, point) }));
}

export class Traces {
  private samples: { time: number; points: Vec3[] }[] = [];
  private every = EVERY;
  /** What the samples are of. */
  private key = "";
  private parts: Parts | undefined;

  /** Draws what was passed as lines, what comes after the moment that is shown as thin ones. Tells how many points. */
  draw(pen: Pen, shown: Shown, session: Watched): number {
    const traced = session.traced ?? "none";
    if (traced === "none" || session.pose) return 0;
    const points = followed(shown.parts, shown.state, traced, session.joint);
    this.gather(points, shown, session);
    const now = this.samples.findIndex(({ time }) => time > shown.state.time);
    const upTo = now < 0 ? this.samples.length : now;
    for (const [k, { body, at }] of points.entries()) {
      const line = (from: number, to: number): Vec3[] =>
        this.samples.slice(from, to).map((sample) => sample.points[k] ?? at(shown.state));
      const ink = paint(Math.max(0, body), shown.colours).edge;
      const project = (p: Vec3): [number, number] => shown.eye.project(p);
      pen.path(line(Math.max(0, upTo - 1), this.samples.length).map(project), {
        stroke: ink,
        width: 1,
        dash: [2, 4],
        alpha: 0.6,
      });
      pen.path([...line(0, upTo), at(shown.state)].map(project), {
        stroke: ink,
        width: width(shown.colours),
      });
      pen.disc(project(at(shown.state)), 1.8 * width(shown.colours), { fill: ink });
    }
    return points.length * this.samples.length;
  }

  /** Asks the run where the points were, from where it was asked last to where it has come. */
  private gather(points: Followed[], { parts }: Shown, session: Watched): void {
    const { latest } = session;
    if (!latest) return;
    const key = [session.traced, session.joint, latest.id, latest.changes, latest.title, points.length].join(
      "|",
    );
    if (key !== this.key || parts !== this.parts || latest.time < (this.samples.at(-1)?.time ?? 0)) {
      this.samples = [];
      this.every = Math.min(EVERY, latest.duration / LEAST);
    }
    [this.key, this.parts] = [key, parts];
    let time = this.samples.length === 0 ? 0 : (this.samples.at(-1)?.time ?? 0) + this.every;
    for (; time <= latest.time; time += this.every) {
      const state = session.moment(time);
      if (state) this.samples.push({ time, points: points.map(({ at }) => at(state)) });
      if (this.samples.length * points.length <= MOST) continue;
      this.samples = this.samples.filter((_, k) => k % 2 === 0);
      this.every *= 2;
    }
  }
}

const width = (colours: Palette): number => 2 * colours.size;
