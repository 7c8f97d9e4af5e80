import { expect, it } from "vitest";
import { words } from "./explanation";

it("counts words as the grader does", () => {
  expect(words("")).toBe(0);
  expect(words("  The bar\ndoes no work: 1 + 1 = 2 … ")).toBe(5);
  expect(words("λ größer z. B.")).toBe(4);
  expect(words("因为约束力不做功，所以能量守恒。")).toBe(7);
  expect(words("ไม่ทำงาน λ ของ Φ 2")).toBe(7);
});
