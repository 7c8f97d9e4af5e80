/** A request as the server's interface has it; `path` is below /api/v1. */
export interface EngineRequest {
  id: number;
  method: string;
  path: string;
  body?: unknown;
}

/** What a message begins with: an answer's number and status, or the run of which something is streamed. */
export type Head = { answer: number; status: number } | { run: string; binary: boolean };

export declare class Engine {
  constructor(module: WebAssembly.Module);
  ask(request: EngineRequest, now: number): void;
  work(now: number): number;
  next(): { head: Head; body: Uint8Array<ArrayBuffer> } | undefined;
}
