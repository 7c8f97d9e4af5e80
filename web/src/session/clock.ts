// What a run has shown so far, and which moment of it the page shows: now, an earlier one, or a replay.

import type { SessionState } from "../api/types";
import { announce } from "../core/dom";
import { num, seconds } from "../core/format";
import { t } from "../core/texts";
import type { Pose } from "../mechanics/pose";
import { Emitter, type Traced } from "./events";
import type { Ghost } from "./ghost";
import { endedBy } from "./happened";
import { History } from "./history";
import { type Mark, onward } from "./slow";
import { Track } from "./track";

/** Between two states of a running session, s. */
const STATE_INTERVAL = 0.1;
/** Between two moments of a replay that tables and plots see, ms. */
const REPLAY_MS = 50;

export class Clock extends Emitter {
  /** The newest state that the server reported. */
  latest: SessionState | undefined;
  readonly past = new History();
  /** The motion between the states, frame by frame. */
  readonly track = new Track();
  speed = 1;
  /** A replay that has come to its end begins again. */
  loop = false;
  /** What is shown instead of the run, until that is looked at again: the result of an analysis. */
  pose: Pose | undefined;
  /** The points that leave traces. */
  traced: Traced = "none";
  /** Another run that is seen behind this one. */
  ghost: Ghost | undefined;
  /** What is marked on the time line; a replay goes slowly there. */
  marks: readonly Mark[] = [];
  protected cursor: number | null = null;
  protected cameAt = 0;
  private replay: { since: number; from: number; timer: number } | undefined;

  /** What the page shows: the newest state, or the one under the cursor. */
  get shown(): SessionState | undefined {
    if (this.cursor === null) return this.latest;
    return this.past.at(this.cursor) ?? this.latest;
  }

  /** The latest moment that is recorded and not after the time that is shown, nothing between two of them: for numbers. */
  get lastRecorded(): SessionState | undefined {
    const state = this.shown;
    if (this.cursor === null || !state) return state;
    const time = this.track.before(this.cursor);
    return time !== undefined && time > state.time ? (this.track.at(time, state) ?? state) : state;
  }

  /** True while the page looks at a time before the newest one. */
  get reviewing(): boolean {
    return this.cursor !== null;
  }

  /** True while what is shown goes on by itself. */
  get moving(): boolean {
    return this.replay !== undefined || (this.latest?.playing === true && this.cursor === null);
  }

  get replaying(): boolean {
    return this.replay !== undefined;
  }

  /** The time under the cursor, s. */
  get time(): number {
    return this.cursor ?? this.latest?.time ?? 0;
  }

  /**
   * The time to draw at, s. While time runs, states come ten times a second: the picture follows one
   * interval behind and moves evenly between them.
   */
  get smoothTime(): number {
    if (this.replay) return Math.min(this.replayed(this.replay), this.latest?.time ?? 0);
    const state = this.latest;
    if (!state?.playing || this.cursor !== null) return this.time;
    const since = (performance.now() - this.cameAt) / 1000;
    return state.time - state.speed * Math.max(0, STATE_INTERVAL - since);
  }

  /** The mechanism as it was at a time that the run has passed. */
  moment(time: number): SessionState | undefined {
    const state = this.past.at(time) ?? this.latest;
    if (!state || state.time === time) return state;
    return this.track.at(time, state) ?? this.past.between(time);
  }

  /** Looks at an earlier time without computing anything again: the run is what is shown then, no analysis. */
  seek(time: number): void {
    this.endReplay();
    this.pose = undefined;
    const newest = this.latest?.time ?? 0;
    this.cursor = time >= newest ? null : Math.max(0, time);
    this.emit("shown");
  }

  /** One recorded moment back. */
  back(): void {
    const before = this.past.before(this.time);
    if (before) this.seek(before.time);
  }

  /** One recorded moment on; false at the newest. */
  onward(): boolean {
    const after = this.cursor === null ? undefined : this.past.after(this.cursor);
    if (after) this.seek(after.time);
    return after !== undefined;
  }

  /** Shows what is recorded from a time on, at the speed of the page. */
  protected startReplay(from: number): void {
    this.endReplay();
    this.cursor = from;
    this.replay = {
      since: performance.now(),
      from,
      timer: window.setInterval(() => this.replayOn(), REPLAY_MS),
    };
    this.emit("shown");
  }

  protected endReplay(): void {
    if (!this.replay) return;
    clearInterval(this.replay.timer);
    this.replay = undefined;
  }

  private replayed(replay: { since: number; from: number }): number {
    const passed = ((performance.now() - replay.since) / 1000) * this.speed;
    return onward(replay.from, passed, this.marks, this.latest?.time ?? 0);
  }

  private replayOn(): void {
    const replay = this.replay;
    const newest = this.latest?.time ?? 0;
    if (!replay) return;
    const time = this.replayed(replay);
    [replay.from, replay.since] = [time, performance.now()];
    if (time < newest) {
      this.cursor = time;
      this.emit("shown");
    } else if (this.loop) this.startReplay(0);
    else {
      this.endReplay();
      this.cursor = null;
      this.replayEnded();
      this.emit("shown");
    }
  }

  /** A replay has reached the newest state. */
  protected replayEnded(): void {
    this.announceState();
  }

  setSpeed(speed: number): void {
    const replay = this.replay;
    if (replay) {
      replay.from = this.replayed(replay);
      replay.since = performance.now();
    }
    this.speed = speed;
  }

  trace(traced: Traced): void {
    this.traced = traced;
    this.emit("view");
  }

  showGhost(ghost: Ghost | undefined): void {
    this.ghost = ghost;
    this.emit("view");
  }

  mark(marks: readonly Mark[]): void {
    this.marks = marks;
    this.emit("view");
  }

  /** The run as far as it has come. */
  copy(): { past: History; track: Track } {
    return { past: this.past.copy(), track: this.track.copy() };
  }

  setPose(pose: Pose | undefined): void {
    if (this.pose === pose) return;
    this.pose = pose;
    this.emit("shown");
  }

  /** Announces the state that is shown to screen readers. */
  protected announceState(): void {
    const state = this.shown;
    if (!state) return;
    const ended = endedBy(state);
    const complete = ended ? t("“{name}” ended the run", { name: ended.name }) : t("The run is complete");
    const lead = state.finished ? complete : t("Paused");
    const body = state.bodies[0];
    const where = body
      ? ` ${t("{name} at {position} metres.", { name: body.name, position: body.position.map((x) => num(x, 3)).join(", ") })}`
      : "";
    const quality = t("Energy {energy} joules, constraint violation {position_violation}.", {
      energy: num(state.energy, 5),
      position_violation: num(state.position_violation, 2),
    });
    announce(
      t("{lead} at {time} after {steps} steps. {quality}{where}", {
        lead,
        time: seconds(state.time),
        steps: state.steps,
        quality,
        where,
      }),
    );
  }
}
