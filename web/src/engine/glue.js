// The engine as JavaScript calls it: requests go into its memory as JSON, messages come out of it. Plain JavaScript, so
// that a test can load it without a build.

const encoder = new TextEncoder();
const decoder = new TextDecoder();
const END_OF_HEAD = "\n".charCodeAt(0);

/** An engine made of a compiled module. */
export class Engine {
  /** @param {WebAssembly.Module} module */
  constructor(module) {
    this.doors = new WebAssembly.Instance(module).exports;
  }

  /** Gives it a request; `now` is a clock's time in s. */
  ask(request, now) {
    const bytes = encoder.encode(JSON.stringify(request));
    const at = this.doors.inbox(bytes.length);
    // The memory may have grown: the view is made anew each time.
    new Uint8Array(this.doors.memory.buffer, at, bytes.length).set(bytes);
    this.doors.ask(now);
  }

  /** Lets it compute for a short spell: 0 if there is nothing to do, 1 if there is more at once, 2 at the next tick. */
  work(now) {
    return this.doors.work(now);
  }

  /** The next message: its head, and the bytes that it carries; undefined if there is none. */
  next() {
    const length = this.doors.next();
    if (length === 0) return undefined;
    const message = new Uint8Array(this.doors.memory.buffer, this.doors.outbox(), length).slice();
    const end = message.indexOf(END_OF_HEAD);
    return { head: JSON.parse(decoder.decode(message.subarray(0, end))), body: message.subarray(end + 1) };
  }
}
