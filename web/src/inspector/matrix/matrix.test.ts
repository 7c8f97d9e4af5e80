import { describe, expect, it } from "vitest";
import { cellAt, groups, layout } from "./matrix";

describe("matrix layout", () => {
  it("groups names and finds cells", () => {
    expect(groups(["bob: uu", "bob: vv", "pin: CP.x"])).toEqual([
      { name: "bob", from: 0, count: 2 },
      { name: "pin", from: 2, count: 1 },
    ]);
    expect(groups(["λ bob: uu", "λ bob: vv", "λ pin: CP.x"]).map((group) => group.name)).toEqual([
      "λ bob",
      "λ pin",
    ]);
    expect(groups(["bob.rx", "arm.rx"]).map((group) => group.name)).toEqual(["bob", "arm"]);
    const grid = layout(3, 12, 700, true);
    expect(cellAt(grid, 3, 12, grid.left + 2.5 * grid.cell, grid.top + 1)).toEqual({ row: 0, column: 2 });
    expect(cellAt(grid, 3, 12, grid.left - 1, grid.top + 1)).toBeUndefined();
  });
});
