import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { Lesson } from "../api/types";
import { kept } from "../testing/kept";
import { DraftStore } from "./drafts";

const lesson = { slug: "spin", has_variants: false } as Lesson;

beforeEach(() => vi.stubGlobal("localStorage", kept()));
afterEach(() => vi.unstubAllGlobals());

/** A tab with two questions, as it is loaded. */
function tab(): {
  type: (question: string, text: string, hints?: number) => void;
  of: (question: string) => unknown;
} {
  const store = new DraftStore(lesson);
  const fields = ["period", "force"].map((id) => {
    const { draft, hints } = store.of(id);
    const held = { text: draft?.[0] ?? "", hints };
    return { id, held, draft: () => [held.text], hints: () => held.hints };
  });
  store.begin(fields);
  return {
    type: (question, text, hints = 0) => {
      const field = fields.find(({ id }) => id === question);
      if (field) Object.assign(field.held, { text, hints });
      store.save(fields);
    },
    of: (question) => new DraftStore(lesson).of(question),
  };
}

it("answers that two tabs type stay beside each other", () => {
  const [one, two] = [tab(), tab()];
  one.type("period", "2.37", 1);
  two.type("force", "9.81");
  two.type("force", "9.8");
  expect(one.of("period")).toEqual({ draft: ["2.37"], hints: 1 });
  expect(one.of("force")).toEqual({ draft: ["9.8"], hints: 0 });
  // What was typed last goes before, and an answer may be taken back.
  two.type("period", "2.4");
  expect(one.of("period")).toEqual({ draft: ["2.4"], hints: 1 });
  one.type("period", "");
  expect(two.of("period")).toEqual({ draft: [""], hints: 1 });
});

it("nothing is saved until all fields are made", () => {
  localStorage.setItem("triad:draft:spin", JSON.stringify({ period: ["2"], "period#hints": ["2"] }));
  const store = new DraftStore(lesson);
  store.save([{ id: "period", draft: () => [""], hints: () => 0 }]);
  expect(store.of("period")).toEqual({ draft: ["2"], hints: 2 });
});

it("what was typed before a name was given goes on under it, where that one has nothing yet, and under no second name", () => {
  const of = (seed: string): DraftStore =>
    new DraftStore({ slug: "spin", has_variants: true, seed } as Lesson);
  const type = (seed: string, typed: Record<string, string>): void => {
    const store = of(seed);
    const text = { period: "", force: "" };
    const fields = (["period", "force"] as const).map((id) => ({
      id,
      draft: () => [text[id]],
      hints: () => (id === "force" ? 1 : 0),
    }));
    store.begin(fields);
    Object.assign(text, typed);
    store.save(fields);
  };
  type("Cyd", { period: "2.1" });
  type("", { period: "9", force: "29.43" });
  expect(of("Cyd").of("period").draft).toEqual(["2.1"]);
  expect(of("Cyd").of("force")).toEqual({ draft: ["29.43"], hints: 1 });
  expect(of("Dan").of("force").draft).toBeUndefined();
  expect(of("").of("force").draft).toBeUndefined();
});
