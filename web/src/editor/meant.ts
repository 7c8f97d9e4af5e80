// What an author may have meant by a word that a scene does not know.

import type { Problem } from "../api/types";
import { t } from "../core/texts";
import type { SaidProblem } from "../ui/notice";
import { locate } from "./pointer";

/** A word of the text, with its quotes from `from` to `to`, and the word that was probably meant. */
export interface Meant {
  given: string;
  meant: string;
  from: number;
  to: number;
}

const UNKNOWN = /unknown (field|variant) `([^`]+)`, expected (?:one of )?(.+)$/;
const HINTED = /^Did you mean "([^"]+)"\?$/;

/** The word that a problem is about, and the known word that is nearest to it; undefined where none is near. */
export function meantBy(problem: Problem, text: string): Meant | undefined {
  const place = problem.errors?.[0]?.pointer;
  if (!place) return undefined;
  const value = locate(text, place);
  const [, kind, given, known] = UNKNOWN.exec(problem.detail ?? "") ?? [];
  if (given && known) {
    const words = Array.from(known.matchAll(/`([^`]+)`/g), (found) => found[1] ?? "");
    const meant = nearest(given, words);
    const quoted = JSON.stringify(given);
    const from = kind === "field" ? text.lastIndexOf(quoted, value) : value;
    if (!meant || from < 0 || !text.startsWith(quoted, from)) return undefined;
    return { given, meant, from, to: from + quoted.length };
  }
  const meant = HINTED.exec(problem.hint ?? "")?.[1];
  const written = /^"(?:[^"\\]|\\.)*"/.exec(text.slice(value))?.[0];
  return meant && written
    ? { given: JSON.parse(written) as string, meant, from: value, to: value + written.length }
    : undefined;
}

/** A problem in words for who sees the text: its line there, and no command of a terminal. */
export function inText(problem: Problem, line: number | undefined, offered: boolean): SaidProblem {
  if (line === undefined || problem.code !== "scene-syntax") return problem;
  const detail = problem.detail?.replace(/ \(line \d+, column \d+\)/, ` (line ${line})`);
  const hint = offered ? undefined : t("Ctrl and the space bar list the words that fit at the cursor.");
  const errors = problem.errors?.map((place) =>
    place.detail === problem.detail && detail ? { ...place, detail } : place,
  );
  return { ...problem, detail, hint, errors, said: ["hint"] };
}

/** The word that needs the fewest changes, if those are at most a third of its letters. */
export function nearest(given: string, words: string[]): string | undefined {
  const all = words.map((word) => ({ word, changes: changes(given.toLowerCase(), word) }));
  const best = all.sort((a, b) => a.changes - b.changes)[0];
  return best && best.changes <= Math.max(1, Math.floor(best.word.length / 3)) ? best.word : undefined;
}

/** Letters to put in, take out or exchange (Levenshtein). */
function changes(a: string, b: string): number {
  let row = Array.from({ length: b.length + 1 }, (_, k) => k);
  for (const [i, letter] of [...a].entries()) {
    const next = [i + 1];
    for (const [j, other] of [...b].entries())
      next.push(
        Math.min((row[j] ?? 0) + Number(letter !== other), (row[j + 1] ?? 0) + 1, (next[j] ?? 0) + 1),
      );
    row = next;
  }
  return row[b.length] ?? 0;
}
