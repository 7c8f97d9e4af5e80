import { expect, it } from "vitest";
import { firstFault } from "./json";
import { lineOf } from "./pointer";

/** The line and the words of the first fault. */
const found = (text: string): string => {
  const fault = firstFault(text);
  return fault ? `${lineOf(text, fault.at)}: ${fault.why}` : "";
};

it("the line of a fault is that of what does not fit, whatever the browser says of it", () => {
  expect(found('{\n"gravity": [0, NaN, 1],\n"bodies": []\n}')).toMatch(/^2: NaN is neither a number/);
  expect(found('{\n"a": 1\n"b": 2\n}')).toBe("3: A comma is missing before this.");
  expect(found('{\n"a": 1,\n}')).toBe("2: The comma before } is too many.");
  expect(found('{\n"a": [1, 2\n}')).toBe("3: } stands here, where ] is missing.");
  expect(found('{\n"a": "b\n}')).toBe("2: This text has no quote at its end.");
  expect(found("{\n'a': 1\n}")).toMatch(/^2: A text stands between straight double quotes/);
  expect(found('{\n"a" 1\n}')).toBe("2: A colon is missing between the key and its value.");
  expect(found('{\n"a": .5\n}')).toMatch(/^2: \.5 is not a number/);
  expect(found('{\n"a": 01\n}')).toMatch(/^2: 01 is not a number/);
  expect(found("{\na: 1\n}")).toBe("2: The key a stands between double quotes.");
  expect(found('{\n"a": 1 // one\n}')).toBe("2: A comment: JSON has none.");
  expect(found('{\n"a": \n}')).toBe("3: A value is missing before }");
  expect(found('{\n"a": "C:\\q"\n}')).toMatch(/^2: In this text stands a sign/);
  expect(found('{\n"a": 1\n')).toBe("3: The text ends here, and } is missing.");
  expect(found("")).toBe("1: The text ends here, and something is still open.");
  expect(found('{"a": 1} 2')).toBe("1: The scene ended before this.");
});

it("a key that is written twice is told at its second place, however it is written", () => {
  expect(firstFault('{"a": 1}')).toBeUndefined();
  expect(found('{\n"mass": 1,\n"mass": 2\n}')).toMatch(/^3: The key mass is written twice/);
  expect(found('{\n"b": [{"mass": 1,\n"\\u006dass": 2}]\n}')).toMatch(/^3: The key mass is written twice/);
  expect(firstFault('{"a": 1, "a": 2}')?.twice).toBe(true);
  // What is not JSON at all comes first where it stands first.
  expect(firstFault('{"a": 01, "a": 2}')?.twice).toBeUndefined();
  // The same key of another object is another one.
  expect(found('{"a": {"a": 1}, "b": [{"a": 1}, {"a": 2}]}')).toBe("");
});

it("what is JSON has no fault", () => {
  expect(found('{ "a": [1, -2.5e-3, {"b": "x\\n\\u00e9"}, [], {}], "c": true, "d": null }')).toBe("");
});

it("every cut of a scene is refused at its end", () => {
  const text = JSON.stringify({ a: [1, -2.5, { b: "x" }], c: true }, null, 1);
  for (let cut = 0; cut < text.length; cut += 1) expect(firstFault(text.slice(0, cut))?.why).toBeTruthy();
});
