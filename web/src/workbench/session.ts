// One live simulation on the server, seen from the page: its state, its past, its connection.
import { api, ApiError, type SessionSource } from "../core/api";
import { announce } from "../core/dom";
import { num, seconds } from "../core/format";
import { between, isNone, none, tidy, type Numbers, type SceneView, type Then } from "../core/numbers";
import type { Pull, SessionState } from "../core/types";
import { banner } from "../ui/notice";
import { History } from "./history";
import { Teller, type Drawn, type Told } from "./told";

/** Between two states of a running session, s. */
const STATE_INTERVAL = 0.1;
const RETRY_MS = [500, 1000, 2000, 4000, 8000];

export class Session extends Teller {
  /** The newest state that the server reported. */
  latest: SessionState | undefined;
  readonly past = new History();
  speed = 1;
  /** Name of the selected joint. */
  joint: string | null = null;
  /** How reactions are told: on which body, about which point, in which frame. */
  told: Told = { on: "j", about: "joint", in: "world" };
  /** Which forces are drawn. */
  drawn: Drawn = { what: "joint" };
  /** What is shown instead of the run: the result of an analysis, at a moment of the wall clock in ms. */
  pose: ((now: number) => SessionState) | undefined;
  /** The scene as it runs, its parameters, and the author's. */
  view: SceneView | undefined;
  /** What differs from the author's scene. */
  numbers: Numbers;
  /** Numbers were changed, or a body was pulled, in the middle of this run: from its start it would go otherwise. */
  bent = false;
  private before: Numbers[] = [];
  private seenChanges = -1;
  private waiters: (() => void)[] = [];
  private cursor: number | null = null;
  private cameAt = 0;
  private socket: WebSocket | undefined;
  private retry = 0;
  private timer = 0;
  private closed = false;
  private busy = false;
  /** The page says that the connection is lost. */
  private missed = false;

  constructor(readonly source: SessionSource, start?: Numbers) {
    super();
    this.numbers = start ?? none();
    addEventListener("pagehide", this.drop);
  }

  /** What the page shows: the newest state, or the one under the cursor. */
  get shown(): SessionState | undefined {
    if (this.cursor === null) return this.latest;
    return this.past.at(this.cursor) ?? this.latest;
  }

  /** True while the page looks at a time before the newest one. */
  get reviewing(): boolean {
    return this.cursor !== null;
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
    const state = this.latest;
    if (!state?.playing || this.cursor !== null) return this.time;
    const since = (performance.now() - this.cameAt) / 1000;
    return state.time - state.speed * Math.max(0, STATE_INTERVAL - since);
  }

  async start(): Promise<void> {
    try {
      this.take(await this.create());
      this.connect();
    } catch (error) {
      this.emit("problem", error);
    }
  }

  private create(): Promise<SessionState> {
    return api.createSession(this.source, isNone(this.numbers) ? undefined : this.numbers);
  }

  get canUndo(): boolean {
    return this.before.length > 0;
  }

  /** Runs the scene with these deviations from what its author wrote. Throws what the server refuses. */
  async change(to: Numbers, then?: Then): Promise<void> {
    const from = this.numbers;
    if (await this.put(to, then)) this.before.push(from);
    await this.readScene();
  }

  async undo(): Promise<void> {
    const to = this.before.pop();
    if (!to) return;
    await this.put(to);
    await this.readScene();
  }

  private async put(to: Numbers, then?: Then): Promise<boolean> {
    const view = this.view;
    const id = this.latest?.id;
    if (!view || !id) return false;
    let sent = none();
    await this.alone(async () => {
      sent = between(this.numbers, to, view);
      if (isNone(sent)) return;
      this.cursor = null;
      this.take(await api.change(id, sent, then));
      this.numbers = tidy(to, view);
      this.bent = (this.latest?.time ?? 0) > 0;
    });
    return !isNone(sent);
  }

  /** Pulls a body, or lets it go. */
  async pull(pull: Pull | null): Promise<void> {
    const id = this.latest?.id;
    if (!id) return;
    await this.alone(async () => {
      this.cursor = null;
      this.take(pull ? await api.pull(id, pull) : await api.release(id));
      this.bent = true;
    });
  }

  /** Waits for its turn instead of being dropped, as a request by a key may be. */
  private async alone(request: () => Promise<void>): Promise<void> {
    while (this.busy) await new Promise<void>((done) => this.waiters.push(done));
    this.busy = true;
    try {
      await request();
    } finally {
      this.free();
    }
  }

  private free(): void {
    this.busy = false;
    for (const done of this.waiters.splice(0)) done();
  }

  private async readScene(): Promise<void> {
    const state = this.latest;
    if (!state || state.changes === this.seenChanges) return;
    this.seenChanges = state.changes;
    try {
      this.view = await api.sceneOf(state.id);
      this.emit("scene");
    } catch {
      // The run goes on without its panel of numbers; the next change asks again.
      this.seenChanges = -1;
    }
  }

  close(): void {
    this.drop();
    removeEventListener("pagehide", this.drop);
    banner(null);
  }

  play(): Promise<void> {
    this.cursor = null;
    this.setPose(undefined);
    const finished = this.latest?.finished === true;
    return this.ask(async (id) => {
      if (finished) {
        this.past.clear();
        await api.reset(id);
      }
      return api.play(id, this.speed);
    });
  }

  async pause(): Promise<void> {
    await this.ask((id) => api.pause(id));
    this.tell();
  }

  toggle(): Promise<void> {
    return this.latest?.playing ? this.pause() : this.play();
  }

