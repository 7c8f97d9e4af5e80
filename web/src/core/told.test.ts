import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { describe, expect, it } from "vitest";
import { told } from "../texts/de/told";
import { toldOfRuns } from "../texts/de/told-runs";
import { formsOf, translated } from "./told";

const ROOT = fileURLToPath(new URL("../../..", import.meta.url));
const catalogue = { ...told, ...toldOfRuns };
const forms = formsOf(catalogue);
const german = (sentence: string): string | undefined => translated(sentence, forms);

/** Sentences of libraries and of this page, which do not stand in our own Rust. */
const ELSEWHERE =
  /^(?:unknown (?:field|variant)|invalid (?:type|length|value)|duplicate field|trailing comma|EOF while|\{path\} \(line \{line\}\))/;

it("parts names that are made of its own words in one way, the first place the shortest", () => {
  const own = formsOf({ "{a} at {b} at {c}.": "{c}|{b}|{a}" });
  expect(translated("x at y at z.", own)).toBe("z|y|x");
  expect(translated(" at  at  at  at .", own)).toBe(" at  at ||");
  expect(translated("x at y at z", own)).toBeUndefined();
  expect(translated("x at .", own)).toBeUndefined();
});

describe("what the server says", () => {
  it("is said in German with its values", () => {
    expect(german('joint "pin": there is no body "bobb"')).toBe("Gelenk „pin“: Es gibt keinen Körper „bobb“");
    expect(german("bodies[0].mas (line 9): unknown field `mas`, expected one of `name`, `mass`")).toBe(
      "bodies[0].mas (Zeile 9): unbekannter Schlüssel `mas`, möglich sind `name`, `mass`",
    );
    // Sentences in sentences; one that is not known leaves the whole as it is.
    expect(
      german(
        'the run stops at t = 0.1 s: its 2 steps are used up (after 2 steps; "C" is about to lose its hold, of which 1e-9 is left)',
      ),
    ).toBe(
      "der Lauf endet bei t = 0.1 s: Seine 2 Schritte sind verbraucht (nach 2 Schritten; „C“ verliert gleich seinen Halt, von dem 1e-9 übrig ist)",
    );
    expect(german('body "bob": it is a matter of taste')).toBeUndefined();
    expect(german("this server runs without accounts: its grades are for yourself")).toMatch(
      /^Dieser Server/,
    );
    expect(german("for a class start it with `triad serve --class`")).not.toContain("`");
    expect(german("x".repeat(5000))).toBeUndefined();
  });

  it("has the same places in both languages", () => {
    const places = (text: string): string[] => [...new Set(text.match(/\{\w+\}/g) ?? [])].sort();
    for (const [english, said] of Object.entries(catalogue))
      expect(places(said), english).toEqual(places(english));
    expect(Object.keys(told).filter((sentence) => sentence in toldOfRuns)).toEqual([]);
  });

  it("stands in the sources with these words", () => {
    const sources = ["engine", "server/src"].flatMap((folder) =>
      readdirSync(join(ROOT, folder), { recursive: true, encoding: "utf8" })
        .filter((file) => file.endsWith(".rs"))
        .map((file) => readFileSync(join(ROOT, folder, file), "utf8")),
    );
    const text = sources
      .join("\n")
      .replace(/\\\n\s*/g, "")
      .replaceAll('\\"', '"');
    // Titles are codes, read as words.
    const isTitle = (sentence: string): boolean => /^[A-Z][a-z ]*$/.test(sentence);
    const code = (sentence: string): string => `"${sentence.toLowerCase().replaceAll(" ", "-")}"`;
    const lost = Object.keys(catalogue).filter((sentence) => {
      if (ELSEWHERE.test(sentence)) return false;
      if (isTitle(sentence)) return !text.includes(code(sentence));
      // Some are put together there, of pieces with four words and more.
      return sentence
        .split(/\{\w+\}|[":;,()]| together with/)
        .some((part) => part.trim().split(" ").length > 3 && !text.includes(part.trim()));
    });
    expect(lost).toEqual([]);
  });

  it("is said of all refusals that were reviewed", () => {
    const lines = ["scene", "model", "constraint", "run", "analysis"].flatMap((kind) =>
      readFileSync(join(ROOT, `tests/data/reviewed/refusals-${kind}.snap`), "utf8").split("\n"),
    );
    const sentences = lines.flatMap((line) => {
      const [, detail, hint] = /^ {2}(?:(.+) \[[a-z-]+\]|try: (.+))$/.exec(line) ?? [];
      return detail ?? hint ?? [];
    });
    const left = sentences.filter((sentence) => german(sentence) === undefined && !LEFT.test(sentence));
    expect(sentences.length).toBeGreaterThan(100);
    expect([...new Set(left)]).toEqual([]);
  });
});

/** Reviewed sentences that are for authors in Rust and Python, and for a terminal: they stay English. */
const LEFT =
  /^(?:Built-in scenes|"[a-z-]+" needs a whole number|For example "|two loads are called|Give each load a name|load "wind" |Let it act on a body|Look for a division|the scene asks for taylor|Leave the integrator to `auto`|nobody waits|Ask again)/;
