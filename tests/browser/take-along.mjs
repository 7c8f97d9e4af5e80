// What can be taken along of a mechanism. Started by tests/tests/browser.rs:
//   node take-along.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// Pictures, a film where the browser records one, a page that plays offline from a file, and a lesson on paper.
import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { faults, launch, say, until, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const complaints = [];
/** Largest file that plays, bytes. */
const MOST_BYTES = 300_000;
const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, colorScheme: "dark" });
let page;
async function open(path) {
  page = await context.newPage();
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(path);
}
const moment = () => page.locator("canvas.drawing").evaluateAll((all) => Number(all[0]?.dataset.time ?? NaN));
/** Presses a button and keeps what the browser saves. */
async function saved(name) {
  const waiting = page.waitForEvent("download");
  await page.getByRole("button", { name, exact: true }).click();
  const file = await waiting;
  const path = join(pictures, file.suggestedFilename());
  await file.saveAs(path);
  return path;
}

async function files() {
  await open(`${address}/scenes/spatial-slider-crank`);
  await until("the mechanism is drawn", moment, (time) => time === 0);
  await page.getByRole("button", { name: /^Take it along/ }).click();
  assert(await page.getByRole("button", { name: "Save the page (HTML)" }).isDisabled(), "nothing was run yet");
  await page.keyboard.press("Escape");
  await page.locator(".clock").fill("1");
  await page.locator(".clock").press("Enter");
  await until("a second of it", moment, (time) => time === 1);
  await page.getByRole("button", { name: /^Take it along/ }).click();
  assert.deepEqual(await faults(page, { within: "dialog" }), [], "axe on the dialog");
  assert.match(await page.getByLabel("Text of the frame").inputValue(), /^<iframe src="http.*\/embed\/scenes\/spatial-slider-crank\?play=1/);
  const png = readFileSync(await saved("Save as PNG"));
  assert.equal(png.subarray(1, 4).toString(), "PNG");
  const stage = await page.locator(".stage").boundingBox();
  assert(Math.abs(png.readUInt32BE(16) - 3 * stage.width) < 4, "three pixels for each of the page's");
  assert.match(readFileSync(await saved("Save as SVG"), "utf8"), /^<svg .*<title>Spatial slider-crank/);
  const record = page.getByRole("button", { name: "Record a film" });
  if (await record.isEnabled()) {
    const film = readFileSync(await saved("Record a film"));
    // EBML, or a box of MP4.
    assert(film.readUInt32BE(0) === 0x1a45dfa3 || film.subarray(4, 8).toString() === "ftyp", "a film");
    assert(film.length > 10_000, `${film.length} bytes are no film`);
    say(`a film of ${(film.length / 1e3).toFixed(0)} kB`);
  } else say("this browser records no films");
  return saved("Save the page (HTML)");
}

async function offline(file) {
  const { size } = statSync(file);
  assert(size < MOST_BYTES, `${size} bytes`);
  await context.setOffline(true);
  const asked = [];
  context.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) asked.push(request.url()); });
  await open(pathToFileURL(file).href);
  await until("it plays from the file", moment, (time) => time > 0.2);
  await page.getByRole("button", { name: "Pause" }).click();
  await page.getByRole("slider", { name: "Time" }).fill("0.5");
  await until("its time line", moment, (time) => Math.abs(time - 0.5) < 0.01);
  assert.deepEqual(asked, [], "it asks for nothing");
  await page.screenshot({ path: join(pictures, "offline.png") });
  await context.setOffline(false);
  say(`a page of ${(size / 1e3).toFixed(0)} kB plays without a network`);
}

async function paper() {
  await open(`${address}/lessons/simple-pendulum`);
  await until("the mechanism is drawn", moment, (time) => time === 0);
  await page.locator("fieldset.question").first().waitFor();
  await page.emulateMedia({ media: "print" });
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  const seen = await page.evaluate(() => {
    const visible = (what) => [...document.querySelectorAll(what)].filter((one) => one.checkVisibility()).length;
    return {
      theme: document.documentElement.dataset.theme,
      figure: visible(".stage-printed svg"),
      code: visible(".handout-head .qr"),
      formulas: visible(".prose .math"),
      questions: visible("fieldset.question"),
      spaces: visible(".handout-space"),
      buttons: visible("button:not(.do), nav, .transport, .inspector"),
      // Steps of the lesson that are buttons on the screen are words on paper.
      framed: [...document.querySelectorAll("button.do")].filter((one) => getComputedStyle(one).borderTopWidth !== "0px").length,
    };
  });
  assert(seen.formulas > 5 && seen.questions >= 5 && seen.spaces === seen.questions, JSON.stringify(seen));
  assert.deepEqual([seen.theme, seen.figure, seen.code, seen.buttons, seen.framed], ["light", 1, 1, 0, 0], JSON.stringify(seen));
  await page.evaluate(() => dispatchEvent(new Event("afterprint")));
  await page.emulateMedia({ media: "screen" });
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark", "the screen is as it was");
  await page.pdf({ path: join(pictures, "handout.pdf"), format: "A4" });
  say("a lesson on paper has text, figure, questions and room for answers");
}

async function all() {
  await offline(await files());
  await paper();
}

await walk({ name: "take-along", pictures, browser, complaints }, all);
