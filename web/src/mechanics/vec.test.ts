import { describe, expect, it } from "vitest";
import { axesOf, norm, sub } from "./vec";

describe("axesOf", () => {
  it("agrees between the three ways to state a turn", () => {
    const turn = Math.PI / 3;
    const axis = axesOf({ axis: [0, 0, 2], angle: turn });
    const quaternion = axesOf({ quaternion: [Math.cos(turn / 2), 0, 0, Math.sin(turn / 2)] });
    const vectors = axesOf({
      u: [Math.cos(turn), Math.sin(turn), 0],
      v: [-Math.sin(turn), Math.cos(turn), 0],
    });
    for (const k of [0, 1, 2] as const) {
      expect(norm(sub(axis[k], quaternion[k]))).toBeLessThan(1e-15);
      expect(norm(sub(axis[k], vectors[k]))).toBeLessThan(1e-15);
    }
  });
});
