// What the page says, in the reader's language: the English text is the key, `texts/` holds it in the other languages.
import type { German } from "../texts/de";
import type { Child } from "./dom";
import { recall, remember } from "./prefs";

/** A text of the catalogue. `{name}` is a place for a value; ` | ` parts the form for one from that for many. */
export type Text = keyof German;

type Names<S extends string> = S extends `${string}{${infer Name}}${infer Rest}` ? Name | Names<Rest> : never;
type Values<S extends string, V> = Record<Names<S>, V> &
  (S extends `${string} | ${string}` ? { n: number } : unknown);

/** The languages that the page speaks, each in its own words. */
export const LANGUAGES = { en: "English", de: "Deutsch" } as const;
export type Language = keyof typeof LANGUAGES;

const known = (tag: string | null): tag is Language => tag !== null && tag in LANGUAGES;

let catalogue: Partial<Record<string, string>> = {};
/** The language that the page speaks: English until another one's words are there. */
let spoken: Language = "en";

/** The language of this browser's page: as chosen, else the first that its reader understands, else English. */
export function language(): Language {
  const chosen = recall("language");
  if (known(chosen)) return chosen;
  const understood = navigator.languages.map((tag) => tag.slice(0, 2).toLowerCase());
  return understood.find(known) ?? "en";
}

/** Whether a point before three digits parts thousands for the page's reader: 10.000 is ten thousand in German. */
export const pointPartsThousands = (): boolean => spoken === "de";

/** The reader's kind of that language, for dates: `de-AT`, say. */
export const locale = (): string => {
  const own = language();
  return navigator.languages.find((tag) => tag.toLowerCase().startsWith(own)) ?? own;
};

/** Speaks another language from now on; what is on the page is written anew. */
export function speak(next: Language): void {
  remember("language", next);
  location.reload();
}

/** Fetches the language of the page. Until then, and where it cannot be had, the page speaks English. */
export async function loadLanguage(): Promise<void> {
  if (language() !== "de") return;
  catalogue = (await import("../texts/de")).de;
  spoken = "de";
  document.documentElement.lang = "de";
}

/** A text with its values. No module calls this while it is loaded: the language is not there yet. */
export function t<K extends Text>(
  text: K,
  ...values: [Names<K>] extends [never] ? [] : [Values<K, string | number>]
): string {
  const given: Record<string, string | number> = values[0] ?? {};
  return said(text, given).replace(PLACE, (place, name: string) => String(given[name] ?? place));
}

/** A text with elements in it, as children of an element. */
export function parts<K extends Text>(text: K, values: Values<K, Child>): Child[] {
  const given: Record<string, Child> = values;
  return said(text, given)
    .split(PLACE)
    .map((part, k) => (k % 2 === 0 ? part : given[part]));
}

/** Words one after the other: "a, b and c". */
export const listed = (words: string[]): string =>
  new Intl.ListFormat(language(), { type: "conjunction" }).format(words);

const PLACE = /\{(\w+)\}/g;

/** Both languages have a form for one and a form for all other numbers. */
function said(text: string, values: Record<string, unknown>): string {
  const found = catalogue[text] ?? text;
  if (!("n" in values)) return found;
  const forms = found.split(" | ");
  const one = new Intl.PluralRules(language()).select(Number(values.n)) === "one";
  return (one ? forms[0] : forms.at(-1)) ?? text;
}
