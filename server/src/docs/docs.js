// Light or dark, as in the workbench, and the search. Without this program the pages are read all the same.
"use strict";

const dark = matchMedia("(prefers-color-scheme: dark)");
const KEY = "triad:theme";

function kept() {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null; // A private window: nothing is remembered.
  }
}

function theme() {
  const chosen = kept();
  if (chosen === "light" || chosen === "dark") return chosen;
  return dark.matches ? "dark" : "light";
}

function apply() {
  document.documentElement.dataset.theme = theme();
}

function toggle() {
  const system = dark.matches ? "dark" : "light";
  const next = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
  try {
    if (next === system) localStorage.removeItem(KEY);
    else localStorage.setItem(KEY, next);
  } catch {
    // It holds for this page.
  }
  document.documentElement.dataset.theme = next;
}

apply();
dark.addEventListener("change", apply);

/** Words as they are compared: small letters without accents. */
const plain = (text) => text.normalize("NFD").replace(/\p{M}/gu, "").toLowerCase();

/** How often a word of a text counts: then it is about it. */
const MOST = 6;

/** The sections that have all words, the best first: a word in a heading counts more than in the text, words that stand
 * together more than apart. */
function matches(sections, query) {
  const words = plain(query).split(/\s+/).filter((word) => word.length > 0);
  if (words.length === 0) return [];
  const found = [];
  for (const [address, page, heading, text] of sections) {
    const [head, body] = [plain(heading), plain(text)];
    let score = 0;
    for (const word of words) {
      const whole = head.split(/[^\p{L}\p{N}]+/u).includes(word);
      const often = Math.min(body.split(word).length - 1, MOST);
      const own = (whole ? 20 : head.includes(word) ? 8 : 0) + often;
      if (own === 0) {
        score = 0;
        break;
      }
      score += own;
    }
    if (score > 0 && body.includes(words.join(" "))) score += 10;
    if (score > 0) found.push({ address, page, heading, text, score });
  }
  return found.sort((a, b) => b.score - a.score).slice(0, 12);
}

/** The words around the first that was looked for. */
function excerpt(text, query) {
  const word = plain(query).split(/\s+/).find((part) => part.length > 0) ?? "";
  const at = Math.max(0, plain(text).indexOf(word) - 50);
  const part = text.slice(at, at + 150);
  return at > 0 ? `… ${part.replace(/^\S*\s/, "")}` : part;
}

function show(sections, query) {
  const list = document.getElementById("found");
  const found = matches(sections, query);
  list.replaceChildren(
    ...found.map(({ address, page, heading, text }) => {
      const [item, link, name, more] = ["li", "a", "b", "small"].map((tag) => document.createElement(tag));
      link.href = address;
      name.textContent = heading;
      more.textContent = `${page}: ${excerpt(text, query)}`;
      link.append(name, more);
      item.append(link);
      return item;
    }),
  );
  list.hidden = found.length === 0;
  const said = found.length === 0 ? "nothing found" : `${found.length} found`;
  document.getElementById("count").textContent = query.trim() === "" ? "" : said;
}

/** The words of all pages come once somebody searches. */
let words;
function load() {
  words ??= new Promise((resolve, reject) => {
    const script = document.createElement("script");
    script.src = "search.js";
    script.onload = () => resolve(globalThis.triadDocs);
    script.onerror = reject;
    document.head.append(script);
  });
  return words;
}

document.addEventListener("DOMContentLoaded", () => {
  const query = document.getElementById("query");
  const list = document.getElementById("found");
  document.getElementById("theme").addEventListener("click", toggle);
  query.addEventListener("focus", load);
  query.addEventListener("input", async () => show(await load(), query.value));
  document.addEventListener("keydown", (event) => {
    if (event.key === "/" && !/^(INPUT|TEXTAREA)$/.test(document.activeElement.tagName)) {
      event.preventDefault();
      query.focus();
    }
    if (event.key === "Escape") {
      list.hidden = true;
      query.blur();
    }
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      const links = [...list.querySelectorAll("a")];
      const at = links.indexOf(document.activeElement);
      if (list.hidden || (at < 0 && document.activeElement !== query)) return;
      event.preventDefault();
      const next = at + (event.key === "ArrowDown" ? 1 : -1);
      (links[Math.min(next, links.length - 1)] ?? query).focus();
    }
  });
  list.addEventListener("click", () => {
    list.hidden = true;
  });
  // On a narrow screen the list of pages is folded, so that one begins with the text.
  if (matchMedia("(max-width: 52rem)").matches) document.querySelector("nav details")?.removeAttribute("open");
  for (const wide of document.querySelectorAll("main div[style*='overflow-x']")) {
    if (wide.scrollWidth > wide.clientWidth) wide.tabIndex = 0;
  }
});
