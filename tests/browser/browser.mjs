// What the visits have in common: the browser without a graphics card, the rules of accessibility, and lines with their time.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
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

/** Waits until `read` gives something that `good` accepts; `patience`, in milliseconds, ends what hangs and decides nothing else. */
export async function until(what, read, good, { patience = 60_000, failed } = {}) {
  const end = performance.now() + patience;
  let last;
  while (performance.now() < end) {
    last = await read();
    if (good(last)) return last;
    await setTimeout(50);
  }
  await failed?.();
  throw new Error(`${what}: still ${JSON.stringify(last)} after ${patience / 1000} s`);
}
export const say = (what) => console.log(`${(performance.now() / 1000).toFixed(1).padStart(6)} s  ${what}`);
