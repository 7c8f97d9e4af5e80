// The first page, the gallery and a frame in another site. Started by tests/tests/browser.rs:
//   node first-page.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// It speaks the language of the browser, or the one that was chosen. What moves there is recorded: no session is started until somebody opens a mechanism; less motion is respected; each
// lesson and scene has its picture; a page of another origin may show /embed/ in a frame and nothing else; axe finds nothing.
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { join } from "node:path";
import { faults, launch, say, until, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const complaints = [];
/** Sessions that were asked for. */
let sessions = 0;
let page;

async function visit(more = {}) {
  // What the page before still asks for is not this visitor's.
  await page?.context().close();
  sessions = 0;
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...more });
  page = await context.newPage();
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => { sessions += Number(request.method() === "POST" && request.url().endsWith("/sessions")); });
}
async function noFaults(view) {
  assert.deepEqual(await faults(page), [], `axe on ${view}`);
}
/** The moment that a recorded run shows; NaN while there is none. */
const moment = (within) => page.locator(`${within} canvas.drawing`).evaluateAll((all) => Number(all[0]?.dataset.time ?? NaN));

/** The page speaks what the browser's reader understands, until another language is chosen; its header fits on a phone in both. */
async function languages() {
  await visit({ locale: "de-AT", viewport: { width: 390, height: 844 } });
  await page.goto(address);
  await page.getByRole("heading", { level: 1, name: /Zwangsbedingung/ }).waitFor();
  assert.equal(await page.locator("html").getAttribute("lang"), "de");
  const header = () => page.locator(".header > *, .header nav a").evaluateAll((all) => all.filter((one) => one.matches("nav a, button") && one.offsetWidth > 0).map((one) => {
    const { left, width } = one.getBoundingClientRect();
    // What does not fit and is not cut off reaches into its neighbour.
    return [Math.round(left), Math.round(left + (getComputedStyle(one).overflowX === "hidden" ? width : Math.max(width, one.scrollWidth)))];
  }));
  const apart = (boxes, width) => boxes.every(([left, right], k) => left >= (boxes[k - 1]?.[1] ?? 0) && right <= width);
  const cut = () => page.locator(".header nav, .header button").evaluateAll((all) => all.filter((one) => one.scrollWidth > one.clientWidth).map((one) => one.innerText));
  const fits = async (language) => {
    for (const width of [360, 390]) {
      await page.setViewportSize({ width, height: 844 });
      assert(apart(await header(), width), `${language} on a phone of ${width}: ${JSON.stringify(await header())}`);
      assert.deepEqual(await cut(), [], `${language} on a phone of ${width}: nothing is cut`);
    }
  };
  await fits("German");
  await noFaults("the first page in German");
  await page.screenshot({ path: join(pictures, "home-german.png") });
  await page.setViewportSize({ width: 320, height: 256 });
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 320, "at 400 % zoom nothing is scrolled to the side");
  await page.setViewportSize({ width: 390, height: 844 });
  await page.keyboard.press("?");
  await page.getByRole("dialog").getByRole("button", { name: "English" }).click();
  await page.getByRole("link", { name: "Start with the first lesson" }).waitFor();
  assert.equal(await page.locator("html").getAttribute("lang"), "en");
  await fits("English");
  await page.reload();
  await page.getByRole("link", { name: "Start with the first lesson" }).waitFor();
  say("it speaks two languages, and remembers which");
}

