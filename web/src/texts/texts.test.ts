import { readdirSync, readFileSync } from "node:fs";
import { join, sep } from "node:path";
import { fileURLToPath } from "node:url";
import ts from "typescript";
import { describe, expect, it } from "vitest";
import { de } from "./de";
import { classroom } from "./de/class";
import { frame } from "./de/frame";
import { inspector } from "./de/inspector";
import { learning } from "./de/learning";

const ROOT = fileURLToPath(new URL("..", import.meta.url));

/** The sources in which a text may stand, parsed. */
const sources = readdirSync(ROOT, { recursive: true, encoding: "utf8" })
  .filter((file) => file.endsWith(".ts") && !/\.(test|d)\.ts$/.test(file))
  .filter(
    (file) => !["texts", "testing"].includes(file.split(sep)[0] ?? "") && file !== join("api", "schema.ts"),
  )
  .map((file) =>
    ts.createSourceFile(file, readFileSync(join(ROOT, file), "utf8"), ts.ScriptTarget.Latest, true),
  );

/** Calls `see` with every node of every source. */
function walk(see: (node: ts.Node) => void): void {
  const visit = (node: ts.Node): void => {
    see(node);
    ts.forEachChild(node, visit);
  };
  for (const source of sources) visit(source);
}

const placeOf = (node: ts.Node): string => {
  const source = node.getSourceFile();
  return `${source.fileName}:${source.getLineAndCharacterOfPosition(node.getStart()).line + 1}`;
};

/** The words of a string; the values of a template are left out. */
function wordsOf(node: ts.Node): string | undefined {
  if (ts.isStringLiteralLike(node)) return node.text;
  if (!ts.isTemplateExpression(node)) return undefined;
  return [node.head.text, ...node.templateSpans.map((span) => span.literal.text)].join("\u0000");
}

/** Whether a node is the text of a call of `t` or `parts`. */
const isText = (node: ts.Node): boolean =>
  ts.isCallExpression(node.parent) &&
  ts.isIdentifier(node.parent.expression) &&
  ["t", "parts"].includes(node.parent.expression.text) &&
  node.parent.arguments[0] === node;

/** Attributes whose values nobody reads. */
const ATTRIBUTES =
  /^(?:class|id|type|for|role|href|rel|target|method|d|viewBox|transform|key|keys|shown|autocomplete|autocapitalize|scope|fill|stroke|spellcheck|inputmode|style|download|accept|value|kind|loading|block|aria-(?:live|hidden|controls|describedby|pressed|current)|data-.*)$/;
/** Functions that take a word of the machine, not of the reader. */
const MACHINE =
  /(?:querySelector(?:All)?|closest|matches|getExtension|toggle|add|remove|contains|startsWith|endsWith|includes|setAttribute|getPropertyValue|createElement(?:NS)?|(?:add|remove)EventListener|Event|send|ask|call|icon|getContext|join|split|replace(?:All)?)$/;