  async step(by: { steps: number } | { seconds: number }): Promise<void> {
    this.cursor = null;
    await this.ask((id) => api.step(id, by));
    this.tell();
  }

  async reset(): Promise<void> {
    this.cursor = null;
    await this.ask(async (id) => {
      const state = await api.reset(id);
      this.past.clear();
      return state;
    });
    announce("Back at the start, time 0.");
  }

  setSpeed(speed: number): void {
    this.speed = speed;
    if (this.latest?.playing) void this.ask((id) => api.play(id, speed));
  }

  /** Looks at an earlier time without computing anything again. */
  seek(time: number): void {
    const newest = this.latest?.time ?? 0;
    this.cursor = time >= newest ? null : Math.max(0, time);
    this.emit("shown");
  }

  /** Runs up to a time ahead, or looks back at an earlier one. */
  async goTo(time: number): Promise<void> {
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

  /** One recorded moment back. */
  back(): void {
    const before = this.past.before(this.time);
    if (before) this.seek(before.time);
  }

  /** Selects a joint in every view; null selects none. */
  select(joint: string | null): void {
    if (this.joint === joint) return;
    this.joint = joint;
    this.emit("selected");
  }

  /** Tells reactions in another way, in every view. */
  tellAs(change: Partial<Told>): void {
    this.told = { ...this.told, ...change };
    this.emit("told");
  }

  draw(drawn: Drawn): void {
    this.drawn = drawn;
    this.emit("told");
  }

  setPose(pose: Session["pose"]): void {
    if (this.pose === pose) return;
    this.pose = pose;
    this.emit("shown");
  }

  fitScale(): void {
    this.emit("fit");
    this.emit("told");
  }

  /** Opens the stream anew: the server sends the recording from its beginning. */
  resubscribe(): void {
    if (this.closed || !this.latest) return;
    this.connect();
  }

  private async ask(request: (id: string) => Promise<SessionState>): Promise<void> {
    const id = this.latest?.id;
    if (!id || this.busy) return;
    this.busy = true;
    try {
      this.take(await request(id));
    } catch (error) {
      if (error instanceof ApiError && error.gone) await this.recreate();
      else this.emit("problem", error);
    } finally {
      this.free();
    }
  }

  private take(state: SessionState): void {
    const before = this.latest;
    this.cameAt = performance.now();
    if (before && state.id === before.id && state.time < before.time) {
      this.past.clear();
      this.cursor = null;
      this.bent = false;
    }
    this.latest = state;
    this.past.add(state);
    if (state.changes !== this.seenChanges && !this.busy) void this.readScene();
    this.emit("shown");
    if (state.error && !before?.error) this.emit("problem", state.error);
    if (state.finished && before && !before.finished) this.tell();
  }

  private connect(): void {
    const id = this.latest?.id;
    if (!id || this.closed) return;
    this.disconnect();
    const socket = new WebSocket(api.streamUrl(id));
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.retry = 0;
      if (this.missed) banner(null);
      this.missed = false;
      this.emit("opened");
    };
    socket.onmessage = (event: MessageEvent<ArrayBuffer | string>) => {
      if (typeof event.data === "string") this.read(event.data);
      else this.emit("blocks", new Uint8Array(event.data));
    };
    socket.onclose = () => {
      if (this.socket === socket) this.lost();
    };
  }

  private read(text: string): void {
    const message = JSON.parse(text) as { type?: string } & SessionState;
    if (message.type === "reset") this.emit("opened");
    if (message.type !== "state") return;
    // A step asked for by HTTP may overtake its own echo on the socket.
    if (this.busy) return;
    this.take(message);
  }

  private lost(): void {
    if (this.closed) return;
    const wait = RETRY_MS[Math.min(this.retry, RETRY_MS.length - 1)] ?? 8000;
    this.retry += 1;
    if (this.retry > 1) {
      this.missed = true;
      banner("The connection to the server is lost. Your text and answers are safe; the simulation comes back by itself.", { label: "Try now", run: () => void this.comeBack() });
    }
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.comeBack(), wait);
  }

  private async comeBack(): Promise<void> {
    clearTimeout(this.timer);
    const id = this.latest?.id;
    if (!id || this.closed) return;
    try {
      this.take(await api.session(id));
      this.connect();
    } catch (error) {
      if (error instanceof ApiError && error.gone) await this.recreate();
      else this.lost();
    }
  }

  /** The server forgot the session (it expired, or the server restarted): a fresh one takes its place. */
  private async recreate(): Promise<void> {
    this.disconnect();
    this.past.clear();
    this.cursor = null;
    this.missed = false;
    try {
      this.latest = undefined;
      this.take(await this.create());
      this.connect();
      announce("The simulation had expired on the server and was started anew, at time 0.");
      banner("The simulation had expired on the server. A fresh one stands at time 0.", { label: "Fine", run: () => banner(null) });
    } catch (error) {
      this.emit("problem", error);
    }
  }

  private tell(): void {
    const state = this.shown;
    if (!state) return;
    const lead = state.finished ? "The run is complete" : "Paused";
    const body = state.bodies[0];
    const where = body ? ` ${body.name} at ${body.position.map((x) => num(x, 3)).join(", ")} metres.` : "";
    announce(`${lead} at ${seconds(state.time)} after ${state.steps} steps. Energy ${num(state.energy, 5)} joules, constraint violation ${num(state.position_violation, 2)}.${where}`);
  }

  private disconnect(): void {
    const socket = this.socket;
    this.socket = undefined;
    socket?.close();
  }

  private drop = (): void => {
    this.closed = true;
    clearTimeout(this.timer);
    this.disconnect();
    if (this.latest) api.dropSession(this.latest.id);
  };
}
