// What a reload and a second tab leave as it was. Started by tests/tests/browser.rs:
//   node kept.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// Numbers and time over a reload, and over a change of the language; one text in two tabs; a link's text that is edited; a built-in scene.
import assert from "node:assert/strict";
import { join } from "node:path";
import { faults, launch, say, until, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const complaints = [];

async function visitor(name, more = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, bypassCSP: true, permissions: ["clipboard-read", "clipboard-write"], ...more });
  return { context, page: await tab(context, name) };
}
async function tab(context, name) {
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => complaints.push(`${name}: ${error}`));
  return page;
}
const clock = (page) => page.locator(".clock").evaluate((field) => Number(field.value));
const started = (page) => until("the run starts", () => page.locator(".clock").count(), Boolean).then(() => until("its time", () => clock(page), (time) => time === 0));
const goTo = async (page, time) => {
  await page.locator(".clock").fill(String(time));
  await page.locator(".clock").press("Enter");
  await until("the typed time", () => clock(page), (now) => now === time);
};
const gravity = (page) => page.getByLabel(/^(Gravity|Fallbeschleunigung), in/);
const banner = (page) => page.locator("#banner .banner");

async function reloads() {
  const { context, page } = await visitor("reload");
  await page.goto(`${address}/scenes/simple-pendulum`);
  await started(page);
  await page.getByRole("tab", { name: "Parameters" }).click();
  await gravity(page).fill("3");
  await gravity(page).press("Enter");
  await until("the run begins anew", () => page.locator(".parameter.is-changed").count(), (count) => count === 1);
  await goTo(page, 1.25);
  await page.reload();
  await banner(page).getByText("The page was loaded anew: numbers and time are those from before.").waitFor();
  // The clock is painted after the notice.
  await until("the time from before", () => clock(page), (time) => time === 1.25);
  assert.equal(await gravity(page).inputValue(), "3", "the panel and its number");
  assert.deepEqual(await faults(page), [], "axe on what was kept");
  await page.screenshot({ path: join(pictures, "kept-reload.png") });
  // Another language is another load.
  await page.getByRole("button", { name: "Deutsch" }).click();
  await banner(page).getByText("Die Seite wurde neu geladen").waitFor();
  await until("the time in German", () => page.locator(".clock").inputValue(), (time) => time === "1.2500");
  assert.equal(await gravity(page).inputValue(), "3");
  await page.getByRole("button", { name: "English" }).click();
  await banner(page).getByRole("button", { name: "Begin anew" }).click();
  await until("the author's run", async () => [await clock(page), await gravity(page).inputValue()], ([time, g]) => time === 0 && g === "9.81");
  // There is nothing to keep of it; and a link shows what it says.
  await page.reload();
  await started(page);
  assert.equal(await banner(page).count(), 0);
  await goTo(page, 0.5);
  await page.getByRole("button", { name: "Copy a link to this view" }).click();
  const link = await until("the link", () => page.evaluate(() => navigator.clipboard.readText()), (text) => text.includes("show="));
  await goTo(page, 1);
  await page.goto(link);
  await until("the link's time", () => clock(page), (time) => time === 0.5);
  await goTo(page, 0.75);
  await page.reload();
  await until("the time of before", () => clock(page), (time) => time === 0.75);
  await page.goto(`${address}/scenes/simple-pendulum`);
  await started(page);
  say("numbers, time and panel stay over a reload and a change of the language; a link and an address say themselves");
  await context.close();
}

async function tabs() {
  const { context, page: one } = await visitor("one");
  const text = (page) => page.locator("textarea.code");
  const write = (page, name) => text(page).evaluate((field, name) => {
    field.value = field.value.replace(/"name": "[^"]*"/, `"name": "${name}"`);
    field.dispatchEvent(new Event("input"));
  }, name);
  const name = async (page) => /"name": "([^"]*)"/.exec(await text(page).inputValue())?.[1];
  const others = (page) => page.locator(".is-editor p[role=status]:not([hidden])").filter({ hasText: "Another tab" });
  await one.goto(`${address}/scenes/own`);
  await started(one);
  const two = await tab(context, "two");
  await two.goto(`${address}/scenes/own`);
  await started(two);
  await write(one, "first");
  await others(two).getByText("Another tab of this browser has changed this text.").waitFor();
  assert.notEqual(await name(two), "first", "what somebody reads stays until they want the other");
  await write(two, "second");
  await others(two).getByText("what it wrote is kept").waitFor();
  assert.deepEqual(await faults(two), [], "axe on two texts");
  await two.screenshot({ path: join(pictures, "kept-two-tabs.png") });
  await two.getByRole("button", { name: "Back to the text before" }).click();
  assert.equal(await name(two), "first");
  await two.getByRole("button", { name: "Back to the text before" }).click();
  assert.equal(await name(two), "second");
  await others(one).getByRole("button", { name: "Show its text" }).click();
  assert.equal(await name(one), "second");
  // Nothing of it goes with the tabs.
  await one.close();
  await two.reload();
  await until("the text", () => name(two), (now) => now === "second");
  await two.getByRole("button", { name: "Undo all changes" }).click();
  await two.getByRole("button", { name: "Back to the text before" }).click();
  assert.equal(await name(two), "second");
  say("two tabs with one text keep what both wrote");
  // A link's text takes the place of one's own once it is edited: that one is kept, and the page shows the edited text from then on.
  // The clipboard is that of all tabs: the link of the pendulum is there from before.
  await two.evaluate(() => navigator.clipboard.writeText(""));
  await two.getByRole("button", { name: "Copy a link to this view" }).click();
  const link = await until("the link", () => two.evaluate(() => navigator.clipboard.readText()), (text) => text.includes("show="));
  await write(two, "third");
  await two.goto(link);
  await until("the link's text", () => name(two), (now) => now === "second");
  await write(two, "fourth");
  await two.reload();
  await until("the edited text", () => name(two), (now) => now === "fourth");
  await two.getByRole("button", { name: "Back to the text before" }).click();
  assert.equal(await name(two), "third");
  say("a link's text is edited without losing one's own");
  // A built-in scene stays; what was made of it waits with one's own.
  await two.goto(`${address}/scenes/free-fall`);
  await started(two);
  await write(two, "fifth");
  await two.getByText("When you leave, your text waits at").waitFor();
  await two.reload();
  await started(two);
  assert.notEqual(await name(two), "fifth");
  await two.goto(`${address}/scenes/own`);
  await two.getByRole("button", { name: "Back to the text before" }).click();
  assert.equal(await name(two), "fifth");
  say("what was made of a built-in scene waits with one's own");
  await context.close();
}

await walk({ name: "kept", pictures, browser, complaints }, reloads, tabs);
