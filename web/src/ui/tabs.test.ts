import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { fake, fakePage } from "../testing/page";
import { tabs } from "./tabs";

beforeEach(fakePage);
afterEach(() => vi.unstubAllGlobals());

it("a tab that is not offered here leaves what is open, and its keys", () => {
  const changed = vi.fn();
  const list = ["state", "plots"].map((key) => ({ key, label: key, panel: document.createElement("div") }));
  const bar = tabs("Inspector", list, "plots", changed);
  changed.mockClear();
  bar.select("parameters");
  expect(bar.current()).toBe("plots");
  expect(list.map(({ panel }) => panel.hidden)).toEqual([true, false]);
  const buttons = fake(bar.root).querySelectorAll(".tab");
  expect(buttons.map((button) => [button.getAttribute("aria-selected"), button.tabIndex])).toEqual([
    ["false", -1],
    ["true", 0],
  ]);
  expect(changed).not.toHaveBeenCalled();
  bar.select("state");
  expect(list.map(({ panel }) => panel.hidden)).toEqual([false, true]);
});
