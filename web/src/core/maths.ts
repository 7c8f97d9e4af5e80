// KaTeX, fetched only when a text holds mathematics. It also writes MathML for screen readers.

import { t } from "./texts";

type Katex = typeof import("katex").default;
let loading: Promise<Katex> | undefined;

export function loadMaths(): Promise<Katex> {
  loading ??= Promise.all([import("katex"), import("katex/dist/katex.min.css")]).then(
    ([module]) => module.default,
  );
  return loading;
}

const MARKED = ".math.inline, .math.display";

export const hasMaths = (html: string): boolean =>
  html.includes("math inline") || html.includes("math display");

/** Sets all marked mathematics under `root`; where it cannot be read, the LaTeX stays visible. */
export async function setMaths(root: HTMLElement): Promise<void> {
  const marked = [...root.querySelectorAll<HTMLElement>(MARKED)].filter((node) => !node.dataset.set);
  if (marked.length === 0) return;
  const katex = await loadMaths();
  for (const node of marked) {
    const source = node.textContent ?? "";
    node.dataset.set = "yes";
    try {
      katex.render(source, node, {
        displayMode: node.classList.contains("display"),
        throwOnError: true,
        trust: false,
        strict: false,
        maxExpand: 500,
        output: "htmlAndMathml",
      });
      if (node.classList.contains("display")) makeScrollable(node);
    } catch {
      node.textContent = source;
      node.classList.add("raw");
    }
  }
}

// Observed elements that leave the page are forgotten by the browser.
const widths = new ResizeObserver((entries) => {
  for (const entry of entries) measure(entry.target as HTMLElement);
});

/** A long formula scrolls by itself on a narrow screen, by keyboard too. */
function makeScrollable(node: HTMLElement): void {
  widths.observe(node);
  // The width is known for good when KaTeX's fonts have come.
  void document.fonts.ready.then(() => measure(node));
}

function measure(node: HTMLElement): void {
  const scrolls = node.scrollWidth > node.clientWidth;
  if (scrolls === node.hasAttribute("tabindex")) return;
  if (scrolls) {
    node.tabIndex = 0;
    node.setAttribute("role", "group");
    node.setAttribute("aria-label", t("Formula, scrolls sideways"));
  } else for (const name of ["tabindex", "role", "aria-label"]) node.removeAttribute(name);
}
