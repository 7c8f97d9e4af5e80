import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { kept as storage } from "../testing/kept";
import type { SharedView } from "./shared-view";

const source = { builtin: "simple-pendulum" };
const view: SharedView = {
  numbers: { values: { mass: 2.5 }, places: { "/gravity/1": -1.62 } },
  time: 1.25,
  panel: "reactions",
};

let how = "reload";
beforeEach(() => {
  how = "reload";
  vi.stubGlobal("sessionStorage", storage());
  vi.stubGlobal("performance", { getEntriesByType: () => [{ type: how }] });
});
afterEach(() => vi.unstubAllGlobals());

/** The page as it is loaded. */
async function page(): Promise<typeof import("./reloaded")> {
  vi.resetModules();
  return import("./reloaded");
}

it("numbers and time stay when the page is loaded anew, for its first run and once", async () => {
  (await page()).keepView(source, view, false);
  const anew = await page();
  expect(anew.keptView(source)).toEqual({ view, altered: false });
  expect(anew.keptView(source)).toBeUndefined();
  expect((await page()).keptView(source)).toBeUndefined();
  // A page that is left and shown again as it was opens other runs from their starts.
  anew.keepView(source, view, false);
  expect(anew.keptView(source)).toBeUndefined();
});

it("another run begins as its own page says", async () => {
  (await page()).keepView(source, view, false);
  const anew = await page();
  expect(anew.keptView({ builtin: "n-four-bar:2" })).toBeUndefined();
  expect(anew.keptView(source)).toBeUndefined();
  // A text that was changed since is another scene.
  (await page()).keepView({ scene: { name: "a", gravity: [0, 0, 0] } }, view, false);
  expect((await page()).keptView({ scene: { name: "a", gravity: [0, 0, 1] } })).toBeUndefined();
});

it("a link shows what it says, not what the tab has kept", async () => {
  (await page()).keepView(source, view, false);
  how = "navigate";
  expect((await page()).keptView(source)).toBeUndefined();
  how = "reload";
  expect((await page()).keptView(source)).toBeUndefined();
});

it("a run that was changed on its way keeps its numbers and stands at its start", async () => {
  (await page()).keepView(source, view, true);
  expect((await page()).keptView(source)).toEqual({ view: { ...view, time: 0 }, altered: true });
});

it("what is damaged, or refused by the browser, keeps nothing", async () => {
  for (const text of ["{", "3", '{"source":"{}"}', `{"source":${JSON.stringify(JSON.stringify(source))}}`]) {
    sessionStorage.setItem("triad:view", text);
    expect((await page()).keptView(source), text).toBeUndefined();
  }
  vi.stubGlobal("sessionStorage", undefined);
  (await page()).keepView(source, view, false);
  expect((await page()).keptView(source)).toBeUndefined();
});