async function home() {
  await visit();
  await page.goto(address);
  await until("the mechanism at the top moves", () => moment(".hero"), (time) => time > 0.3);
  await page.locator(".hero").getByRole("button", { name: "Pause" }).click();
  const stopped = await moment(".hero");
  await page.waitForTimeout(300);
  assert.equal(await moment(".hero"), stopped, "a pause holds it");
  const counts = () => page.evaluate(() => [".lesson-row", ".lesson-picture svg", ".home-gallery .picture svg"].map((what) => document.querySelectorAll(what).length));
  const [lessons, drawn] = await until("the pictures", counts, ([rows, , cards]) => rows > 0 && cards >= 10);
  assert.equal(drawn, lessons, "each lesson has its picture");
  assert(await page.locator(".lesson-part").count() > 1, "the lessons stand in parts");
  await noFaults("the first page");
  await page.screenshot({ path: join(pictures, "home.png") });
  const card = page.locator(".scene-card", { hasText: "RSSR" });
  await card.getByRole("button", { name: /^Play/ }).click();
  await until("the picture of a card moves", () => moment(".scene-card"), (time) => time > 0.2);
  await card.getByRole("button", { name: /^Stop/ }).click();
  await until("and stands", () => card.locator("canvas").count(), (count) => count === 0);
  assert.equal(sessions, 0, "nothing was computed for this visitor");
  await page.getByRole("link", { name: "Start with the first lesson" }).click();
  await page.getByRole("heading", { level: 1, name: /rigid body/i }).waitFor();
  say("the first page moves, by what was recorded");
}

async function begunAndCalm() {
  await visit({ reducedMotion: "reduce", colorScheme: "dark" });
  await page.addInitScript(() => localStorage.setItem("triad:draft:simple-pendulum", "{}"));
  await page.goto(address);
  await until("the mechanism at the top is drawn", () => moment(".hero"), (time) => time === 0);
  const row = page.locator(".lesson-row", { hasText: "The simple pendulum" });
  await row.getByText("Begun").waitFor();
  assert.equal(await moment(".hero"), 0, "who asked for less motion sees it stand");
  await page.locator(".hero").getByRole("button", { name: "Play" }).click();
  await until("and may play it", () => moment(".hero"), (time) => time > 0.1);
  await page.goto(`${address}/scenes`);
  await until("the gallery", () => page.locator(".scene-card .picture svg").count(), (count) => count >= 18);
  await noFaults("the gallery, dark");
  say("less motion is respected; what was begun is told");
}

async function framed() {
  await visit();
  // A page of another origin: another port is one.
  const frame = (path) => `<iframe title="t" width="640" height="400" src="${address}${path}"></iframe>`;
  const other = createServer((request, answer) => {
    answer.setHeader("content-type", "text/html");
    answer.end(`<!doctype html><html lang="en"><title>slides</title>${frame(request.url)}`);
  });
  await new Promise((done) => { other.listen(0, "127.0.0.1", done); });
  try {
    const slides = `http://127.0.0.1:${other.address().port}`;
    await page.goto(`${slides}/embed/scenes/rssr?play=1&forces=all`);
    const inside = page.frameLocator("iframe");
    const drawn = () => inside.locator("canvas.drawing").evaluateAll((all) => Number(all[0]?.dataset.time ?? NaN));
    await until("it plays in the frame", drawn, (time) => time > 0.2);
    assert.equal(await inside.locator("#header a").count(), 0, "there is nowhere to go in it");
    assert.equal(await inside.getByRole("link", { name: "Open in Triad" }).getAttribute("target"), "_blank");
    await page.screenshot({ path: join(pictures, "embed.png") });
    for (const path of ["/", "/scenes/rssr", "/room"]) {
      const refused = page.waitForEvent("console", (message) => /frame-ancestors|X-Frame-Options/i.test(message.text()));
      await page.goto(`${slides}${path}`);
      await refused;
    }
    await page.goto(`${address}/embed/lessons/simple-pendulum?theme=dark`);
    await page.locator("canvas.drawing").waitFor();
    await noFaults("the frame");
    await page.goto(`${address}/embed/scenes/nowhere`);
    await page.getByText("nowhere").first().waitFor();
    assert.equal(sessions, 0, "a frame has no session");
  } finally {
    other.close();
  }
  say("another site shows the recorded run in a frame, and nothing else of the page");
}

await walk({ name: "first-page", pictures, browser, complaints }, home, languages, begunAndCalm, framed);
