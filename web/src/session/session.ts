// One live simulation on the server, steered from the page.

import { ApiError, api, type SessionSource } from "../api/client";
import { between, isNone, type Numbers, none, tidy } from "../api/numbers";
import { computedHere } from "../api/place";
import type { AfterChange, Camera, Drag, Drawing, SessionScene, SessionState } from "../api/types";
import { announce } from "../core/dom";
import { seconds } from "../core/format";
import { t } from "../core/texts";
import { banner } from "../ui/notice";
import { Clock } from "./clock";
import { Connection } from "./connection";
import type { Drawn, ReactionConvention } from "./events";
import { shareLists } from "./happened";
import { type Kind, Presses } from "./presses";

export class Session extends Clock {
  /** Name of the selected joint. */
  joint: string | null = null;
  /** Key of the plot that was chosen; none until one is. */
  plot: string | undefined;
  /** The convention for reactions: on which body, about which point, in which frame. */
  convention: ReactionConvention = { on: "j", about: "joint", in: "world" };
  /** Which forces are drawn. */
  drawn: Drawn = { what: "all" };
  camera: Camera = "corner";
  /** The scene as it runs, its parameters, and the author's. */
  view: SessionScene | undefined;
  /** What differs from the author's scene. */
  numbers: Numbers;
  /** Numbers were changed, or a body was dragged, in the middle of this run: from its start it would move differently. */
  altered = false;
  /** The stream brings the recording for the 3-D viewer, not the numbers for the drawing. */
  private recorded = false;
  /** Whether this page controls the run; a follower of a lecture only watches. */
  readonly controls: boolean = true;
  protected readonly connection: Connection;
  /** Numbers to which `undo` goes back, the latest last. */
  private before: Numbers[] = [];
  /** Session and number of changes for which the scene was read. */
  private seenChanges = "";
  /** What is asked for before the run may go on; none if it may. */
  private gate: (() => void) | undefined;
  /** What was pressed waits for the run, and for what was pressed before. */
  private readonly presses = new Presses(() => this.address !== undefined && !this.renewing);
  /** The run was gone and begins anew. */
  private renewing = false;
  private redrawing: "idle" | "busy" | "again" = "idle";
  /** The arrows that the server draws, as JSON. */
  private drawnAs = JSON.stringify({ on: "j", about: "joint", drawn: "all", marked: null });

  constructor(
    readonly source: SessionSource,
    start?: Numbers,
  ) {
    super();
    this.numbers = start ?? none();
    this.connection = new Connection({
      url: () => this.streamUrl(),
      opened: () => this.begun(),
      blocks: (bytes) => (this.recorded ? this.emit("blocks", bytes) : this.track.add(bytes)),
      text: (text) => this.read(JSON.parse(text) as { type?: string }),
      comeBack: () => this.comeBack(),
      gone: () => this.recreate(),
    });
    addEventListener("pagehide", this.drop);
  }

  /** Whether the engine in this page computes the run: nobody else can follow it, and there is no recording for a viewer. */
  get here(): boolean {
    return this.controls && computedHere();
  }

  /** The run's address, once there is one. */
  get address(): string | undefined {
    return this.latest?.links.self;
  }

  async start(): Promise<void> {
    try {
      this.accept(await this.create());
      this.connection.open();
    } catch (error) {
      this.emit("problem", error);
    }
  }

  protected create(): Promise<SessionState> {
    return api.createSession(this.source, isNone(this.numbers) ? undefined : this.numbers);
  }

  /** The address of the stream, without what is asked of it. */
  protected stream(): string | undefined {
    return this.latest?.links.stream;
  }

  private streamUrl(): string | undefined {
    const stream = this.stream();
    return stream && api.streamUrl(this.recorded ? `${stream}?recording=true` : stream);
  }

  /** The motion follows from its beginning. */
  private begun(): void {
    this.emit("parting");
    this.track.clear();
    this.emit("opened");
  }

  /** Whether something that was pressed is not done yet. */
  get pending(): boolean {
    return this.presses.pending;
  }

