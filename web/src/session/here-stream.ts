// The stream of a run that the engine in this page computes, in the words of a WebSocket.
import { listenHere } from "../engine/here";

export class HereStream {
  onopen: (() => void) | null = null;
  onmessage: ((event: MessageEvent<ArrayBuffer | string>) => void) | null = null;
  onclose: (() => void) | null = null;
  private readonly end: () => void;

  constructor(url: string) {
    const run = /here-\d+/.exec(url)?.[0] ?? "";
    const message = (data: ArrayBuffer | string): void =>
      this.onmessage?.(new MessageEvent("message", { data }));
    // Whoever opens it sets its listeners first.
    queueMicrotask(() => this.onopen?.());
    this.end = listenHere(run, {
      text: message,
      block: (bytes) => message(bytes.slice().buffer),
      gone: () => this.onclose?.(),
    });
  }

  close(): void {
    this.end();
  }
}
