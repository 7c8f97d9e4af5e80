// The stream of a run: opened, read, and opened again when it breaks.
import { t } from "../core/texts";
import { isHere } from "../engine/here";
import { banner } from "../ui/notice";
import { HereStream } from "./here-stream";

/** Pauses before the stream is opened again, ms; the last one is repeated. */
const RETRY_MS = [500, 1000, 2000, 4000, 8000];

export interface ConnectionHooks {
  /** The address to open; undefined while there is none. */
  url: () => string | undefined;
  opened: () => void;
  text: (text: string) => void;
  blocks: (bytes: Uint8Array) => void;
  /** Asks the server whether the run is still there; resolves when the stream may be opened again. */
  comeBack: () => Promise<"there" | "gone" | "silent">;
  gone: () => Promise<void>;
}

export class Connection {
  private socket: Pick<WebSocket, "close"> | undefined;
  private retry = 0;
  private timer = 0;
  private ended = false;
  /** The banner says that the connection is lost. */
  private missed = false;

  constructor(private readonly hooks: ConnectionHooks) {}

  open(): void {
    const url = this.hooks.url();
    if (url === undefined || this.ended) return;
    this.close();
    const socket = isHere(url) ? new HereStream(url) : new WebSocket(url);
    if (socket instanceof WebSocket) socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.retry = 0;
      if (this.missed) banner(null);
      this.missed = false;
      this.hooks.opened();
    };
    socket.onmessage = (event: MessageEvent<ArrayBuffer | string>) => {
      if (typeof event.data === "string") this.hooks.text(event.data);
      else this.hooks.blocks(new Uint8Array(event.data));
    };
    socket.onclose = () => {
      if (this.socket === socket) this.lost();
    };
  }

  /** Tells the other side something; where nobody listens it is lost. */
  tell(text: string): void {
    if (this.socket instanceof WebSocket && this.socket.readyState === WebSocket.OPEN) this.socket.send(text);
  }

  /** Closes the stream; it may be opened again. */
  close(): void {
    const socket = this.socket;
    this.socket = undefined;
    socket?.close();
  }

  end(): void {
    this.ended = true;
    clearTimeout(this.timer);
    this.close();
  }

  private lost(): void {
    if (this.ended) return;
    const wait = RETRY_MS[Math.min(this.retry, RETRY_MS.length - 1)] ?? 8000;
    this.retry += 1;
    if (this.retry > 1) {
      this.missed = true;
      banner(
        t(
          "The connection to the server is lost. Your text and answers are safe; the simulation comes back by itself.",
        ),
        { label: t("Try now"), run: () => void this.again() },
      );
    }
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.again(), wait);
  }

  private async again(): Promise<void> {
    clearTimeout(this.timer);
    if (this.ended) return;
    const found = await this.hooks.comeBack();
    if (found === "there") this.open();
    else if (found === "gone") {
      this.missed = false;
      this.close();
      await this.hooks.gone();
    } else this.lost();
  }
}
