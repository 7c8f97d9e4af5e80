import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { ApiError } from "../../api/client";
import { type Numbers, none } from "../../api/numbers";
import type { Session } from "../../session/session";
import { fake, fakePage, found } from "../../testing/page";
import { ParametersTab, standing } from "./parameters-tab";

beforeEach(() => {
  fakePage();
  vi.useFakeTimers();
});
afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

it("a run is as its author wrote it only if it never was altered", () => {
  expect(standing(0, false)).toBe("As the author wrote it.");
  expect(standing(0, true)).toMatch(/this run was changed on its way/);
  expect(standing(2, true)).toBe("2 numbers changed.");
});

it("a number that the server did not answer stays as it was typed, and is sent when that is back", async () => {
  const parameter = {
    name: "g",
    label: "Gravity",
    unit: "m/s²",
    low: 0,
    high: 20,
    step: null,
    initial: 9.81,
    value: 9.81,
  };
  const heard = new Map<string, (() => void)[]>();
  let there = false;
  const session = {
    numbers: none(),
    altered: false,
    canUndo: false,
    view: { parameters: [parameter], scene: {}, original: {} },
    on: (event: string, listener: () => void) =>
      void heard.set(event, [...(heard.get(event) ?? []), listener]),
    change: vi.fn(async (to: Numbers) => {
      if (!there) throw new ApiError({ title: "The server does not answer", code: "server-unreachable" });
      session.numbers = to;
      session.view = { ...session.view, parameters: [{ ...parameter, value: to.values.g ?? 9.81 }] };
    }),
    undo: vi.fn(async () => {
      throw new ApiError({ title: "The server does not answer", code: "server-unreachable" });
    }),
  };
  const tab = new ParametersTab(session as unknown as Session);
  Object.assign(tab.root, { isConnected: true });
  tab.refresh();
  const field = found(found(tab.root, ".parameter"), "input[type=text]");
  const notice = (): boolean => /does not answer/.test(fake(tab.root).textContent);
  field.value = "5";
  field.dispatchEvent(new Event("change"));
  await vi.advanceTimersByTimeAsync(0);
  expect([field.value, notice()]).toEqual(["5", true]);
  await vi.advanceTimersByTimeAsync(2100);
  tab.refresh();
  expect(field.value).toBe("5");
  expect(session.change).toHaveBeenCalledTimes(2);
  there = true;
  for (const listener of heard.get("opened") ?? []) listener();
  await vi.advanceTimersByTimeAsync(0);
  expect([session.numbers.values.g, field.value, notice()]).toEqual([5, "5", false]);
  await vi.advanceTimersByTimeAsync(10_000);
  expect(session.change).toHaveBeenCalledTimes(3);
  // An undo is not asked for again by itself; that the server did not answer is told until it does.
  session.canUndo = true;
  tab.refresh();
  for (const button of fake(tab.root).querySelectorAll("button"))
    if (button.textContent === "Undo") button.click();
  await vi.advanceTimersByTimeAsync(0);
  expect(notice()).toBe(true);
  for (const listener of heard.get("opened") ?? []) listener();
  expect(notice()).toBe(false);
});