  /** Whether the run waits for something. */
  get held(): boolean {
    return this.gate !== undefined;
  }

  /** Holds the run, and hides its forces, which would tell: whoever wants it to go on is asked for something first. */
  hold(ask: () => void): void {
    this.gate = ask;
    this.draw({ what: "none" });
  }

  /** Asks for what the run waits for; false where it waits for nothing. */
  asked(): boolean {
    this.gate?.();
    return this.held;
  }

  /** Lets the run go on. */
  release(): void {
    if (!this.gate) return;
    this.gate = undefined;
    this.draw({ what: "all" });
  }

  get canUndo(): boolean {
    return this.before.length > 0;
  }

  /** Runs the scene with these deviations from what its author wrote. Throws what the server refuses. */
  async change(to: Numbers, then?: AfterChange): Promise<void> {
    const from = this.numbers;
    if (await this.put(() => to, then)) this.before.push(from);
    await this.readScene();
  }

  async undo(): Promise<void> {
    // In its turn: the one before may have been undone meanwhile.
    await this.put(
      () => this.before.at(-1),
      undefined,
      () => this.before.pop(),
    );
    await this.readScene();
  }

  /** Asks for numbers in their turn; `done` when the run has them, which a server that does not answer leaves open. */
  private async put(
    wanted: () => Numbers | undefined,
    then?: AfterChange,
    done?: () => void,
  ): Promise<boolean> {
    const view = this.view;
    const run = this.address;
    if (!view || !run) return false;
    let sent = none();
    await this.presses.add("change", async () => {
      const to = wanted();
      if (!to) return;
      sent = between(this.numbers, to, view);
      if (!isNone(sent)) {
        this.changed(await api.change(run, sent, then));
        this.numbers = tidy(to, view);
        this.altered = (this.latest?.time ?? 0) > 0;
      }
      done?.();
    });
    return !isNone(sent);
  }

  /** Pulls a body, or lets it go. */
  async pull(pull: Drag | null): Promise<void> {
    const run = this.address;
    if (!run) return;
    await this.presses.add("change", async () => {
      this.changed(pull ? await api.pull(run, pull) : await api.release(run));
      this.altered = true;
    });
  }

  /** The run goes on changed, from its newest moment: who was looking back, and is not at its start now, is told. */
  private changed(state: SessionState): void {
    const { reviewing, time } = this;
    this.toNewest();
    this.accept(state);
    if (!reviewing || state.time === 0) return;
    const newest = seconds(state.time);
    const said = t("The change acts at the newest moment, {newest}: you were looking back at {time}.", {
      newest,
      time: seconds(time),
    });
    banner(said, { label: t("Fine"), run: () => banner(null) });
  }

  private async readScene(): Promise<void> {
    const state = this.latest;
    const key = state && `${state.id}@${state.changes}@${state.title}`;
    if (!key || key === this.seenChanges) return;
    this.seenChanges = key;
    try {
      this.view = await api.sceneOf(state.links.self);
      this.emit("scene");
    } catch {
      // The run goes on without its numbers; they are read again after the next change.
      this.seenChanges = "";
    }
  }

  close(): void {
    this.drop();
    removeEventListener("pagehide", this.drop);
    banner(null);
  }

  play(): Promise<void> {
    if (this.gate) return Promise.resolve(this.gate());
    this.setPose(undefined);
    const state = this.latest;
    // What is recorded is shown again; only what is not is computed.
    if (state && !this.presses.resets && (this.reviewing || state.finished)) {
      this.startReplay(this.cursor ?? 0);
      return Promise.resolve();
    }
    return this.ask("play", (run) => api.play(run, this.speed));
  }

  protected override replayEnded(): void {
    if (this.latest?.finished) super.replayEnded();
    else void this.play();
  }

  async pause(): Promise<void> {
    if (this.replaying) {
      this.seek(this.time);
      this.announceState();
      return;
    }
    await this.ask("pause", (run) => api.pause(run));
    this.announceState();
  }

