// Helpers of the DOM: make elements with typed properties, announce, save a file.
import { addressOf, site } from "./address";

type Listener = (event: never) => void;
type Value = string | number | boolean | null | undefined | Listener;
export type Child = Node | string | number | null | undefined | false;

/** Makes an element. `on…` functions become listeners; false, null and undefined are left out. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  props?: Record<string, Value> | null,
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(props ?? {})) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") element.addEventListener(key.slice(2), value as EventListener);
    else if (key === "href") element.setAttribute(key, addressOf(String(value)));
    else element.setAttribute(key, value === true ? "" : String(value));
  }
  append(element, children);
  return element;
}

const SVG = "http://www.w3.org/2000/svg";

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  props: Record<string, string | number>,
  ...children: Child[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS(SVG, tag);
  for (const [key, value] of Object.entries(props)) element.setAttribute(key, String(value));
  append(element, children);
  return element;
}

function append(parent: Element, children: Child[]): void {
  for (const child of children) {
    if (child === null || child === undefined || child === false) continue;
    parent.append(typeof child === "number" ? String(child) : child);
  }
}

/** What authors and the server write is English, whatever the page around it speaks. */
export const AUTHORED = "en";

/** Markup written by the lesson's author and rendered by our own server. */
export function authored<E extends HTMLElement>(element: E, html: string): E {
  element.innerHTML = html;
  element.lang = AUTHORED;
  if (site)
    for (const link of element.querySelectorAll("a[href^='/']"))
      link.setAttribute("href", addressOf(link.getAttribute("href") ?? ""));
  return element;
}

/** Sets text only where it changed, so that a screen reader and the layout stay calm. */
export function setText(node: Element, text: string): void {
  if (node.textContent !== text) node.textContent = text;
}

/** Lets the browser save a file. */
export function saveFile(blob: Blob, name: string): void {
  const link = h("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  URL.revokeObjectURL(link.href);
}

let counter = 0;
export function uid(prefix: string): string {
  counter += 1;
  return `${prefix}-${counter}`;
}

const announcer = (): HTMLElement | null => document.getElementById("announce");

/** Announces a sentence to screen readers. */
export function announce(sentence: string): void {
  const region = announcer();
  if (region) region.textContent = sentence;
}
