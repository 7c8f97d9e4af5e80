// What the visits have in common: the browser without a graphics card, the rules of accessibility, and lines with their time.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";

/** The browser that Debian installs, asking nothing of any network. */
export const launch = () => chromium.launch({
  executablePath: "/usr/bin/chromium", headless: true,
  args: ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run", "--disable-quic"],
});
/** The script of axe, to be evaluated in a page. */
export const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
export const say = (what) => console.log(`${(performance.now() / 1000).toFixed(1).padStart(6)} s  ${what}`);