  toggle(): Promise<void> {
    const moves = this.replaying || (this.presses.plays ?? this.moving);
    return moves ? this.pause() : this.play();
  }

  async step(by: { steps: number } | { seconds: number }): Promise<void> {
    if (this.gate) return this.gate();
    this.toNewest();
    if (this.presses.full) {
      banner(t("More steps were asked for than can be done: the last one was left out."), {
        label: t("Fine"),
        run: () => banner(null),
      });
      return;
    }
    await this.ask("step", (run) => api.step(run, by));
    this.announceState();
  }

  /** One moment on: the next recorded one while looking back, one step of the integrator otherwise. */
  async forward(): Promise<void> {
    if (!this.onward()) await this.step({ steps: 1 });
  }

  async reset(): Promise<void> {
    this.toNewest();
    await this.ask("reset", async (run) => {
      const state = await api.reset(run);
      this.past.clear();
      return state;
    });
    announce(t("Back at the start, time 0."));
  }

  /** The author's scene from its start. */
  async beginAnew(): Promise<void> {
    try {
      if (!isNone(this.numbers)) await this.change(none(), "restart");
      await this.reset();
    } catch (error) {
      this.emit("problem", error);
    }
  }

  protected toNewest(): void {
    this.endReplay();
    this.cursor = null;
    this.setPose(undefined);
  }

  override setSpeed(speed: number): void {
    super.setSpeed(speed);
    if ((this.presses.plays ?? this.latest?.playing) && !this.reviewing)
      void this.ask("play", (run) => api.play(run, this.speed));
  }

  /** Runs up to a time ahead, or looks back at an earlier one. */
  async goTo(time: number): Promise<void> {
    // Its turn comes when there is a run.
    if (!this.latest) await this.presses.add("change", () => Promise.resolve());
    const state = this.latest;
    if (!state) return;
    if (time <= state.time) {
      this.seek(time);
      return;
    }
    if (state.playing) await this.pause();
    const from = this.latest?.time ?? state.time;
    if (time > from) await this.step({ seconds: Math.min(time, state.duration) - from });
  }

  /** Selects a joint in every view; null selects none. */
  select(joint: string | null): void {
    if (this.joint === joint) return;
    this.joint = joint;
    this.emit("selected");
    void this.redraw(false);
  }

  /** States reactions by another convention, in every view. */
  setConvention(change: Partial<ReactionConvention>): void {
    this.convention = { ...this.convention, ...change };
    this.emit("view");
    void this.redraw(false);
  }

  draw(drawn: Drawn): void {
    this.drawn = drawn;
    this.emit("view");
    void this.redraw(false);
  }

  /** Chooses a plot, in every view. */
  choosePlot(plot: string): void {
    if (this.plot === plot) return;
    this.plot = plot;
    this.emit("view");
  }

  /** Another panel of the inspector is looked at. */
  showPanel(): void {
    this.emit("view");
  }

  fitScale(): void {
    void this.redraw(true);
  }

  lookFrom(camera: Camera): void {
    this.camera = camera;
    this.emit("view");
    if (this.controls) void this.ask("camera", (run) => api.lookFrom(run, camera));
  }

  private arrows(): Pick<Drawing, "on" | "about" | "drawn" | "marked"> {
    const { convention, drawn, joint } = this;
    const which =
      drawn.what === "body"
        ? { body: drawn.body }
        : drawn.what !== "joint"
          ? drawn.what
          : joint === null
            ? ("none" as const)
            : { joint };
    return { on: convention.on, about: convention.about, drawn: which, marked: joint };
  }

  /** Lets the server draw the forces that the page draws: one request at a time, the newest wins. */
  private async redraw(fit: boolean): Promise<void> {
    const run = this.address;
    const arrows = this.arrows();
    const wanted = JSON.stringify(arrows);
    if (!run || !this.controls || (wanted === this.drawnAs && !fit)) return;
    if (this.redrawing !== "idle") {
      this.redrawing = "again";
      return;
    }
    this.redrawing = "busy";
    try {
      const state = await api.draw(run, arrows, fit);
      this.drawnAs = wanted;
      if (this.latest && this.latest.id === state.id)
        this.latest = { ...this.latest, drawing: state.drawing };
      this.emit("view");
    } catch {
      // The drawing and the tables show it already; the next change asks again.
    } finally {
      const again = (this.redrawing as string) === "again";
      this.redrawing = "idle";
      if (again) void this.redraw(false);
    }
  }

