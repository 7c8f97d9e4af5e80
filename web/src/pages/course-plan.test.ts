import { expect, it } from "vitest";
import type { NotionGraph } from "../api/types";
import { completed, courseFile, moved, rowsOf, unready, uses } from "./course-plan";

const lesson = (slug: string, introduces: string[], needs: string[], part?: string) => ({
  slug,
  number: 1,
  title: slug.toUpperCase(),
  minutes: 30,
  introduces,
  needs: needs.map((notion) => ({ notion, met: true })),
  ...(part ? { part } : {}),
});

const graph: NotionGraph = {
  title: 'A "course"',
  opens: { right: true, attempts: 6, choices: null },
  assumes: ["vector"],
  lessons: [
    lesson("rows", ["row"], ["vector"], "One"),
    lesson("forces", ["force"], ["row"], "One"),
    lesson("friction", [], ["force", "row"], "Two"),
  ],
  others: [lesson("ranks", ["rank"], ["row"])],
};

it("finds what is used before it is introduced", () => {
  const rows = rowsOf(graph);
  expect(unready(rows, graph.assumes)).toEqual([]);
  expect(unready(rows, [])).toEqual([0]);
  expect(unready(moved(rows, 0, 1), graph.assumes)).toEqual([0]);
  const without = rows.map((row, at) => ({ ...row, taken: row.taken && at !== 1 }));
  expect(uses(without, graph.assumes, 2)).toEqual([
    { notion: "force", from: 1, met: false },
    { notion: "row", from: 0, met: true },
  ]);
});

it("takes what is needed, and puts it before", () => {
  const slugs = (rows: ReturnType<typeof rowsOf>): string[] =>
    rows.filter((row) => row.taken).map((row) => row.lesson.slug);
  const alone = rowsOf(graph).map((row) => ({ ...row, taken: row.lesson.slug === "friction" }));
  expect(slugs(completed(alone, graph.assumes))).toEqual(["rows", "forces", "friction"]);
  const turned = [...rowsOf(graph)].reverse();
  expect(slugs(completed(turned, graph.assumes))).toEqual(["rows", "forces", "friction"]);
  // A circle of needs ends, and stays to be seen.
  const circle: NotionGraph = {
    ...graph,
    lessons: [lesson("a", ["x"], ["y"]), lesson("b", ["y"], ["x"])],
    others: [],
  };
  expect(unready(completed(rowsOf(circle), []), [])).toHaveLength(1);
});

it("writes the file of a course", () => {
  const rows = rowsOf(graph).map((row) => ({ ...row, taken: row.lesson.slug !== "forces" }));
  expect(courseFile(graph, rows)).toBe(
    `format_version = 1
title = "A \\"course\\""
# Lessons that are built into the program can be taken, too.
built_in = true
assumes = ["vector"]
opens = { right = true, attempts = 6 }
lessons = [
  "rows",
  "friction",
  "ranks",
]

[[parts]]
title = "One"
from = "rows"

[[parts]]
title = "Two"
from = "friction"
`,
  );
});
