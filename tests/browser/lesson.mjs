// Lesson 2 as a student does it, in a real browser. Started by tests/tests/browser.rs:
//   node lesson.mjs first|later http://127.0.0.1:PORT PROFILE_FOLDER PICTURE_FOLDER
// "first": opens the lesson, steps, plays, sees the viewer draw, answers wrongly, then rightly.
// "later": comes back after a restart of the server and finds both results.
import assert from "node:assert/strict";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { say, until as patiently, walk } from "./browser.mjs";
import { pendulum } from "./pendulum.mjs";

const [which, address, profile, pictures] = process.argv.slice(2);
// Ends a visit that hangs, and decides nothing else.
const PATIENCE = 300_000;

const context = await chromium.launchPersistentContext(profile, {
  executablePath: "/usr/bin/chromium",
  headless: true,
  viewport: { width: 1280, height: 900 },
  args: [
    "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
    "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run", "--disable-quic",
  ],
});
const page = context.pages()[0] ?? await context.newPage();
page.setDefaultTimeout(PATIENCE);
const complaints = [];
page.on("pageerror", (error) => complaints.push(String(error)));
page.on("console", (line) => {
  const { url } = line.location();
  const drawing = /WebGL|GPU|wgpu|swiftshader/i.test(line.text());
  if (line.type() === "error" && !drawing) complaints.push(`${line.text()} ${url}`);
});

let number = 0;
const picture = async (name, target = page) => {
  number += 1;
  const path = join(pictures, `${which}-${number}-${name}.png`);
  await target.screenshot({ path });
  console.log(`picture ${path}`);
};

const until = (what, read, good, more) => patiently(what, read, good, { patience: PATIENCE, ...more });

// Pictures of a page that the processor draws take a good part of a second, ms.
const BETWEEN_PICTURES = 2_000;
// A blank or broken picture has fewer colours.
const BLANK = 40;
/** How many different colours a screenshot of the viewer has: a blank or broken picture has a handful. */
async function colours(target) {
  // A picture of the element itself would scroll to it; one of the page leaves the place alone.
  const clip = await target.evaluate((element) => {
    const { x, y, width, height } = element.getBoundingClientRect();
    return { x: x + scrollX, y: y + scrollY, width, height };
  });
  const png = (await page.screenshot({ fullPage: true, clip })).toString("base64");
  return page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const pen = canvas.getContext("2d");
    pen.drawImage(image, 0, 0);
    const seen = new Set(new Uint32Array(pen.getImageData(0, 0, image.width, image.height).data.buffer));
    return seen.size;
  }, png);
}

const clock = () => page.locator(".clock").evaluate((element) => Number(element.value ?? Number.parseFloat(element.textContent)));
const control = (name) => page.getByRole("group", { name: "Run of the simulation" }).getByRole("button", { name, exact: true });
const fill = (id, value) => page.locator(`#q-${id}`).fill(value);
/** Writes the unit where the question asks for it; elsewhere it stands behind the field. */
const unit = async (id, value) => {
  const field = page.locator(`#q-${id}-unit`);
  if (await field.count() > 0) await field.fill(value);
};
const check = async () => {
  const answered = page.waitForResponse((reply) => reply.url().includes("/submissions") && reply.request().method() === "POST");
  await page.getByRole("button", { name: "Check my answers" }).click();
  return (await answered).json();
};
const mark = (id) => page.locator(`#q-${id}`).getAttribute("class");

/** The run waits for a prediction, which is kept and stands there again after the page is loaded anew. */
async function predict() {
  const panel = page.locator("#prediction");
  await panel.getByRole("heading", { name: "Before you run it" }).waitFor();
  for (const name of ["Play", "One integrator step", "Step by time"]) await control(name).click();
  await page.locator(".clock").fill("0.5");
  await page.locator(".clock").press("Enter");
  assert.equal(await clock(), 0, "nothing moves before the prediction");
  assert.equal(await page.getByRole("tab", { name: "Jacobian" }).count(), 0, "no table tells it");
  await picture("before");
  const keep = panel.getByRole("button", { name: "That is my prediction" });
  assert(await keep.isDisabled(), "nothing is chosen yet");
  await panel.getByRole("button", { name: "Twice the weight" }).click();
  await keep.click();
  await panel.getByText("Write your name").waitFor();
  await panel.getByLabel(/Your name/).fill("Ada Lovelace");
  await panel.getByLabel(/Why/).fill("the weight, and the circle");
  await keep.click();
  await page.locator(".whose b", { hasText: "Ada Lovelace" }).waitFor();
  await panel.getByText("You predicted: Twice the weight").waitFor();
  await page.locator(".neighbours").first().waitFor();
  assert.equal(await page.locator(".neighbours").count(), 1, "made anew for the name, and once");
  await page.reload();
  await panel.getByText("“the weight, and the circle”").waitFor();
  assert.equal(await panel.getByText("What happened").count(), 0, "the run has not shown it yet");
  await until("the clock starts", clock, (time) => time === 0);
  await page.locator(".prediction-counts summary").click();
  await page.locator(".prediction-counts").getByText("1 answer").waitFor();
  await picture("counted");
  say("predicted");
}