  /** Opens the stream anew, with the recording for the 3-D viewer or without: it comes from its beginning. */
  subscribe(recorded: boolean): void {
    this.recorded = recorded;
    if (this.latest) this.connection.open();
  }

  /** Asks the run in its turn: what is pressed before there is one, or while it answers, is not lost. */
  private ask(kind: Kind, request: (run: string) => Promise<SessionState>): Promise<void> {
    return this.presses.add(kind, async () => {
      const run = this.address;
      if (!run) return;
      try {
        this.accept(await request(run));
      } catch (error) {
        if (error instanceof ApiError && error.gone) return this.recreate();
        this.presses.refused();
        this.emit("problem", error);
      }
    });
  }

  protected accept(state: SessionState): void {
    const before = this.latest;
    this.cameAt = performance.now();
    if (before && (state.id !== before.id || state.title !== before.title || state.time < before.time)) {
      this.past.clear();
      this.toNewest();
      this.altered = false;
    }
    shareLists(before, state);
    this.latest = state;
    this.past.add(state);
    if (`${state.id}@${state.changes}@${state.title}` !== this.seenChanges && !this.presses.busy)
      void this.readScene();
    this.emit("shown");
    if (state.error && !before?.error) this.emit("problem", state.error);
    if (state.finished && before && !before.finished) this.announceState();
    this.presses.go();
  }

  protected read(message: { type?: string }): void {
    if (message.type === "reset") this.begun();
    // A step asked for by HTTP may overtake its own echo on the socket.
    if (message.type === "state" && !this.presses.busy) this.accept(message as unknown as SessionState);
  }

  protected async comeBack(): Promise<"there" | "gone" | "silent"> {
    const run = this.address;
    if (!run) return "silent";
    try {
      this.accept(await api.state(run));
      return "there";
    } catch (error) {
      return error instanceof ApiError && error.gone ? "gone" : "silent";
    }
  }

  /** The session is gone (it expired, or its server went): a fresh one takes its place, at the time that was reached. */
  protected async recreate(): Promise<void> {
    // A run that was changed or pulled on its way does not come there again.
    const time = this.altered ? 0 : (this.latest?.time ?? 0);
    this.connection.close();
    this.past.clear();
    this.toNewest();
    this.renewing = true;
    try {
      this.latest = undefined;
      this.drawnAs = "";
      this.accept(await this.create());
      const reached = time > 0 ? await this.runTo(time) : 0;
      this.connection.open();
      void this.redraw(false);
      const there = time > 0 && reached === time;
      announce(
        there
          ? t("The simulation was gone from the server and was started anew, at the time that was reached.")
          : t("The simulation was gone from the server and was started anew, at time {time}.", {
              time: reached,
            }),
      );
      const said = there
        ? t("The simulation was gone from the server. A fresh one stands at the time that was reached.")
        : t("The simulation was gone from the server. A fresh one stands at time {time}.", { time: reached });
      banner(said, {
        label: t("Fine"),
        run: () => banner(null),
      });
    } catch (error) {
      this.emit("problem", error);
    } finally {
      this.renewing = false;
      this.presses.go();
    }
  }

  /** Runs a fresh session up to a time; where it cannot, it stands where it is. The time that it has then. */
  private async runTo(time: number): Promise<number> {
    const run = this.address;
    if (!run) return 0;
    try {
      this.accept(await api.step(run, { seconds: time }));
      return this.latest?.time ?? 0;
    } catch (error) {
      this.emit("problem", error);
      return 0;
    }
  }

  protected drop = (): void => {
    this.connection.end();
    this.endReplay();
    if (this.address && this.controls) api.dropSession(this.address);
  };
}
