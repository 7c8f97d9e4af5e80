// Processor time of a run in WebAssembly, ms: node --no-liftoff pace.mjs ENGINE.wasm SCENE UNTIL ROUNDS
// With `--no-liftoff` all is compiled well at once, as browsers do by and by. `engine/web/examples/pace.rs` does the same here.
import { readFileSync } from "node:fs";
import { Engine } from "../../web/src/engine/glue.js";

const [file, name, until, rounds] = process.argv.slice(2);
const engine = new Engine(new WebAssembly.Module(readFileSync(file)));
const decoder = new TextDecoder();
function ask(request) {
  engine.ask({ id: 1, ...request }, 0);
  return JSON.parse(decoder.decode(engine.next().body));
}
const scene = ask({ method: "GET", path: `/scenes/${encodeURIComponent(name)}` });
const run = { method: "POST", path: "/steps", body: { scene, overrides: { duration: Number(until) } } };
const steps = ask(run);
ask(run);
const began = process.cpuUsage();
for (let round = 0; round < Number(rounds); round += 1) ask(run);
const { user } = process.cpuUsage(began);
console.log(`${name} to ${until} s: ${(user / 1e3 / Number(rounds)).toFixed(2)} ms, ${steps} steps`);