async function first() {
  await page.goto(`${address}/`);
  await page.getByRole("link", { name: /pendulum/i }).first().waitFor();
  await picture("course");
  await page.getByRole("link", { name: /pendulum/i }).first().click();
  await page.getByRole("heading", { name: /pendulum/i, level: 1 }).waitFor();
  say("the text of the lesson can be read");
  assert.match(page.url(), /\/lessons\/simple-pendulum/);
  assert(await page.locator(".katex").count() > 5, "the formulas are set");

  await until("the clock starts", clock, (time) => time === 0);
  await predict();
  await control("One integrator step").click();
  const stepped = await until("a step moves the clock", clock, (time) => time > 0);
  await control("Step by time").click();
  await until("a step by time moves the clock by 0.1 s", clock, (time) => time >= stepped + 0.09);
  say("stepped");

  await until("the drawing shows the moment of the clock", async () => Number(await page.locator("canvas.drawing").getAttribute("data-time")) - (await clock()), (off) => off === 0);
  assert(await colours(page.locator("canvas.drawing")) > BLANK, "the mechanism is drawn");
  await picture("drawing");
  await page.getByRole("button", { name: "Open in rerun" }).click();
  const viewer = page.locator("[data-viewer]");
  await viewer.locator("canvas").waitFor();
  const drawn = await until("the viewer draws", () => colours(viewer), (count) => count > BLANK, { pause: BETWEEN_PICTURES });
  say(`the viewer shows ${drawn} colours`);
  await picture("viewer");

  // In slow motion, so that the end of the run is far however slow a machine draws the viewer.
  const speed = page.getByRole("combobox", { name: "Speed" });
  await speed.selectOption("0.1");
  await control("Play").click();
  const playing = await clock();
  await until("playing moves the clock", clock, (time) => time > playing + 0.1);
  await control("Pause").click();
  await control("Play").waitFor();
  await picture("playing");
  await speed.selectOption("4");
  await control("Play").click();
  await page.locator("#prediction").getByText("What happened: Three times the weight").waitFor();
  await picture("predicted");
  // Paused or at its end: both rest, so that the picture of before the reset can be compared.
  await page.locator(".clock").fill("3");
  await page.locator(".clock").press("Enter");
  await control("Play").waitFor();
  say("played and paused; the prediction stands beside what happened");
  const before = await viewer.screenshot();
  await control("Reset to the start").click();
  await until("reset", clock, (time) => time === 0);
  await until("the viewer follows the clock", async () => (await viewer.screenshot()).equals(before), (same) => !same, { pause: BETWEEN_PICTURES });

  await page.getByRole("tab", { name: "Jacobian" }).click();
  await page.getByText("12 columns").waitFor();
  await picture("jacobian");

  // A wrong answer that the lesson knows, and one that is no number.
  const right = await pendulum(page, "Ada Lovelace");
  await fill("independent-rows-value", "11");
  await fill("tension-bottom-value", "a lot");
  let verdict = await check();
  assert.equal(verdict.gradable, false, "text is no attempt");
  assert.match(await mark("tension-bottom"), /is-invalid/);
  await fill("tension-bottom-value", right.weight);
  await unit("tension-bottom", "N");
  await fill("period-value", right.period);
  await unit("period", "s");
  for (const [at, axis] of ["x", "y", "z"].entries()) await fill(`force-on-ground-${axis}`, right.force[at]);
  await unit("force-on-ground", "N");
  await page.locator("#q-sign-of-lambda-b").check();
  verdict = await check();
  assert(verdict.earned < verdict.possible, "a wrong answer costs points");
  assert.match(await mark("tension-bottom"), /is-wrong/);
  assert.match(await page.locator("#q-tension-bottom").innerText(), /rests/, "the feedback names the mistake");
  await page.locator("#q-tension-bottom").scrollIntoViewIfNeeded();
  await picture("wrong");
  await fill("tension-bottom-value", right.tension);
  verdict = await check();
  assert.equal(verdict.passed, true);
  assert.equal(verdict.earned, verdict.possible);
  assert.match(await mark("tension-bottom"), /is-right/);
  await page.getByRole("heading", { name: "Your submissions (3)" }).waitFor();
  await page.locator(".history").scrollIntoViewIfNeeded();
  await picture("right");
  say("answered wrongly, then rightly");
}

async function later() {
  await page.goto(`${address}/lessons/simple-pendulum`);
  await page.getByRole("heading", { name: "Your submissions (3)" }).waitFor();
  const newest = page.locator(".history-entry").first();
  assert.match(await newest.innerText(), /12 of 12/);
  await newest.click();
  await newest.getByText("Question 1").waitFor();
  await newest.scrollIntoViewIfNeeded();
  await picture("found-again");
  await page.setViewportSize({ width: 390, height: 844 });
  await page.evaluate(() => scrollTo(0, 0));
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  await picture("phone");
  assert(width <= 390, `the page is ${width} px wide on a screen of 390 px`);
  // Tall enough for the mechanism, which stands below the text and loads when it is near.
  await page.setViewportSize({ width: 390, height: 2400 });
  await page.goto(`${address}/scenes/heavy-top`);
  // The browser remembers that the viewer was opened.
  await page.locator(".has-viewer").waitFor({ state: "attached" });
  await until("the viewer draws", () => colours(page.locator("[data-viewer]")), (count) => count > BLANK, { pause: BETWEEN_PICTURES });
  const place = await page.evaluate(() => [scrollY, document.activeElement?.tagName]);
  assert.deepEqual(place, [0, "BODY"], "the viewer starts below the text and takes neither the place nor the focus");
  say("the results are there after the restart");
}

await walk({ name: `lesson-${which}`, pictures, browser: context, complaints }, which === "first" ? first : later);
