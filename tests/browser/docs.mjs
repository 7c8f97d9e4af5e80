// The documentation as a reader has it. Started by tests/tests/browser.rs:
//   node docs.mjs http://127.0.0.1:PORT PICTURE_FOLDER EXPORTED_FOLDER
// Found by words, in light and dark, on a phone, and from a disk without a server; axe on every page.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { faults, launch, walk } from "./browser.mjs";

const [address, pictures, exported] = process.argv.slice(2);
const say = (what) => console.log(`docs: ${what}`);
const browser = await launch();
const complaints = [];

async function reader(more = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...more });
  const page = await context.newPage();
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("console", (message) => {
    // A browser asks for an icon by itself.
    const own = !message.location().url.endsWith("/favicon.ico");
    if (message.type() === "error" && own) complaints.push(`${message.text()} ${message.location().url}`);
  });
  return page;
}

async function clean(page, what) {
  assert.deepEqual(await faults(page), [], `axe on ${what}`);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert(wide <= 0, `${what} is ${wide} px wider than the screen`);
}

async function search(page, words, expected) {
  await page.keyboard.press("/");
  await page.keyboard.type(words);
  const first = page.locator("#found a").first();
  await first.waitFor();
  const found = await page.locator("#found a").evaluateAll((links) => links.map((link) => link.getAttribute("href")));
  assert(found.slice(0, 3).some((at) => at.startsWith(expected)), `${words} finds ${found}`);
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  await page.waitForURL((url) => url.href.includes(found[0]));
}

async function all() {
  const pages = readdirSync(exported).filter((name) => name.endsWith(".html")).sort();
  assert(pages.length >= 12, String(pages));
  for (const [scheme, width] of [["light", 1280], ["dark", 390]]) {
    // Without the page's policy, so that axe may be put into it.
    const page = await reader({ colorScheme: scheme, viewport: { width, height: 900 }, bypassCSP: true });
    for (const name of pages) {
      await page.goto(`${address}/docs/${name}`);
      assert.equal(await page.locator("html").getAttribute("data-theme"), scheme);
      await clean(page, `${name} in ${scheme} at ${width} px`);
      await page.screenshot({ path: join(pictures, `docs-${scheme}-${name}.png`) });
    }
    await page.context().close();
  }
  say(`${pages.length} pages are clean, in light and dark, wide and narrow`);

  const gallery = await reader();
  await gallery.goto(`${address}/docs/gallery.html`);
  const widths = await gallery.evaluate(async () => {
    const all = [...document.querySelectorAll("main img")];
    for (const image of all) image.loading = "eager";
    await Promise.all(all.map((image) => image.decode()));
    return all.map((image) => image.naturalWidth);
  });
  assert.deepEqual(widths, Array(10).fill(640));
  await gallery.screenshot({ path: join(pictures, "docs-gallery.png") });
  const leads = await gallery.getByRole("link", { name: "Play it in the workbench" }).first().evaluate((link) => link.href);
  await gallery.context().close();
  // What the workbench says while it is left is no matter of the documentation.
  const workbench = await browser.newContext();
  const opened = await workbench.newPage();
  await opened.goto(leads);
  await opened.locator("canvas.drawing").first().waitFor();
  assert.match(opened.url(), /\/scenes\/rssr$/);
  await workbench.close();
  const calm = await reader({ reducedMotion: "reduce" });
  await calm.goto(`${address}/docs/gallery.html`);
  const shown = await calm.locator("main img").first().evaluate((image) => image.decode().then(() => image.currentSrc));
  assert(shown.endsWith("-still.svg"), shown);
  await calm.context().close();
  say("ten mechanisms move, stand still where that is asked for, and open in the workbench");

  // With the policy as it is sent.
  const page = await reader({ reducedMotion: "reduce" });
  await page.goto(`${address}/docs`);
  await page.getByRole("heading", { level: 1, name: "Triad" }).waitFor();
  await search(page, "multipliers of least norm", "theory.html");
  await page.goto(`${address}/docs/`);
  await search(page, "sweep", "");
  await page.getByRole("button", { name: "Light or dark" }).click();
  assert.equal(await page.locator("html").getAttribute("data-theme"), "dark");
  await page.goto(`${address}/docs/theory.html`);
  assert.equal(await page.locator("html").getAttribute("data-theme"), "dark");
  assert((await page.locator("math").count()) > 100, "equations are set");
  for (const picture of await page.goto(`${address}/docs/`).then(() => page.locator("main img").all())) {
    assert(await picture.evaluate((image) => image.complete && image.naturalWidth > 0), "pictures are shown");
  }
  await page.goto(`${address}/guide`);
  assert.match(page.url(), /\/docs\/scenes\.html$/);
  say("found by words, and the theme stays");
  await page.context().close();

  const disk = await reader();
  await disk.goto(pathToFileURL(join(exported, "index.html")).href);
  await search(disk, "POST submissions", "http.html");
  assert((await disk.getByRole("link", { name: "Workbench" }).count()) === 0, "there is no workbench beside it");
  await disk.context().close();
  say("read and searched from a disk");
}

await walk({ name: "docs", pictures, browser, complaints }, all);
