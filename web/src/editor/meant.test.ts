import { describe, expect, it } from "vitest";
import { inText, meantBy, nearest } from "./meant";

const text =
  '{\n  "bodies": [{ "name": "bob", "masss": 1 }],\n  "joints": [{ "type": "revolut", "body_j": "bobb" }]\n}';
const mended = (problem: Parameters<typeof meantBy>[0]): string | undefined => {
  const found = meantBy(problem, text);
  return found && text.slice(0, found.from) + JSON.stringify(found.meant) + text.slice(found.to);
};

describe("what was meant", () => {
  it("is the key, the word or the name that is nearest, at its own place", () => {
    const field =
      "bodies[0].masss (line 1, column 3): unknown field `masss`, expected one of `name`, `mass`, `inertia`";
    expect(mended({ title: "", detail: field, errors: [{ pointer: "#/bodies/0/masss", detail: "" }] })).toBe(
      text.replace("masss", "mass"),
    );
    const variant = "joints[0].type: unknown variant `revolut`, expected one of `spherical`, `revolute`";
    expect(mended({ title: "", detail: variant, errors: [{ pointer: "#/joints/0/type", detail: "" }] })).toBe(
      text.replace("revolut", "revolute"),
    );
    const hint = 'Did you mean "bob"?';
    expect(mended({ title: "", hint, errors: [{ pointer: "#/joints/0/body_j", detail: "" }] })).toBe(
      text.replace("bobb", "bob"),
    );
  });

  it("is told with the line of the text that is seen, once, and without a terminal", () => {
    const detail =
      "bodies[0].masss (line 1, column 17): unknown field `masss`, expected one of `name`, `mass`";
    const hint = "Compare the place with the JSON Schema of a scene (`triad schema`).";
    const problem = {
      title: "Scene syntax",
      code: "scene-syntax",
      detail,
      hint,
      errors: [{ pointer: "#/bodies/0/masss", detail }],
    };
    const told = inText(problem, 2, true);
    expect(told.detail).toBe(
      "bodies[0].masss (line 2): unknown field `masss`, expected one of `name`, `mass`",
    );
    expect(told.errors?.[0]?.detail).toBe(told.detail);
    expect(told.hint).toBeUndefined();
    expect(inText(problem, 2, false).hint).toMatch(/^Ctrl/);
    expect(inText({ ...problem, code: "unknown-body" }, 2, false).hint).toBe(hint);
  });

  it("is not guessed where nothing is near", () => {
    expect(nearest("colour", ["name", "mass"])).toBeUndefined();
    expect(nearest("tipe", ["name", "type"])).toBe("type");
    expect(meantBy({ title: "", detail: "a number is missing" }, text)).toBeUndefined();
  });
});
