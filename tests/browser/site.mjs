// A course as files, in a browser that has no other server than one for files: node site.mjs SITE_FOLDER PICTURE_FOLDER
// Lessons are read, a mechanism runs in the page and is changed, questions say that nothing is checked; nothing but files is
// asked for; and all of it once more without a network. Started by tests/tests/browser.rs.
import assert from "node:assert/strict";
import { createReadStream, existsSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { launch, say, until as patiently, walk } from "./browser.mjs";

const [site, pictures] = process.argv.slice(2);

const KINDS = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".json": "application/json", ".wasm": "application/wasm", ".svg": "image/svg+xml", ".woff2": "font/woff2", ".txt": "text/plain" };
/** The folder in which the site lies on its host: not the root, as a course has its place among others. */
const PLACE = "/some/course/";
const asked = [];
const missing = [];
const files = createServer((request, response) => {
  const path = decodeURIComponent(new URL(request.url, "http://files").pathname);
  asked.push(path);
  const file = path.startsWith(PLACE) ? join(site, normalize(path.slice(PLACE.length)) || "index.html") : "";
  const found = file === join(site, ".") || file === `${site}/` ? join(site, "index.html") : file;
  if (request.method !== "GET" || found === "" || !existsSync(found) || statSync(found).isDirectory()) {
    missing.push(`${request.method} ${path}`);
    response.writeHead(404).end();
    return;
  }
  response.writeHead(200, { "content-type": KINDS[extname(found)] ?? "application/octet-stream" });
  createReadStream(found).pipe(response);
});
await new Promise((done) => files.listen(0, "127.0.0.1", done));
const address = `http://127.0.0.1:${files.address().port}${PLACE}`;

const browser = await launch();
const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
const page = await context.newPage();
page.setDefaultTimeout(120_000);
const complaints = [];
page.on("pageerror", (error) => complaints.push(String(error)));
/** Whether the mechanism is drawn at its start: before that there is nothing to play. */
const drawn = () => page.evaluate(() => document.querySelector("canvas.drawing")?.dataset.time);
const time = () => page.evaluate(() => Number(document.querySelector(".clock")?.value ?? Number.NaN));
const until = (what, read, good) => patiently(what, read, good, { patience: 120_000 });

async function reads() {
  await page.goto(address);
  const lesson = page.locator("a", { hasText: "pendulum" }).first();
  await lesson.waitFor();
  await page.screenshot({ path: join(pictures, "site-home.png") });
  await page.goto(`${address}?page=/lessons/simple-pendulum`);
  await page.locator(".prose").first().waitFor();
  await page.locator("#unchecked").waitFor();
  assert((await page.locator(".questions .question, .questions fieldset").count()) > 0, "questions are shown");
  say("a lesson is read, and says that nothing is checked");
}

async function runs() {
  await until("the mechanism stands at its start", drawn, (t) => t !== undefined && Number(t) === 0);
  await page.getByRole("button", { name: /^Play/ }).first().click();
  await until("it plays", time, (t) => t > 0.3);
  await page.screenshot({ path: join(pictures, "site-lesson.png") });
  assert.equal(await page.getByText("Computed here").count(), 1, "the page tells who computes");
  say("a mechanism plays");
}

async function changes() {
  await page.goto(`${address}?page=/scenes/n-four-bar%3A2`);
  await until("the scene stands at its start", drawn, (t) => t !== undefined && Number(t) === 0);
  const text = page.locator("textarea").first();
  const written = JSON.parse(await text.inputValue());
  written.bodies[0].mass = 7;
  await text.fill(JSON.stringify(written));
  await page.getByRole("button", { name: "Run this text" }).click();
  await until("the changed scene stands at its start", () => page.getByText("paused").count(), (found) => found === 1);
  await page.getByRole("button", { name: /^Play/ }).first().click();
  await until("the changed scene plays", time, (t) => t > 0.2);
  say("a scene is changed and plays");
}

async function withoutANetwork() {
  await page.evaluate(() => navigator.serviceWorker.ready.then(() => undefined));
  await until("the site is kept", () => page.evaluate(async () => {
    const kept = await Promise.all((await caches.keys()).map(async (name) => (await (await caches.open(name)).keys()).length));
    return kept.reduce((sum, count) => sum + count, 0);
  }), (count) => count > 20);
  await context.setOffline(true);
  files.closeAllConnections();
  await new Promise((done) => files.close(done));
  await page.goto(`${address}?page=/lessons/simple-pendulum`);
  await page.locator(".prose").first().waitFor();
  await until("the mechanism stands at its start", drawn, (t) => t !== undefined && Number(t) === 0);
  await page.getByRole("button", { name: /^Play/ }).first().click();
  await until("it plays without a network", time, (t) => t > 0.3);
  say("without a network a lesson is read and its mechanism plays");
}

async function all() {
  await reads();
  await runs();
  await changes();
  await withoutANetwork();
  assert.deepEqual(missing.filter((what) => !what.endsWith("/favicon.ico")), []);
  assert(asked.every((path) => path.startsWith(PLACE) || path === "/favicon.ico"), "nothing outside the site is asked for");
}

await walk({ name: "site", pictures, browser, complaints }, all);
