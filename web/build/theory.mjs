// Writes docs/theory-mathml.md, THEORY.md with its formulas as MathML, for `cargo doc`: browsers set MathML without scripts,
// fonts or a network. With --check it only says whether that file is current.
import { readFileSync, writeFileSync } from "node:fs";
import katex from "katex";

const SOURCE = new URL("../../THEORY.md", import.meta.url);
const TARGET = new URL("../../docs/theory-mathml.md", import.meta.url);
const HEAD = "<!-- Generated from THEORY.md by `npm run theory`: do not edit. -->\n";

/** Characters that Markdown would read inside of a formula. */
const ESCAPES = {
  "|": "&#124;",
  "*": "&#42;",
  _: "&#95;",
  "[": "&#91;",
  "]": "&#93;",
  "`": "&#96;",
  "~": "&#126;",
};

function mathml(tex, displayMode) {
  const html = katex.renderToString(tex, {
    displayMode,
    output: "mathml",
    throwOnError: true,
    strict: "error",
  });
  const math = html.match(/<math.*<\/math>/s)[0];
  return math
    .replace(/<annotation.*?<\/annotation>/s, "")
    .replace(/<\/?semantics>/g, "")
    .replace(/<(\w+)([^>]*)\/>/g, "<$1$2></$1>")
    .replace(/>([^<]+)</g, (_, text) => `>${text.replace(/[|*_[\]`~]/g, (c) => ESCAPES[c])}<`)
    .replace(/\s*\n\s*/g, " ");
}

function display(tex) {
  const number = tex.match(/\\tag\{(.*?)\}/)?.[1];
  const formula = mathml(tex.replace(/\\tag\{.*?\}/, "").trim(), true);
  const label = number ? `<span style="margin-left:1em">(${number})</span>` : "";
  const style = "display:flex;justify-content:space-between;align-items:center;overflow-x:auto";
  return `<div${number ? ` id="eq-${number}"` : ""} style="${style}">${formula}${label}</div>`;
}

// Code spans keep their dollars.
const parts = readFileSync(SOURCE, "utf8").split(/(`[^`\n]+`)/);
const set = parts.map((part, index) =>
  index % 2 === 1
    ? part
    : part
        .replace(/\[(\d+)\](?!\()/g, "\\[$1\\]") // a citation, which rustdoc would take for a link
        .replace(/\$\$([\s\S]+?)\$\$/g, (_, tex) => display(tex))
        .replace(/\$([^$]+?)\$/g, (_, tex) => mathml(tex, false)),
);
const text = HEAD + set.join("").replace(/^# Theory\n/, "");

if (!process.argv.includes("--check")) {
  writeFileSync(TARGET, text);
} else if (readFileSync(TARGET, "utf8") !== text) {
  console.error("docs/theory-mathml.md does not fit THEORY.md: run `npm run theory`");
  process.exit(1);
}
