// What is seen beside a run. Started by tests/tests/browser.rs:
//   node compare.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// Points leave traces; another run is seen as a ghost, the author's or one that was kept; extremes are marked on the time
// line and passed slowly; phase plots and hodographs are drawn, and a click in them moves the clock. What a lesson's step
// asks for is pressed.
import assert from "node:assert/strict";
import { join } from "node:path";
import { faults, launch, say, until, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
const page = await context.newPage();
page.setDefaultTimeout(60_000);
const complaints = [];
page.on("pageerror", (error) => complaints.push(String(error)));
const ghosts = page.locator(".stage-beside select").nth(1);
const plotted = page.locator(".inspector label", { hasText: /^Plot/ }).locator("select");
const drawing = page.locator("canvas.drawing");
const seen = (name) => until(`the drawing tells ${name}`, () => drawing.getAttribute(`data-${name}`), (value) => value !== null);
const at = (time) => until(`${time} s is drawn`, () => drawing.getAttribute("data-time"), (drawn) => Number(drawn) === time);
async function noFaults(view) {
  assert.deepEqual(await faults(page), [], `axe on ${view}`);
}
/** A request that comes while another one is under way is dropped, as that of a key may be: then it is asked again. */
async function runTo(time) {
  const drawn = async () => Number(await drawing.getAttribute("data-time"));
  await until(`${time} s is drawn`, async () => {
    if (await drawn() === time) return time;
    await page.locator(".clock").fill(String(time));
    await page.locator(".clock").press("Enter");
    await page.waitForTimeout(500);
    return drawn();
  }, (shown) => shown === time);
}

async function besides() {
  await page.goto(`${address}/scenes/simple-pendulum`);
  await at(0);
  await page.locator("summary", { has: page.locator("svg") }).and(page.getByLabel("Traces and ghost")).click();
  await page.getByLabel("Traces of").selectOption("bodies");
  await runTo(1);
  const points = Number(await seen("traced"));
  assert(points >= 60, `a second of the bob is ${points} points`);
  assert.equal(await seen("ghost"), "false");
  await ghosts.selectOption("author");
  await until("the author's run is seen", () => seen("ghost"), (ghost) => ghost === "true");
  await ghosts.selectOption("kept");
  await noFaults("traces and ghost");
  // With another length it swings otherwise, and the run that was kept stands beside it.
  await page.getByLabel("Length of the rod, in m").fill("1.3");
  await page.getByLabel("Length of the rod, in m").press("Enter");
  await page.getByText("1 number changed.").waitFor();
  await at(0);
  await runTo(0.8);
  assert.equal(await seen("ghost"), "true", "the kept run is still seen");
  await page.screenshot({ path: join(pictures, "ghost.png") });
  await ghosts.selectOption("none");
  await until("it is gone", () => seen("ghost"), (ghost) => ghost === "false");
  await ghosts.press("Escape");
  await page.getByLabel("Traces of").waitFor({ state: "hidden" });
  say("points leave traces, and another run is seen as a ghost");
}

/** The time of the clock, s. */
const clock = async () => Number(await page.locator(".clock").inputValue());

async function plots() {
  await page.goto(`${address}/scenes/simple-pendulum`);
  await at(0);
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await until("two seconds of it", clock, (time) => time > 2);
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await page.getByRole("tab", { name: "Plots" }).click();
  await plotted.selectOption({ label: "Position of bob" });
  await page.getByRole("button", { name: "Mark the extremes" }).click();
  // The bob hangs straight down, and is on the other side, at times that are known: the quarter and half of the period.
  const lowest = page.getByRole("button", { name: /^y (smallest|minimum) −(1|0\.99\d*) m at 0\.(58|59|60) s$/ });
  await lowest.click();
  assert(Math.abs(await clock() - 0.592) < 0.02, `y turns at ${await clock()} s`);
  const marks = await page.locator(".timeline-marks i").count();
  assert(marks >= 4, `${marks} marks stand on the time line`);
  await noFaults("extremes");
  // A replay from the start takes longer with its marks than without.
  const replayed = async () => {
    await page.locator(".timeline").fill("0.3");
    await at(0.3);
    const began = performance.now();
    await page.getByRole("button", { name: "Play", exact: true }).click();
    await until("it is past the lowest point", clock, (time) => time > 0.9);
    const took = performance.now() - began;
    await page.getByRole("button", { name: "Pause", exact: true }).click();
    return took;
  };
  const slowly = await replayed();
  await page.getByRole("button", { name: "Mark the extremes" }).click();
  assert.equal(await page.locator(".timeline-marks i").count(), 0, "the marks are gone");
  const evenly = await replayed();
  assert(slowly > evenly + 250, `${slowly.toFixed(0)} ms with marks, ${evenly.toFixed(0)} without`);
  say("extremes are marked, and passed slowly");
  await plotted.selectOption({ label: "Phase plot of bob" });
  const phase = page.getByRole("img", { name: "Phase plot of bob" });
  await phase.waitFor();
  const ways = await phase.locator("path[fill=none]:not(.join)").count();
  assert.equal(ways, 3, "three quantities over their own");
  const before = await clock();
  // Below what stays in sight; the page may still be growing by it, and then stays where it was.
  const box = await until("the phase plot is in sight", async () => {
    await phase.evaluate((picture) => picture.scrollIntoView({ block: "start" }));
    return phase.boundingBox();
  }, ({ y, height }) => y + height / 2 < 880);
  await page.mouse.click(box.x + box.width / 4, box.y + box.height / 2);
  await until("a click moves the clock", clock, (time) => time !== before);
  await noFaults("a phase plot");
  await page.screenshot({ path: join(pictures, "phase-plot.png"), fullPage: true });
  await plotted.selectOption({ label: "Hodograph of the velocity of bob" });
  await page.getByRole("img", { name: "Hodograph of the velocity of bob" }).waitFor();
  for (const kind of ["SVG", "PNG", "CSV"]) {
    const saved = page.waitForEvent("download");
    await page.getByRole("button", { name: kind, exact: true }).click();
    assert.match((await saved).suggestedFilename(), new RegExp(`^hodograph.*\\.${kind.toLowerCase()}$`));
  }
  await page.screenshot({ path: join(pictures, "hodograph.png"), fullPage: true });
  say("phase plots and hodographs are drawn, and saved");
}

/** Lets the run of a lesson go on without a prediction, which needs no name. */
const unpredicted = () => page.locator("#prediction").getByRole("button", { name: "Skip" }).click();

/** What a step of a lesson names is pressed where it is read. */
async function steps() {
  await page.goto(`${address}/lessons/generic-rigid-body`);
  await unpredicted();
  const todo = page.locator("#steps");
  await todo.getByRole("button", { name: "run to 1 s" }).click();
  await at(1);
  await todo.getByRole("button", { name: "step", exact: true }).click();
  await until("a step further", clock, (time) => time > 1);
  await todo.getByRole("button", { name: "Reset" }).click();
  await at(0);
  await todo.getByRole("button", { name: "play", exact: true }).click();
  await until("it runs", clock, (time) => time > 0.2);
  await noFaults("a lesson whose steps are pressed");
  await page.goto(`${address}/lessons/rigid-body-rows`);
  await unpredicted();
  await at(0);
  await page.locator("#steps").getByRole("button", { name: "Open the Jacobian" }).press("Enter");
  assert.equal(await page.evaluate(() => document.activeElement?.textContent), "Jacobian", "the reader is at the panel");
  // Read-out and matrix are seen together with the mechanism, without scrolling.
  await page.locator("canvas.matrix").waitFor();
  const seen = async (what) => page.locator(what).first().boundingBox();
  const [stage, told, matrix] = await Promise.all(["canvas.drawing", ".inspector .readout:visible", "canvas.matrix"].map(seen));
  assert(stage.y >= 0 && stage.y < 100 && told.y + told.height <= 900 && matrix.y < 760, JSON.stringify({ stage, told, matrix }));
  await page.goto(`${address}/lessons/work-and-precision`);
  await at(0);
  // What the run shows is hidden until then, and a step that wants it says so.
  await page.locator("#steps").getByRole("button", { name: "All numbers of this scene" }).click();
  await until("the prediction is asked for", () => page.locator("#announce").innerText(), (text) => /run waits/.test(text));
  await unpredicted();
  await page.locator("#steps").getByRole("button", { name: "All numbers of this scene" }).click();
  await page.getByLabel("Find a number of the scene").waitFor();
  await page.screenshot({ path: join(pictures, "steps.png") });
  // On a phone the mechanism of a scene is a press away from its text.
  await page.setViewportSize({ width: 390, height: 844 });
  await page.goto(`${address}/scenes/simple-pendulum`);
  await at(0);
  await page.getByRole("navigation", { name: "Parts of this page" }).getByRole("link", { name: "Mechanism" }).click();
  await until("the mechanism is in sight", () => drawing.boundingBox(), ({ y, height }) => y >= 0 && y + height < 844);
  say("steps of a lesson are pressed");
}

await walk({ name: "compare", pictures, browser, complaints }, besides, plots, steps);
