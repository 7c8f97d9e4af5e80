// What the visits have in common: the browser without a graphics card, the rules of accessibility, and lines with their time.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { setTimeout } from "node:timers/promises";
import { chromium } from "playwright-core";

/** The browser that Debian installs, asking nothing of any network. */
export const launch = () => chromium.launch({
  executablePath: "/usr/bin/chromium", headless: true,
  args: ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run", "--disable-quic"],
});
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
/** What axe finds against a page, or a part of it: each rule with the elements that break it. */
export async function faults(page, { within, impacts } = {}) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate((selector) =>
    window.axe.run(selector ? document.querySelector(selector) : document, { resultTypes: ["violations"] }), within);
  return violations.filter((fault) => !impacts || impacts.includes(fault.impact))
    .map((fault) => [fault.id, fault.nodes.map((node) => node.target.join(" "))]);
}
/** Those of its rules without which somebody cannot use the page. */
export const SERIOUS = ["serious", "critical"];

/**
 * Waits until `read` gives something that `good` accepts; `patience`, in milliseconds, ends what hangs and decides nothing else.
 * `pause`, ms: what is dear to read, such as a picture, is asked for so seldom that the page gets on meanwhile.
 */
export async function until(what, read, good, { patience = 60_000, pause = 50 } = {}) {
  const end = performance.now() + patience;
  let last;
  while (performance.now() < end) {
    last = await read();
    if (good(last)) return last;
    await setTimeout(pause);
  }
  throw new Error(`${what}: still ${JSON.stringify(last)} after ${patience / 1000} s`);
}
export const say = (what) => console.log(`${(performance.now() / 1000).toFixed(1).padStart(6)} s  ${what}`);

/**
 * A visit: its parts in turn; the pages must not have complained. Where something fails, the pages that are open then are kept as
 * pictures NAME-failed.png, NAME-failed-2.png. `browser` is closed: a browser, or a context that has one of its own.
 */
export async function walk({ name, pictures, browser, complaints }, ...parts) {
  mkdirSync(pictures, { recursive: true });
  try {
    for (const part of parts) await part();
    assert.deepEqual(complaints, [], "errors in the pages");
  } catch (error) {
    const pages = browser.contexts?.().flatMap((context) => context.pages()) ?? browser.pages();
    for (const [at, page] of pages.entries()) {
      const path = join(pictures, `${name}-failed${at ? `-${at + 1}` : ""}.png`);
      // A page that hangs, or is blank, has no picture.
      await page.screenshot({ path, timeout: 20_000 }).then(() => console.log(`picture ${path}`), () => {});
    }
    throw error;
  } finally {
    await browser.close();
  }
}
