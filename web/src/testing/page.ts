// As much of a browser's page as the elements of unit tests need: a tree, attributes, classes, events that rise, simple selectors.
import { vi } from "vitest";

/** Attributes that are properties, too. */
const TEXTS = ["id", "type", "name", "value", "title", "lang", "href"] as const;
const FLAGS = ["hidden", "disabled", "checked", "open"] as const;

/** The parts of a simple selector: name, .class, #id, [attribute], [attribute=value]. */
const PART = /^([a-z]+\d?)|\.([\w-]+)|#([\w-]+)|\[([\w-]+)(?:="?([^"\]]*)"?)?\]/g;

export class Fake extends EventTarget {
  parentElement: Fake | null = null;
  childNodes: (Fake | string)[] = [];
  tabIndex = -1;
  readonly dataset: Record<string, string> = {};
  readonly style = { setProperty: (): void => undefined };
  private readonly attributes = new Map<string, string>();

  constructor(readonly tag: string) {
    super();
    for (const key of TEXTS)
      Object.defineProperty(this, key, {
        get: () => this.attributes.get(key) ?? "",
        set: (value: string) => this.attributes.set(key, String(value)),
      });
    for (const key of FLAGS)
      Object.defineProperty(this, key, {
        get: () => this.attributes.has(key),
        set: (on: boolean) => (on ? this.attributes.set(key, "") : this.attributes.delete(key)),
      });
  }

  setAttribute = (key: string, value: string): void => void this.attributes.set(key, value);
  getAttribute = (key: string): string | null => this.attributes.get(key) ?? null;
  hasAttribute = (key: string): boolean => this.attributes.has(key);
  removeAttribute = (key: string): void => void this.attributes.delete(key);

  readonly classList = {
    all: (): string[] => (this.getAttribute("class") ?? "").split(" ").filter(Boolean),
    contains: (name: string): boolean => this.classList.all().includes(name),
    add: (...names: string[]): void =>
      this.setAttribute("class", [...new Set([...this.classList.all(), ...names])].join(" ")),
    remove: (...names: string[]): void => {
      const left = this.classList.all().filter((name) => !names.includes(name));
      this.setAttribute("class", left.join(" "));
    },
    toggle: (name: string, on = !this.classList.contains(name)): void =>
      on ? this.classList.add(name) : this.classList.remove(name),
  };

  append(...children: (Fake | string)[]): void {
    for (const child of children) {
      if (child instanceof Fake) child.parentElement = this;
      this.childNodes.push(child);
    }
  }
  replaceChildren(...children: (Fake | string)[]): void {
    this.childNodes = [];
    this.append(...children);
  }
  get children(): Fake[] {
    return this.childNodes.filter((child) => child instanceof Fake);
  }
  get childElementCount(): number {
    return this.children.length;
  }
  get textContent(): string {
    return this.childNodes
      .map((child) => (child instanceof Fake ? child.textContent : String(child)))
      .join("");
  }
  set textContent(text: string) {
    this.replaceChildren(text);
  }
  /** Markup is its text without the tags. */
  set innerHTML(html: string) {
    this.replaceChildren(html.replace(/<[^>]*>/g, ""));
  }

  matches(selector: string): boolean {
    return selector.split(/,(?![^(]*\))/).some((one) => {
      const [, plain = "", without] = /^\s*(.*?)(?::not\((.*)\))?\s*$/.exec(one) ?? [];
      if (without !== undefined && this.matches(without)) return false;
      return [...plain.matchAll(PART)].every(([, tag, cls, id, key, value]) => {
        if (tag) return tag === this.tag;
        if (cls) return this.classList.contains(cls);
        if (id) return this.getAttribute("id") === id;
        return (
          key !== undefined &&
          (value === undefined ? this.hasAttribute(key) : this.getAttribute(key) === value)
        );
      });
    });
  }
  querySelectorAll(selector: string): Fake[] {
    return this.children.flatMap((child) => [
      ...(child.matches(selector) ? [child] : []),
      ...child.querySelectorAll(selector),
    ]);
  }
  querySelector(selector: string): Fake | null {
    return this.querySelectorAll(selector)[0] ?? null;
  }
  contains(other: Fake): boolean {
    return this === other || this.children.some((child) => child.contains(other));
  }

  override dispatchEvent(event: Event): boolean {
    const on = super.dispatchEvent(event);
    if (event.bubbles) this.parentElement?.dispatchEvent(event);
    return on;
  }
  click(): void {
    this.dispatchEvent(new Event("click", { bubbles: true }));
  }
  focus(): void {}
  blur(): void {}
  scrollIntoView(): void {}
}

/** Stands in for the document until globals are no longer stubbed. */
export function fakePage(): void {
  vi.stubGlobal("HTMLElement", Fake);
  vi.stubGlobal("HTMLInputElement", Fake);
  vi.stubGlobal("document", {
    createElement: (tag: string) => new Fake(tag),
    createElementNS: (_: string, tag: string) => new Fake(tag),
    createTextNode: (text: string) => text,
    getElementById: () => null,
    querySelectorAll: () => [],
    documentElement: new Fake("html"),
    body: new Fake("body"),
    activeElement: null,
    addEventListener: () => undefined,
  });
  vi.stubGlobal("addEventListener", () => undefined);
  vi.stubGlobal("removeEventListener", () => undefined);
  vi.stubGlobal("window", globalThis);
  vi.stubGlobal("navigator", { languages: ["en"] });
  vi.stubGlobal("location", { origin: "http://triad.test", href: "http://triad.test/", pathname: "/" });
  vi.stubGlobal(
    "ResizeObserver",
    class {
      observe(): void {}
    },
  );
}

/** An element of the page as what it is in a test. */
export const fake = (element: unknown): Fake => element as Fake;
/** What is found in an element; there must be something. */
export function found(element: unknown, selector: string): Fake & { value: string; disabled: boolean } {
  const first = fake(element).querySelector(selector);
  if (!first) throw new Error(`there is no ${selector}`);
  return first as Fake & { value: string; disabled: boolean };
}
