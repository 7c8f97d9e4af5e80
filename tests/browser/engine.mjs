// The engine of the page, run by Node: answers the requests of a file, one JSON a line, as lines of JSON.
//   node engine.mjs ENGINE.wasm REQUESTS
// Started by tests/tests/page_engine.rs, which compares the answers with those of the same engine built for this machine.
import { readFileSync } from "node:fs";
import { Engine } from "../../web/src/engine/glue.js";

const [file, requests] = process.argv.slice(2);
const engine = new Engine(new WebAssembly.Module(readFileSync(file)));
const decoder = new TextDecoder();

/** Asks, and lets the engine work until the answer is there. */
function answer(request) {
  engine.ask(request, 0);
  for (let left = 1; ; left = engine.work(0)) {
    for (let message = engine.next(); message; message = engine.next())
      if (message.head.answer === request.id) return { status: message.head.status, body: decoder.decode(message.body) };
    if (left === 0) throw new Error(`no answer to ${JSON.stringify(request)}`);
  }
}

for (const line of readFileSync(requests, "utf8").split("\n")) {
  if (line === "") continue;
  const began = process.cpuUsage();
  const found = answer(JSON.parse(line));
  const { user } = process.cpuUsage(began);
  console.log(JSON.stringify({ ...found, ms: user / 1e3 }));
}
