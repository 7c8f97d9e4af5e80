import { describe, expect, it } from "vitest";
import { lineOf, locate, pretty } from "./pointer";

const TEXT = `{
  "name": "a, \\"b\\": {",
  "bodies": [
    { "name": "bob", "mass": 1, "position": [0, -1, 0] },
    { "name": "arm", "mass": -2 }
  ],
  "a/b": true
}`;

describe("locate", () => {
  const found = (pointer: string): string =>
    TEXT.slice(locate(TEXT, pointer))
      .split(/[,\n}\]]/)[0]
      ?.trim() ?? "";

  it("finds members, elements and escaped names", () => {
    expect(found("/bodies/1/mass")).toBe("-2");
    expect(found("/bodies/0/position/1")).toBe("-1");
    expect(found("/a~1b")).toBe("true");
    expect(lineOf(TEXT, locate(TEXT, "#/bodies/1/mass"))).toBe(5);
  });

  it("stops at the deepest part that exists", () => {
    expect(lineOf(TEXT, locate(TEXT, "/bodies/1/inertia/principal"))).toBe(5);
    expect(locate(TEXT, "/joints/0")).toBe(0);
  });

  it("survives text that is not JSON", () => {
    expect(locate('{"a": [1, 2', "/a/5")).toBe(6);
    expect(locate("", "/a")).toBe(0);
    expect(locate('{"a" 1}', "/b")).toBe(0);
  });
});

describe("pretty", () => {
  it("keeps vectors on one line and the value the same", () => {
    const value = {
      gravity: [0, -9.81, 0],
      bodies: [
        {
          name: "b",
          tensor: [
            [1, 0, 0],
            [0, 1e-3, 0],
            [0, 0, 1],
          ],
        },
      ],
    };
    expect(pretty(value)).toContain('"gravity": [0, -9.81, 0]');
    expect(JSON.parse(pretty(value))).toEqual(value);
  });
});
