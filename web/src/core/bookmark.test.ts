import { expect, test } from "vitest";
import { parseBookmark } from "./bookmark";

test("a place is a lesson and a part of it, nothing else", () => {
  expect(parseBookmark('{"title":"Drift","href":"/lessons/drift#eq-15.2"}')).toEqual({
    title: "Drift",
    href: "/lessons/drift#eq-15.2",
  });
  expect(parseBookmark('{"title":"Drift","href":"/lessons/drift"}')?.href).toBe("/lessons/drift");
  for (const text of [
    null,
    "",
    "{",
    "3",
    '{"title":"x"}',
    '{"title":"x","href":"https://example.org"}',
    '{"title":"x","href":"javascript:1"}',
  ]) {
    expect(parseBookmark(text)).toBeNull();
  }
});
