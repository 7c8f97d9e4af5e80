import { describe, expect, it } from "vitest";
import { pack, type SharedView, unpack } from "./shared-view";

describe("a link", () => {
  it("is the same when it is read again", async () => {
    const seen: SharedView = {
      numbers: { values: { mass: 2.5 }, places: { "/simulation/stabilization": { kind: "projection" } } },
      time: 1.25,
      plays: true,
      joint: "pin “A”",
      panel: "multipliers",
      picture: "drawing",
      drawn: "body:bob",
      told: "i.center.body",
      scene: '{"name":"x"}',
    };
    const text = await pack(seen);
    expect(text).toMatch(/^[\w-]+$/);
    expect(await unpack(text)).toEqual(seen);
  });
  it("that is broken or forged does no harm", async () => {
    expect(await unpack("%%%")).toBeUndefined();
    expect(await unpack("AAAA")).toBeUndefined();
    const forged = await pack({
      time: -1,
      joint: 7,
      numbers: { values: { mass: "x" }, places: {} },
      picture: "evil",
      plays: "yes",
    } as unknown as SharedView);
    expect(await unpack(forged)).toEqual({});
  });
  it("does not unpack without bound", async () => {
    expect(await unpack(await pack({ scene: "a".repeat(3_000_000) }))).toBeUndefined();
  });
});
