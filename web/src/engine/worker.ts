// The worker that the engine runs in. Between two spells of computing it takes what the page says, so that a pause never
// waits for the end of a long stretch.
import { Engine, type EngineRequest } from "./glue.js";

/** How long the engine computes before the page is listened to, ms. */
const SPELL_MS = 12;
/** Between two ticks of a run that plays, ms. */
const TICK_MS = 33;

let engine: Engine | undefined;
let timer: ReturnType<typeof setTimeout> | undefined;
const early: EngineRequest[] = [];

const now = (): number => performance.now() / 1000;

addEventListener("message", (event: MessageEvent<WebAssembly.Module | EngineRequest>) => {
  if (event.data instanceof WebAssembly.Module) {
    engine = new Engine(event.data);
    for (const request of early.splice(0)) take(engine, request);
  } else if (engine) take(engine, event.data);
  else early.push(event.data);
});

function take(engine: Engine, request: EngineRequest): void {
  engine.ask(request, now());
  tell(engine);
  go(engine, 0);
}

/** Works for a while, then again, as long as there is something to do. */
function go(engine: Engine, after: number): void {
  clearTimeout(timer);
  timer = setTimeout(() => {
    const until = performance.now() + SPELL_MS;
    let left = engine.work(now());
    while (left === 1 && performance.now() < until) left = engine.work(now());
    tell(engine);
    if (left > 0) go(engine, left === 1 ? 0 : TICK_MS);
  }, after);
}

function tell(engine: Engine): void {
  for (let message = engine.next(); message; message = engine.next())
    postMessage(message, { transfer: [message.body.buffer] });
}
