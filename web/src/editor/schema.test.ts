import { describe, expect, it } from "vitest";
import { complete, placeOf } from "./schema";

const schema = {
  properties: {
    name: { type: "string", description: "Short name" },
    bodies: { type: "array", items: { $ref: "#/$defs/Body" } },
    loads: {
      type: "array",
      items: {
        oneOf: [
          { properties: { type: { const: "spring" }, stiffness: { type: "number" } } },
          { properties: { type: { const: "force" }, force: { type: "number" } } },
        ],
      },
    },
  },
  $defs: {
    Body: {
      properties: {
        name: { type: "string" },
        mass: { type: "number", description: "Mass, kg" },
        coordinates: { anyOf: [{ $ref: "#/$defs/Kind" }, { type: "null" }] },
      },
    },
    Kind: {
      oneOf: [
        { const: "full", description: "12" },
        { const: "reduced", description: "9" },
      ],
    },
  },
};
/** The cursor is where | stands. */
const at = (marked: string): ReturnType<typeof complete> =>
  complete(schema, marked.replace("|", ""), marked.indexOf("|"));
const texts = (marked: string): string[] => at(marked)?.offers.map((offer) => offer.text) ?? [];

describe("completion", () => {
  it("offers the keys that are not there yet, with what they mean", () => {
    expect(texts('{"bodies": [{"name": "bob", "|"}]}')).toEqual(['"mass": ', '"coordinates": ']);
    expect(at('{"bodies": [{"ma|"}]}')?.offers[0]).toEqual({ text: '"mass": ', about: "Mass, kg" });
    expect(texts('{"bodies": [{"|", "mass": 1}]}')).toEqual(['"name": ', '"coordinates": ']);
  });
  it("offers words at a value, through references and alternatives", () => {
    expect(texts('{"bodies": [{"coordinates": "|"}]}')).toEqual(['"full"', '"reduced"']);
    expect(texts('{"bodies": [{"coordinates": "re|')).toEqual(['"reduced"']);
  });
  it("knows the kind of an object by what is written in it", () => {
    expect(texts('{"loads": [{"type": "force", "|"}]}')).toEqual(['"force": ']);
  });
  it("replaces only the name where a value follows", () => {
    expect(texts('{"bodies": [{"ma|": 3}]}')).toEqual(['"mass"']);
  });
  it("finds its place in text that is not whole", () => {
    expect(placeOf('{"bodies": [{"a": 1}, {"b": [2, ', 32)?.path).toEqual(["bodies", "1", "b", "1"]);
  });
});
