// The engine in this page: started when it is first asked, and again after it failed.

import engineUrl from "virtual:triad-engine";
import { t } from "../core/texts";
import type { EngineRequest, Head } from "./glue.js";

export interface HereAnswer {
  status: number;
  text: string;
}

/** What is streamed of a run: texts as over a WebSocket, and blocks of the motion. */
export interface HereListener {
  text: (text: string) => void;
  block: (bytes: Uint8Array) => void;
  /** The engine failed: its runs are gone. */
  gone: () => void;
}

/** Instructions on vectors, without which the engine does not start: a module with one of them. */
const VECTORS = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98,
  11,
]);

/** Whether this build has the engine, and this browser can run it. */
export const canComputeHere = (): boolean =>
  engineUrl !== undefined && typeof WebAssembly === "object" && WebAssembly.validate(VECTORS);

const decoder = new TextDecoder();

class Here {
  private readonly worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
  private readonly asked = new Map<number, (answer: HereAnswer) => void>();
  private readonly listeners = new Map<string, HereListener>();
  private count = 0;

  constructor(module: WebAssembly.Module) {
    this.worker.addEventListener("message", (event: MessageEvent) => this.receive(event.data));
    this.worker.addEventListener("error", (event) => this.fail(event.message));
    this.worker.postMessage(module);
  }

  ask(method: string, path: string, body: unknown): Promise<HereAnswer> {
    this.count += 1;
    const request: EngineRequest = { id: this.count, method, path, body };
    return new Promise((done) => {
      this.asked.set(request.id, done);
      this.worker.postMessage(request);
    });
  }

  listen(run: string, listener: HereListener): () => void {
    this.listeners.set(run, listener);
    void this.ask("OPEN", `/sessions/${run}`, undefined);
    return () => {
      if (this.listeners.get(run) !== listener) return;
      this.listeners.delete(run);
      void this.ask("CLOSE", `/sessions/${run}`, undefined);
    };
  }

  private receive({ head, body }: { head: Head; body: Uint8Array }): void {
    if ("answer" in head) {
      this.asked.get(head.answer)?.({ status: head.status, text: decoder.decode(body) });
      this.asked.delete(head.answer);
      return;
    }
    const listener = this.listeners.get(head.run);
    if (head.binary) listener?.block(body);
    else listener?.text(decoder.decode(body));
  }

  private fail(why: string): void {
    current = undefined;
    this.worker.terminate();
    const problem = {
      title: t("The engine in this page stopped"),
      status: 500,
      code: "engine-stopped",
      detail: why || t("It ran out of memory, or met a mistake of its own."),
      hint: t("It starts again by itself. If it stops again, let the run be computed on the server."),
    };
    for (const done of this.asked.values()) done({ status: 500, text: JSON.stringify(problem) });
    for (const listener of this.listeners.values()) listener.gone();
  }
}

let current: Promise<Here> | undefined;
let compiled: Promise<WebAssembly.Module> | undefined;

async function fetched(): Promise<WebAssembly.Module> {
  if (engineUrl === undefined) throw new Error(t("this page was built without the engine"));
  const response = await fetch(engineUrl);
  if (!response.ok)
    throw new Error(t("the engine could not be fetched: {status}", { status: response.status }));
  return WebAssembly.compile(await response.arrayBuffer());
}

function started(): Promise<Here> {
  compiled ??= fetched();
  compiled.catch(() => {
    compiled = undefined;
    current = undefined;
  });
  current ??= compiled.then((module) => new Here(module));
  return current;
}

/** Lets the engine in this page answer a request; the path is below /api/v1. */
export async function askHere(method: string, path: string, body: unknown): Promise<HereAnswer> {
  return (await started()).ask(method, path, body);
}

/** Follows a run of this page from its start; the returned function ends that. */
export function listenHere(run: string, listener: HereListener): () => void {
  let end: (() => void) | undefined;
  let ended = false;
  started().then(
    (here) => {
      if (!ended) end = here.listen(run, listener);
    },
    () => listener.gone(),
  );
  return () => {
    ended = true;
    end?.();
  };
}

/** Whether the address of a run, or its name, is one of this page. */
export const isHere = (run: string): boolean => /(?:^|\/)here-\d+(?:$|\/|\?)/.test(run);
