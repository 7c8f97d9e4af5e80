// What was asked of a run and is not done yet: one thing at a time, in the order in which it was pressed.

/** What is asked for: a press of a button or a key, or a change that its caller waits for. */
export type Kind = "play" | "pause" | "step" | "reset" | "camera" | "change";

interface Press {
  kind: Kind;
  request: () => Promise<void>;
  /** It was done, or another one has taken its place. */
  done: () => void;
  failed: (error: unknown) => void;
}

/** Steps that wait; nobody presses so often before one is done. */
const MOST_STEPS = 100;

/** A later one of the same group takes the place of one that still waits at the end. */
const LAST_WINS: readonly (readonly Kind[])[] = [["play", "pause"], ["camera"]];

export class Presses {
  private waiting: Press[] = [];
  private current: Press | undefined;

  /** `ready` tells whether there is a run to ask. */
  constructor(private readonly ready: () => boolean) {}

  /** Whether a request is under way. */
  get busy(): boolean {
    return this.current !== undefined;
  }

  /** Whether anything is under way or waits. */
  get pending(): boolean {
    return this.busy || this.waiting.length > 0;
  }

  /** Steps are pressed faster than they can ever be done. */
  get full(): boolean {
    return this.waiting.filter(({ kind }) => kind === "step").length >= MOST_STEPS;
  }

  /** Whether the run will play once all is done that was pressed; undefined where nothing pressed says so. */
  get plays(): boolean | undefined {
    const all = this.current ? [this.current, ...this.waiting] : this.waiting;
    const last = all.findLast(({ kind }) => kind === "play" || kind === "pause" || kind === "reset");
    return last && last.kind === "play";
  }

  /** Whether the run will be set back to its start. */
  get resets(): boolean {
    return this.current?.kind === "reset" || this.waiting.some(({ kind }) => kind === "reset");
  }

  /** Asks as soon as it is its turn. Resolves when it is done, or when a later press makes it pointless; rejects as `request` does. */
  add(kind: Kind, request: () => Promise<void>): Promise<void> {
    return new Promise((done, failed) => {
      // From the start on nothing of what was to come before is seen.
      if (kind === "reset") this.drop(({ kind }) => kind !== "camera" && kind !== "change");
      const last = this.waiting.at(-1);
      if (last && LAST_WINS.some((group) => group.includes(kind) && group.includes(last.kind)))
        this.waiting.pop()?.done();
      this.waiting.push({ kind, request, done, failed });
      this.go();
    });
  }

  /** Asks for what waits, if there is a run that may be asked. */
  go(): void {
    if (this.current || !this.ready()) return;
    this.current = this.waiting.shift();
    if (this.current) void this.run(this.current);
  }

  private async run({ request, done, failed }: Press): Promise<void> {
    try {
      await request();
      this.current = undefined;
      done();
    } catch (error) {
      this.current = undefined;
      failed(error);
    }
    this.go();
  }

  /** What is under way was refused, and its reason is shown: what was to follow it is not asked for, up to a reset. */
  refused(): void {
    const reset = this.waiting.find(({ kind }) => kind === "reset");
    const before = reset ? this.waiting.indexOf(reset) : this.waiting.length;
    this.drop(({ kind }, at) => at < before && kind !== "camera" && kind !== "change");
  }

  private drop(which: (press: Press, at: number) => boolean): void {
    const all = this.waiting;
    const dropped = all.filter(which);
    this.waiting = all.filter((press) => !dropped.includes(press));
    for (const press of dropped) press.done();
  }
}
