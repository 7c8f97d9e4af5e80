// What the lessons of the course need from each other, and a course of one's own. Started by tests/tests/browser.rs:
//   node course.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// By keyboard alone: a lesson is left out, what is used too early is told, what is needed is taken, a lesson is moved and keeps
// the focus, the file is saved; axe in light and dark, on a wide screen and on a phone; every lesson fits a phone.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { faults, launch, say, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const complaints = [];
const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, bypassCSP: true, reducedMotion: "reduce" });
const page = await context.newPage();
page.on("pageerror", (error) => complaints.push(String(error)));

/** Pictures in light and in dark on both widths; no fault, and nothing wider than the screen. */
async function look(view) {
  for (const [width, height] of [[1280, 900], [390, 844]]) {
    await page.setViewportSize({ width, height });
    for (const theme of ["light", "dark"]) {
      await page.evaluate((wanted) => { document.documentElement.dataset.theme = wanted; }, theme);
      await page.screenshot({ path: join(pictures, `course-${view}-${width}-${theme}.png`) });
      assert.deepEqual(await faults(page), [], `axe on ${view}, ${width} px, ${theme}`);
    }
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    assert(wide <= 0, `${view} is ${wide} px wider than ${width} px`);
  }
  await page.setViewportSize({ width: 1280, height: 900 });
  await page.evaluate(() => { document.documentElement.dataset.theme = "light"; });
  say(`looked at ${view}`);
}

/** Presses Tab until an element has the focus: what no key reaches is never reached. */
async function tabTo(selector) {
  for (let presses = 0; presses < 400; presses += 1) {
    if (await page.evaluate((wanted) => document.activeElement?.matches(wanted), selector)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`no Tab leads to ${selector}`);
}
const state = () => page.locator(".course-state").innerText();
/** The titles in their order, without numbers and remarks. */
const titles = async () => (await page.locator(".course-row label").allInnerTexts()).map((text) => text.replace(/^\d+\s*/, "").split("\n")[0].replace(/\s*too early$/, ""));
const focused = () => page.evaluate(() => document.activeElement?.id);

async function all() {
  await page.goto(`${address}/course`);
  await page.locator(".course-row").first().waitFor();
  assert.match(await state(), /^\d+ lessons, about \d+ hours\. Nothing is used before it is introduced\.$/);
  assert((await page.locator(".course-arc").count()) > 40, "what needs what is drawn");
  await look("whole");

  // The first lesson of the text is left out: others use what it introduces.
  await tabTo("#take-generic-rigid-body");
  assert.match(await page.locator(".course-details").innerText(), /Introduces[\s\S]*Is needed by[\s\S]*Points and directions/);
  await page.keyboard.press("Space");
  assert.match(await state(), /lessons use what was not introduced/);
  assert.equal(await focused(), "take-generic-rigid-body", "the focus stays");
  assert((await page.locator(".course-row .flag").count()) > 3, "those lessons are marked");
  assert((await page.locator(".course-arc.is-missing").count()) > 3, "and their arcs");
  await look("too-early");

  const complete = page.getByRole("button", { name: "Take what is needed" });
  await complete.focus();
  await page.keyboard.press("Enter");
  await page.getByText("Nothing is used before it is introduced.").waitFor();

  // Moved behind the lesson that uses it, and back again.
  const order = await titles();
  await tabTo("#later-generic-rigid-body");
  await page.keyboard.press("Enter");
  assert.equal(await focused(), "later-generic-rigid-body");
  assert.equal((await titles()).indexOf(order[0]), 1);
  await page.locator(".visually-hidden, [aria-live]").filter({ hasText: "is lesson 2 now" }).first().waitFor({ state: "attached" });
  assert.match(await state(), /not introduced/);
  await tabTo("#earlier-generic-rigid-body");
  await page.keyboard.press("Enter");
  assert.deepEqual(await titles(), order);

  // A short course: only the last lesson, and what it needs.
  await page.getByRole("button", { name: "As it was" }).click();
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save as course.toml" }).focus();
  await page.keyboard.press("Enter");
  const file = readFileSync(await (await download).path(), "utf8");
  const kept = [...file.matchAll(/^ {2}"(.+)",$/gm)].map((line) => line[1]);
  assert.equal(kept.length, order.length);
  assert.equal(kept[0], "generic-rigid-body");
  assert.match(file, /^opens = \{ right = (true|false)/m);
}

/** A lesson is read on a phone without pushing the page from side to side: no formula, address or field is wider than it. */
async function onAPhone() {
  const lessons = await (await page.request.get(`${address}/api/v1/lessons`)).json();
  await page.setViewportSize({ width: 360, height: 780 });
  const wide = [];
  for (const { slug } of lessons) {
    await page.goto(`${address}/lessons/${slug}`);
    await page.locator(".prose").first().waitFor();
    await page.waitForFunction(() => [...document.querySelectorAll(".math")].every((formula) => formula.dataset.set));
    const over = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    if (over > 0) wide.push(`${slug}: ${over} px`);
  }
  assert(lessons.length > 30, `${lessons.length} lessons`);
  assert.deepEqual(wide, [], "lessons wider than a phone");
  say(`${lessons.length} lessons on a phone`);
}

await walk({ name: "course", pictures, browser, complaints }, all, onAPhone);
