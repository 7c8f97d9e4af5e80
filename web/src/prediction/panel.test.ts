import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { Lesson, Prediction } from "../api/types";
import type { Session } from "../session/session";
import { kept } from "../testing/kept";
import { fake, fakePage, found } from "../testing/page";
import { PredictionForm } from "./form";
import { PredictionPanel } from "./panel";

vi.mock("../ui/shell", () => ({ setStudent: vi.fn() }));
vi.mock("../core/maths", () => ({ setMaths: () => Promise.resolve() }));

beforeEach(() => {
  fakePage();
  vi.stubGlobal("localStorage", kept());
  localStorage.setItem("triad:student", "Eve");
});
afterEach(() => vi.unstubAllGlobals());

const asked = (more: object = {}): Prediction =>
  ({
    id: "force",
    html: "How large?",
    options: [{ id: "three", html: "Three times" }],
    seen_at: 0.6,
    asks_why: true,
    points: 0,
    ...more,
  }) as unknown as Prediction;
const given = {
  prediction: "force",
  choice: "three",
  why: "",
  outcome: { happens: "three", html: "Three times the weight." },
};

/** A run, and a way to let it come to a time with numbers. */
async function shown(prediction: Prediction, before: object[] = [given]) {
  vi.stubGlobal("fetch", () => Promise.resolve(Response.json(before)));
  const heard: Record<string, () => void> = {};
  const session = {
    numbers: { values: {}, places: {} },
    altered: false,
    view: { parameters: [{ name: "speed", initial: 0 }], original: {} },
    latest: { time: 0, finished: false },
    hold: vi.fn(),
    release: vi.fn(),
    on: (event: string, listener: () => void) => {
      heard[event] = listener;
      return () => undefined;
    },
  };
  const panel = new PredictionPanel({ slug: "spin", predictions: [prediction] } as unknown as Lesson);
  panel.hold(session as unknown as Session);
  await panel.given;
  const text = (): string => fake(panel.root).textContent;
  return (time: number, values: Record<string, number> = {}, altered = false): string => {
    Object.assign(session, { latest: { time, finished: false }, numbers: { values, places: {} }, altered });
    heard.shown?.();
    return text();
  };
}

it("what happened is told of the run that was asked about, and of no other", async () => {
  const at = await shown(asked());
  expect(at(0)).toContain("Run it: at 0.600 s");
  expect(at(0.7, { speed: 8 })).toMatch(/not the one that was asked about: run it .* as its author wrote it/);
  expect(at(0.7, {}, true)).not.toContain("What happened");
  expect(at(0.7)).toContain("What happened: Three times");
  // It stays, and says of which run it is.
  expect(at(0.9, { speed: 8 })).toContain("What happened in the run that was asked about: Three times");
  expect(at(0.9)).toContain("What happened: Three times");
});

it("a run that was asked about with other numbers is the one with these", async () => {
  const before = { ...given, prediction: "other" };
  const at = await shown(asked({ with: { speed: 2 } }), [before, given]);
  // It was seen in an earlier visit.
  expect(at(0)).toContain("What happened in the run that was asked about");
  expect(at(0.7, { speed: 2 })).toContain("What happened: Three times");
});

it("the words of a reason are there again when the form is made anew, until they are given", async () => {
  const give = vi.fn(() => Promise.resolve());
  const form = (): PredictionForm => new PredictionForm(asked(), "why:spin:force", give);
  const first = form();
  const why = found(first.root, "input");
  why.value = "Because of energy";
  why.dispatchEvent(new Event("input"));
  const again = form();
  expect(found(again.root, "input").value).toBe("Because of energy");
  found(again.root, ".choice").click();
  fake(again.root).dispatchEvent(new Event("submit", { cancelable: true }));
  await vi.waitFor(() => expect(localStorage.getItem("triad:why:spin:force")).toBeNull());
  expect(give).toHaveBeenCalledWith({ name: "Eve", choice: "three", why: "Because of energy" });
  expect(found(form().root, "input").value).toBe("");
});