/** Names that are the same in every language, of things and of keys. */
const NAMES = new Set(
  "Triad CSV JSON SVG PNG Hz Fx Fy Fz Mx My Mz Python Julia Baumgarte GET POST PUT DELETE OPEN CLOSE PageDown PageUp ArrowRight ArrowLeft Backspace English Deutsch".split(
    " ",
  ),
);
/** What the server says, by which its words are known, and classes that are given as they are. */
const KNOWN = /^(?:(?:Right|Not right|Not answered)\.|button (?:primary|quiet)|primary play)$/;
/** What is written for the machine: markup, media types, selectors of style sheets, fonts. */
const CODE =
  /^\s*[<{]|\n {2}body \{|^Bearer |\0\/join$|^button,|^\/|\.html$|^\(prefers-|^[a-z]+\/[a-z+-]+(?:[,;]|$)|^[.#[:]|-apple-system|stroke(?:-width|-linejoin)?=|fill=|font-weight=|^x="|^viewBox="|MATLAB \/ Octave/;

/** Whether a string is written for a reader, by how it looks or where it stands. */
function isWritten(node: ts.Node, words: string): boolean {
  const parent = node.parent;
  const said = words.replaceAll("\u0000", " ").trim();
  if (!/\p{L}{2}/u.test(said) || NAMES.has(said) || KNOWN.test(said) || CODE.test(words)) return false;
  if (ts.isImportDeclaration(parent) || ts.isLiteralTypeNode(parent) || ts.isCaseClause(parent)) return false;
  if (ts.isPropertyAssignment(parent) && parent.name === node) return false;
  if (ts.isElementAccessExpression(parent)) return false;
  if (ts.isBinaryExpression(parent) && /^(?:[!=]==|in)$/.test(parent.operatorToken.getText())) return false;
  const prose = /^\p{Lu}\p{Ll}|\p{L}[,.:;]? \p{L}/u.test(said);
  for (let at: ts.Node = node; at.parent; at = at.parent) {
    const above = at.parent;
    if (ts.isPropertyAssignment(above)) {
      const name = above.name.getText().replaceAll('"', "");
      if (ATTRIBUTES.test(name)) return false;
      if (/^(?:aria-label|title|placeholder|alt)$/.test(name)) return true;
    }
    if (ts.isCallExpression(above) || ts.isNewExpression(above)) {
      const called = above.expression.getText();
      if (MACHINE.test(called)) return false;
      // Children of an element, and what is set or announced.
      const place = above.arguments?.indexOf(at as ts.Expression) ?? -1;
      if ((called === "h" && place >= 2) || (called === "setText" && place === 1) || called === "announce")
        return true;
      return prose;
    }
    // What a function gives back as any string at all.
    if (ts.isReturnStatement(above) && at === given(node) && givesString(above)) return true;
    if (ts.isFunctionLike(above)) return prose;
  }
  return prose;
}

/** Whether a string stands where an option or a column has its word, single and small: `["none", "none"]`, `column("speed")`. */
function isLabel(node: ts.Node, words: string): boolean {
  if (!/^\p{Ll}{4,}$/u.test(words)) return false;
  const above = node.parent;
  if (ts.isArrayLiteralExpression(above) && ts.isArrayLiteralExpression(above.parent))
    return above.elements[1] === node && wordsOf(above.elements[0] as ts.Node) === words;
  return ts.isCallExpression(above) && above.expression.getText() === "column" && above.arguments[0] === node;
}

/** The whole value that a string is a choice of. */
function given(node: ts.Node): ts.Node {
  const above = node.parent;
  return ts.isConditionalExpression(above) || ts.isParenthesizedExpression(above) ? given(above) : node;
}

function givesString(node: ts.ReturnStatement): boolean {
  let at: ts.Node = node;
  while (!ts.isFunctionLike(at)) at = at.parent;
  return at.type?.getText() === "string";
}

describe("the catalogue of texts", () => {
  const used = new Set<string>();
  walk((node) => {
    if (ts.isStringLiteralLike(node) && isText(node)) used.add(node.text);
  });

  it("has each text once, and only texts that the page says", () => {
    const kept = [frame, learning, inspector, classroom].flatMap((part) => Object.keys(part));
    expect(kept.filter((text, k) => kept.indexOf(text) !== k)).toEqual([]);
    expect(kept.filter((text) => !used.has(text))).toEqual([]);
    expect([...used].filter((text) => !(text in de))).toEqual([]);
  });

  it("has the same places and forms in both languages", () => {
    const places = (text: string): string[] =>
      [...new Set(Array.from(text.matchAll(/\{(\w+)\}/g), (found) => found[1] ?? ""))].sort();
    const forms = (text: string): number => text.split(" | ").length;
    for (const [english, german] of Object.entries(de)) {
      expect(places(german), english).toEqual(places(english));
      expect(forms(german), english).toBe(forms(english));
      for (const text of [english, german]) {
        expect(text, english).toBe(text.trim());
        expect(text, english).not.toBe("");
      }
    }
  });

  it("holds all that the page says", () => {
    const loose: string[] = [];
    walk((node) => {
      const words = wordsOf(node);
      if (words === undefined || isText(node) || !(isWritten(node, words) || isLabel(node, words))) return;
      loose.push(`${placeOf(node)} ${JSON.stringify(words)}`);
    });
    expect(loose).toEqual([]);
  });

  it("is not asked while a module is loaded: the language is not there yet", () => {
    const early: string[] = [];
    walk((node) => {
      if (!ts.isStringLiteralLike(node) || !isText(node)) return;
      let at: ts.Node | undefined = node;
      while (at && !ts.isFunctionLike(at) && !(ts.isPropertyDeclaration(at) && !isStatic(at))) at = at.parent;
      if (!at && node.getSourceFile().fileName !== join("player", "file.ts")) early.push(placeOf(node));
    });
    expect(early).toEqual([]);
  });
});

const isStatic = (node: ts.PropertyDeclaration): boolean =>
  node.modifiers?.some((modifier) => modifier.kind === ts.SyntaxKind.StaticKeyword) ?? false;
