// The page's own drawing, drawn by the processor. Started by tests/tests/browser.rs:
//   node drawing.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// It shows the moment of the clock while it plays, at the end and looking back, also with busy cores; what it costs is
// bounded by numbers; hands and keys turn it, choose a joint and pull a body; it becomes a file.
import assert from "node:assert/strict";
import { join } from "node:path";
import { Worker } from "node:worker_threads";
import { launch, say, until, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
/** Messages and bytes of the stream for 5 s of three bodies: thirty times as many were sent to the viewer. */
const MOST_MESSAGES = 150;
const MOST_BYTES = 1e6;
/** What a page loads before the 3-D viewer is asked for, bytes. */
const MOST_LOADED = 500e3;
/** The clock may be ahead of the picture by this much of the run, s: states come every tenth of a second. */
const BEHIND = 0.2;

/** Processor time of a picture, ms: 25 a second fit into one core. */
const MOST_PER_PICTURE = 40;
/** Processor time of a task, ms: nobody's input waits longer for it. */
const MOST_PER_TASK = 100;

const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
const page = await context.newPage();
page.setDefaultTimeout(60_000);
const complaints = [];
page.on("pageerror", (error) => complaints.push(String(error)));
const stream = { messages: 0, bytes: 0 };
page.on("websocket", (socket) => socket.on("framereceived", ({ payload }) => {
  stream.messages += 1;
  stream.bytes += payload.length;
}));
const drawing = page.locator("canvas.drawing");
/** The moment that is drawn and that of the clock, read at once. */
const times = () => page.evaluate(() => [Number(document.querySelector("canvas.drawing")?.dataset.time), Number(document.querySelector(".clock")?.value)]);

async function plays() {
  const client = await context.newCDPSession(page);
  await client.send("Network.enable");
  let loaded = 0;
  client.on("Network.loadingFinished", ({ encodedDataLength }) => { loaded += encodedDataLength; });
  await page.goto(`${address}/scenes/spatial-slider-crank`);
  await until("the mechanism is drawn", times, ([drawn, clock]) => drawn === 0 && clock === 0);
  assert(loaded < MOST_LOADED, `${loaded} bytes are loaded before anything is asked for`);
  say(`the page with its drawing is ${(loaded / 1e3).toFixed(0)} kB`);
  const frames = page.evaluate(() => new Promise((done) => {
    let count = 0;
    const began = performance.now();
    const next = () => { count += 1; if (performance.now() - began < 4000) requestAnimationFrame(next); else done(count / 4); };
    requestAnimationFrame(next);
  }));
  await page.keyboard.press(" ");
  for (let look = 0; look < 10; look += 1) {
    const [drawn, clock] = await times();
    assert(clock - drawn <= BEHIND && drawn <= clock + 0.001, `the drawing stands at ${drawn} s, the clock at ${clock} s`);
    await page.waitForTimeout(200);
  }
  say(`${(await frames).toFixed(0)} frames a second while it plays`);
  await until("the end of the run", times, ([drawn, clock]) => drawn === 5 && clock === 5);
  say(`5 s of three bodies: ${stream.messages} messages, ${(stream.bytes / 1e6).toFixed(2)} MB`);
  assert(stream.messages < MOST_MESSAGES && stream.bytes < MOST_BYTES, JSON.stringify(stream));
  await page.screenshot({ path: join(pictures, "drawing.png") });
  // Between two states, at a moment that only the frames know.
  await page.locator(".timeline").fill("2.345");
  await until("looking back", times, ([drawn, clock]) => drawn === clock && Math.abs(drawn - 2.345) < 0.051);
}

async function busy() {
  const loops = Array.from({ length: 4 }, () => new Worker("for (;;);", { eval: true }));
  try {
    await page.getByRole("button", { name: "Reset to the start" }).click();
    await until("reset", times, ([drawn, clock]) => drawn === 0 && clock === 0);
    await page.getByRole("button", { name: "Play", exact: true }).click();
    await until("it plays", times, ([, clock]) => clock > 0.2);
    for (let look = 0; look < 5; look += 1) {
      const [drawn, clock] = await times();
      assert(clock - drawn <= BEHIND, `with busy cores the drawing stands at ${drawn} s, the clock at ${clock} s`);
      await page.waitForTimeout(300);
    }
    await page.keyboard.press(" ");
    await until("the pause", times, ([drawn, clock]) => drawn === clock);
  } finally {
    await Promise.all(loops.map((loop) => loop.terminate()));
  }
  say("with four busy loops beside it the drawing is at the moment of the clock");
}

/**
 * What playing and input cost the processor, on whatever else the machine is busy with: the time that each thread ran, not the time
 * that passed. Without a graphics card the picture, its way to the screen included, must leave room for 25 a second; no task may
 * hold the page for longer than an input may wait.
 */
async function costs() {
  const client = await context.newCDPSession(page);
  const traced = [];
  client.on("Tracing.dataCollected", ({ value }) => traced.push(...value));
  await page.getByRole("button", { name: "Reset to the start" }).click();
  await until("reset", times, ([drawn, clock]) => drawn === 0 && clock === 0);
  await page.evaluate(() => {
    window.pictures = 0;
    window.waits = [];
    new MutationObserver((all) => { window.pictures += all.length; })
      .observe(document.querySelector("canvas.drawing"), { attributes: true, attributeFilter: ["data-time"] });
    new PerformanceObserver((list) => { for (const one of list.getEntries()) window.waits.push(one.processingStart - one.startTime); })
      .observe({ type: "event", durationThreshold: 16 });
  });
  await client.send("Tracing.start", { transferMode: "ReportEvents", traceConfig: { includedCategories: ["toplevel", "disabled-by-default-devtools.timeline"] } });
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await until("it plays", times, ([, clock]) => clock > 0.2);
  for (const tab of ["Reactions", "Jacobian", "Plots", "State"]) {
    await page.getByRole("tab", { name: tab }).click();
    await page.waitForTimeout(500);
  }
  await page.keyboard.press(" ");
  const { pictures: drawn, waits } = await page.evaluate(() => ({ pictures: window.pictures, waits: window.waits }));
  const complete = new Promise((done) => client.once("Tracing.tracingComplete", done));
  await client.send("Tracing.end");
  await complete;
  const names = new Map(traced.filter(({ name }) => name === "thread_name").map(({ pid, tid, args }) => [`${pid} ${tid}`, args.name]));
  const tasks = traced.filter(({ ph, name }) => ph === "X" && name.endsWith("RunTask"))
    .map(({ pid, tid, tdur, dur }) => ({ thread: names.get(`${pid} ${tid}`), ran: (tdur ?? 0) / 1e3, took: dur / 1e3 }));
  const own = tasks.filter(({ thread }) => thread === "CrRendererMain");
  const drawing = tasks.filter(({ thread }) => /^(CrRendererMain|Compositor|VizCompositorThread|ThreadPoolForegroundWorker)$/.test(thread));
  const most = (all, of) => all.reduce((max, one) => Math.max(max, of(one)), 0);
  const each = drawing.reduce((sum, { ran }) => sum + ran, 0) / drawn;
  const longest = most(own, ({ ran }) => ran);
  assert(own.length > 100 && drawn > 10, `${own.length} tasks, ${drawn} pictures`);
  say(`${drawn} pictures, ${each.toFixed(1)} ms of processor each; longest task ${longest.toFixed(0)} ms (${most(own, ({ took }) => took).toFixed(0)} passed), longest wait of an input ${most(waits, (wait) => wait).toFixed(0)} ms passed`);
  assert(each < MOST_PER_PICTURE, `a picture takes ${each} ms of processor`);
  assert(longest < MOST_PER_TASK, `a task takes ${longest} ms of processor`);
}

async function hands() {
  await page.goto(`${address}/lessons/simple-pendulum`);
  await until("the pendulum is drawn", times, ([drawn]) => drawn === 0);
  // What the picture looks like, as a number.
  const look = () => drawing.evaluate((canvas) => [...canvas.toDataURL()].reduce((sum, letter) => (31 * sum + letter.charCodeAt(0)) % 1e9, 7));
  const before = await look();
  const box = await drawing.boundingBox();
  await page.mouse.move(box.x + 40, box.y + 60);
  await page.mouse.down();
  await page.mouse.move(box.x + 140, box.y + 40, { steps: 4 });
  await page.mouse.up();
  const turned = await look();
  assert.notEqual(turned, before, "a drag beside the mechanism turns the picture");
  await drawing.focus();
  await page.keyboard.press("Shift+ArrowLeft");
  assert.notEqual(await look(), turned, "and so do keys");
  await page.keyboard.press("0");
  await page.keyboard.press("c");
  await page.keyboard.press("c");
  await page.keyboard.press("c");
  await page.keyboard.press("c");
  await until("four sides on, it is as it was", look, (picture) => picture === before);
  // The bob is at the left; where it is pulled to, the run goes.
  const label = await drawing.getAttribute("aria-label");
  assert.match(label, /Drawing of the mechanism at 0.*bob at/);
  const [x, y] = await page.evaluate(() => {
    const canvas = document.querySelector("canvas.drawing");
    const seen = canvas.getBoundingClientRect();
    const pen = canvas.getContext("2d");
    // The ball is blue: the middle of all pixels of its colour in the left half.
    const { data, width, height } = pen.getImageData(0, 0, canvas.width, canvas.height);
    let [sum, sx, sy] = [0, 0, 0];
    for (let at = 0; at < data.length; at += 4) {
      const column = (at / 4) % width;
      if (data[at + 2] - data[at] > 60 && data[at + 3] > 200 && column < width / 2) { sum += 1; sx += column; sy += Math.floor(at / 4 / width); }
    }
    return [seen.x + (sx / sum / width) * seen.width, seen.y + (sy / sum / height) * seen.height];
  });
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y + 60, { steps: 3 });
  await until("the body is pulled", () => drawing.getAttribute("class"), (names) => names.includes("is-pulling"));
  await page.mouse.up();
  const saved = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save this picture (SVG)" }).click();
  assert.match((await saved).suggestedFilename(), /\.svg$/);
  say("hands and keys turn it, pull a body and save it");
}

/** What is thrown is followed: it stays in the picture while it falls, and at the end. */
async function follows() {
  await page.goto(`${address}/scenes/free-fall`);
  await until("the body is drawn", times, ([drawn]) => drawn === 0);
  // How many pixels have the light blue of the body; that of an axis is darker.
  const seen = () => drawing.evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let at = 0; at < data.length; at += 4) if (data[at + 2] - data[at] > 60 && data[at + 1] > 130 && data[at + 3] > 200) count += 1;
    return count;
  });
  const least = 100;
  assert(await seen() > least, "at the start");
  await page.keyboard.press(" ");
  for (let drawn = 0; drawn < 2; [drawn] = await times()) {
    const count = await seen();
    assert(count > least, `at ${drawn} s the body has ${count} pixels`);
    await page.waitForTimeout(100);
  }
  await until("the body is there at the end", seen, (count) => count > least);
  say("a thrown body stays in the picture");
}

await walk({ name: "drawing", pictures, browser, complaints }, plays, busy, costs, hands, follows);
