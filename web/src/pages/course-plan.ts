// A choice of lessons in an order: what is used before it is introduced, and the file that a course is made of.
import type { NotionGraph } from "../api/types";

export type Node = NotionGraph["lessons"][number];

/** A lesson that may be taken. */
export interface Row {
  lesson: Node;
  taken: boolean;
}

/** A notion that a lesson of the plan uses, and the place of the lesson that brings it; none if no earlier one does. */
export interface Use {
  notion: string;
  /** Row that introduces it, wherever it stands and whether it is taken or not. */
  from: number | undefined;
  met: boolean;
}

/** The rows of a course as it is: its lessons, then those at hand beside them. */
export const rowsOf = (graph: NotionGraph): Row[] => [
  ...graph.lessons.map((lesson) => ({ lesson, taken: true })),
  ...graph.others.map((lesson) => ({ lesson, taken: false })),
];

/** What the lesson at a place uses, with where it comes from in this order. */
export function uses(rows: Row[], assumes: string[], place: number): Use[] {
  const needs = rows[place]?.lesson.needs ?? [];
  return needs.map(({ notion }) => {
    const brings = (row: Row): boolean => row.lesson.introduces.includes(notion);
    const earlier = rows.findIndex((row, at) => at < place && row.taken && brings(row));
    const anywhere = rows.findIndex((row, at) => at !== place && brings(row));
    const from = earlier >= 0 ? earlier : anywhere;
    return { notion, from: from < 0 ? undefined : from, met: earlier >= 0 || assumes.includes(notion) };
  });
}

/** The places of the lessons that are taken and use something before it is introduced. */
export const unready = (rows: Row[], assumes: string[]): number[] =>
  rows.flatMap((row, at) => (row.taken && uses(rows, assumes, at).some((use) => !use.met) ? [at] : []));

/** Takes what the taken lessons need, and puts it before them: the order stays as it is where it can. */
export function completed(rows: Row[], assumes: string[]): Row[] {
  let plan = rows.map((row) => ({ ...row }));
  // Each round puts one lesson where it is needed; a circle of needs would go round for ever.
  for (let round = 0; round < plan.length * plan.length; round += 1) {
    const wanting = plan.findIndex(
      (row, at) => row.taken && uses(plan, assumes, at).some((use) => !use.met && use.from !== undefined),
    );
    if (wanting < 0) break;
    const missing = uses(plan, assumes, wanting).find((use) => !use.met && use.from !== undefined);
    const row = plan[missing?.from ?? -1];
    if (!row) break;
    row.taken = true;
    // It stands early enough already.
    if ((missing?.from ?? 0) < wanting) continue;
    const others = plan.filter((one) => one !== row);
    plan = [...others.slice(0, wanting), row, ...others.slice(wanting)];
  }
  return plan;
}

/** The same rows with one of them a place further up or down. */
export function moved(rows: Row[], place: number, by: -1 | 1): Row[] {
  const [here, there] = [rows[place], rows[place + by]];
  if (!here || !there) return rows;
  const next = [...rows];
  next[place] = there;
  next[place + by] = here;
  return next;
}

const quoted = (text: string): string => JSON.stringify(text);

/** `course.toml` of what is taken. */
export function courseFile(graph: NotionGraph, rows: Row[]): string {
  const taken = rows.filter((row) => row.taken).map((row) => row.lesson);
  const { opens } = graph;
  const when = [
    `right = ${opens.right ?? false}`,
    opens.attempts == null ? "" : `attempts = ${opens.attempts}`,
    opens.choices == null ? "" : `choices = ${opens.choices}`,
  ];
  const parts = taken.flatMap(({ part, slug }, at) =>
    part && part !== taken[at - 1]?.part
      ? [`[[parts]]\ntitle = ${quoted(part)}\nfrom = ${quoted(slug)}\n`]
      : [],
  );
  return [
    "format_version = 1",
    `title = ${quoted(graph.title)}`,
    "# Lessons that are built into the program can be taken, too.",
    "built_in = true",
    ...(graph.assumes.length > 0 ? [`assumes = [${graph.assumes.map(quoted).join(", ")}]`] : []),
    `opens = { ${when.filter(Boolean).join(", ")} }`,
    "lessons = [",
    ...taken.map(({ slug }) => `  ${quoted(slug)},`),
    "]",
    "",
    ...parts,
  ].join("\n");
}
