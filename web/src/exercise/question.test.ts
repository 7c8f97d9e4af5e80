import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { Lesson, Question, QuestionVerdict } from "../api/types";
import { fake, fakePage, found } from "../testing/page";
import { questionField } from "./question";

vi.mock("../core/maths", () => ({ setMaths: () => Promise.resolve() }));

beforeEach(fakePage);
afterEach(() => vi.unstubAllGlobals());

const verdict = (mark: string): QuestionVerdict =>
  ({
    id: "t",
    verdict: mark,
    earned: 3,
    possible: 3,
    message_html: "<p>So it is.</p>",
  }) as unknown as QuestionVerdict;

it("a verdict is that of the answer that was judged: beside another one it says so, and marks nothing", () => {
  const question = { id: "t", kind: "formula", prompt_html: "", rule: "", points: 3, hints_available: 0 };
  const lesson = { slug: "spin", seed: "" } as Lesson;
  vi.stubGlobal("fetch", () => new Promise(() => undefined));
  const field = questionField(
    lesson,
    question as unknown as Question,
    1,
    { draft: undefined, hints: 0 },
    vi.fn(),
    () => undefined,
  );
  const input = found(field.root, "input");
  const type = (text: string): void => {
    input.value = text;
    input.dispatchEvent(new Event("input", { bubbles: true }));
  };
  const seen = (): [string, boolean, boolean] => [
    fake(field.root)
      .classList.all()
      .filter((name) => name.startsWith("is-"))
      .join(),
    /earlier answer/.test(found(field.root, ".verdict-slot").textContent),
    input.hasAttribute("aria-invalid"),
  ];
  type("29.4");
  field.show(verdict("right"), field.answer());
  expect(seen()).toEqual(["is-right", false, false]);
  type("99");
  expect(seen()).toEqual(["", true, false]);
  expect(found(field.root, ".verdict-slot").textContent).toContain("Right");
  type("29.4");
  expect(seen()).toEqual(["is-right", false, false]);
  // Changed while it was being checked.
  const sent = field.answer();
  type("7.77");
  field.show(verdict("wrong"), sent);
  expect(seen()).toEqual(["", true, false]);
  type("29.4");
  expect(seen()).toEqual(["is-wrong", false, true]);
  field.show(undefined, {});
  expect(seen()).toEqual(["", false, false]);
});
