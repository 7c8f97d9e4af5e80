import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { kept } from "../testing/kept";
import { replaceOwn, SceneDraft } from "./draft";

/** Tabs that are told of what another one writes, as browsers do it. */
let heard: ((event: { key: string }) => void)[] = [];
const written = (key: string): void => {
  for (const one of heard) one({ key });
};

beforeEach(() => {
  heard = [];
  vi.stubGlobal("localStorage", kept());
  vi.stubGlobal("addEventListener", (_: string, listener: () => void) => heard.push(listener));
  vi.stubGlobal("removeEventListener", (_: string, listener: () => void) => {
    heard = heard.filter((one) => one !== listener);
  });
});
afterEach(() => vi.unstubAllGlobals());

it("a text is kept, and taken up by the next page", () => {
  const draft = new SceneDraft("own");
  expect(draft.read()).toBeNull();
  expect([draft.keep("a"), draft.keep("ab")]).toEqual([false, false]);
  expect(new SceneDraft("own").read()).toBe("ab");
  expect(new SceneDraft({ lesson: "spin" }).read()).toBeNull();
  expect(draft.aside()).toEqual([]);
});

it("what two tabs type in turn is never lost", () => {
  const [one, two] = [new SceneDraft("own"), new SceneDraft("own")];
  one.read();
  two.read();
  one.keep("one writes");
  expect(two.theirs()).toBe("one writes");
  expect(two.keep("two")).toBe(true);
  expect(two.keep("two writes")).toBe(false);
  expect(two.aside()).toEqual(["one writes"]);
  expect(one.theirs()).toBe("two writes");
  expect(one.keep("one writes more")).toBe(true);
  expect(one.aside()).toEqual(["one writes", "two writes"]);
  expect(new SceneDraft("own").read()).toBe("one writes more");
});

it("a tab whose text another one forgets writes it again, and the same text is nobody else's", () => {
  const [one, two] = [new SceneDraft("own"), new SceneDraft("own")];
  one.keep("a");
  two.read();
  two.keep(null);
  expect(one.theirs()).toBeUndefined();
  expect(one.keep("ab")).toBe(false);
  two.keep("ab");
  expect(two.aside()).toEqual([]);
});

it("a tab hears what another one writes, not what it knows", () => {
  const [one, two] = [new SceneDraft("own"), new SceneDraft("own")];
  const told = vi.fn();
  const stop = two.onTheirs(told);
  one.keep("a");
  written("triad:scene-draft:spin");
  expect(told).not.toHaveBeenCalled();
  written("triad:scene-draft");
  expect(told).toHaveBeenCalledTimes(1);
  two.read();
  written("triad:scene-draft");
  stop();
  one.keep("ab");
  written("triad:scene-draft");
  expect(told).toHaveBeenCalledTimes(1);
});

it("each of the texts that were put aside comes back in its turn", () => {
  const draft = new SceneDraft({ lesson: "spin" });
  expect(draft.back("c")).toBeUndefined();
  draft.putAside("a");
  draft.putAside("b");
  const seen = ["c"];
  for (let k = 0; k < 3; k += 1) seen.push(draft.back(seen.at(-1) ?? "") ?? "");
  expect(seen).toEqual(["c", "b", "a", "c"]);
  for (const text of "defghij") draft.putAside(text);
  expect(draft.aside()).toEqual(["f", "g", "h", "i", "j"]);
});

it("what is damaged is no text", () => {
  for (const text of ["{", "3", '{"a":1}', "[1, null]"]) {
    localStorage.setItem("triad:scene-aside", text);
    expect(new SceneDraft("own").aside()).toEqual([]);
  }
});

it("a scene from elsewhere puts one's own aside", () => {
  new SceneDraft("own").keep("mine");
  replaceOwn("from a file");
  const draft = new SceneDraft("own");
  expect([draft.read(), draft.aside()]).toEqual(["from a file", ["mine"]]);
});
