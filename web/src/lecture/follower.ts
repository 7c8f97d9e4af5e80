// The session of a follower: it mirrors the presenter's run, until the follower looks around alone.

import { ApiError, api } from "../api/client";
import type { LectureState, SessionState } from "../api/types";
import { announce } from "../core/dom";
import { t } from "../core/texts";
import { Session } from "../session/session";
import { applyView } from "../session/share";
import { parseView } from "../session/shared-view";
import { type AnalysisView, analysisIn } from "./analysis-view";

export class Follower extends Session {
  override readonly controls = false;
  lecture: LectureState | undefined;
  /** Looks around alone: time, selection and panels are one's own until one comes back. */
  roaming = false;
  over = false;
  /** A hand is raised; the presenter learns how many, not whose. */
  hand = false;
  /** How often the presenter had put down all hands when ours was raised. */
  private lowered = 0;
  /** What the presenter looks at changes the inspector's panel too. */
  panel: ((key: string) => void) | undefined;

  /** `screen` is the window that the hall sees: it follows, and is no follower. */
  constructor(
    readonly code: string,
    private readonly screen = false,
  ) {
    super({ builtin: "" });
    // A stream that was opened anew has to be told again.
    this.on("opened", () => this.tell());
  }

  /** The presenter looks at the result of an analysis, not at the run. */
  get analysis(): AnalysisView | undefined {
    return analysisIn(this.lecture?.view, this.latest?.bodies.length ?? 0);
  }

  raise(hand: boolean): void {
    this.hand = hand;
    this.lowered = this.lecture?.lowered ?? 0;
    this.tell();
    this.emit("lecture");
    announce(hand ? t("Your hand is raised; the presenter sees how many are.") : t("Your hand is down."));
  }

  private tell(): void {
    const { roaming, hand, screen } = this;
    this.connection.tell(JSON.stringify({ roaming, hand, screen }));
  }

  override start(): Promise<void> {
    this.connection.open();
    return Promise.resolve();
  }

  protected override stream(): string {
    return `/api/v1/rooms/${encodeURIComponent(this.code)}/stream`;
  }

  /** Goes on alone from what is shown. */
  roam(): void {
    if (this.roaming) return;
    this.roaming = true;
    this.tell();
    announce(t("You look around on your own. The lecture goes on; come back whenever you like."));
    this.emit("lecture");
  }

  /** Comes back to what the presenter shows. */
  comeBackToLecture(): void {
    this.roaming = false;
    this.tell();
    this.toNewest();
    this.mirror();
    this.emit("lecture");
    this.emit("shown");
    announce(t("You see what the presenter shows."));
  }

  protected override read(message: { type?: string }): void {
    if (message.type === "room") {
      this.lecture = message as unknown as LectureState;
      if (!this.roaming) this.mirror();
      if (this.hand && this.lecture.lowered > this.lowered) this.raise(false);
      this.emit("lecture");
    } else if (message.type === "closed") {
      this.over = true;
      this.connection.end();
      this.emit("lecture");
    } else super.read(message);
  }

  protected override accept(state: SessionState): void {
    const first = this.latest === undefined;
    super.accept(state);
    if (first && !this.roaming) this.mirror();
  }

  private mirror(): void {
    const seen = parseView(this.lecture?.view);
    if (!seen || !this.latest) return;
    applyView(this, seen);
    if (seen.panel) this.panel?.(seen.panel);
    // The presenter looks back: so does everybody. Otherwise the newest state is shown as it comes.
    if (seen.back && seen.time !== undefined) super.seek(seen.time);
    else {
      this.toNewest();
      this.emit("shown");
    }
    this.setPose(this.analysis?.pose);
  }

  override seek(time: number): void {
    this.roam();
    super.seek(time);
  }

  override select(joint: string | null): void {
    super.select(joint);
  }

  override play(): Promise<void> {
    if (this.reviewing) this.startReplay(this.cursor ?? 0);
    return Promise.resolve();
  }

  override pause(): Promise<void> {
    this.seek(this.time);
    // At the newest moment there is nothing to look back to: the picture stops here all the same.
    this.cursor ??= this.latest?.time ?? 0;
    this.emit("shown");
    this.announceState();
    return Promise.resolve();
  }

  override step(): Promise<void> {
    return Promise.resolve();
  }

  override async forward(): Promise<void> {
    this.onward();
  }

  override reset(): Promise<void> {
    this.seek(0);
    return Promise.resolve();
  }

  override goTo(time: number): Promise<void> {
    this.seek(time);
    return Promise.resolve();
  }

  protected override replayEnded(): void {
    this.emit("shown");
  }

  protected override async comeBack(): Promise<"there" | "gone" | "silent"> {
    try {
      this.lecture = await api.lecture(this.code);
      return "there";
    } catch (error) {
      return error instanceof ApiError && error.gone ? "gone" : "silent";
    }
  }

  protected override recreate(): Promise<void> {
    this.over = true;
    this.connection.end();
    this.emit("lecture");
    return Promise.resolve();
  }
}
