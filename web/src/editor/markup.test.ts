import { expect, it } from "vitest";
import { isMarkup, lineNamed } from "./markup";

it("tells a robot from a scene", () => {
  for (const text of [
    '<?xml version="1.0"?>\n<robot name="a"/>',
    "\uFEFF\n <robot/>",
    "<!-- arm --><robot/>",
  ])
    expect(isMarkup(text)).toBe(true);
  for (const text of ['{"name": "<robot>"}', "", " < 3", "a <b"]) expect(isMarkup(text)).toBe(false);
});

it("finds the line that a refusal names", () => {
  const text = '<robot>\r\n  <link name="a"/>\r\n</robot>';
  expect(lineNamed("line 2: link a moves but has no mass", text)).toEqual({
    line: 2,
    text: '<link name="a"/>',
  });
  for (const detail of ["line 9: beyond", "no line", undefined, "line 0: none"])
    expect(lineNamed(detail, text)).toBeUndefined();
});
