// What the server said, in the reader's language: its sentences are English, and are known by their form. Where one is not known the
// English stays, and is marked as that; where it is, the original is told as the element is pointed at.
import { AUTHORED, h } from "./dom";
import { language } from "./texts";

/** A sentence with places for values, and what it is in the other language. */
interface Form {
  /** Its words between the places, the first and the last included. */
  parts: string[];
  /** Its longest words without a place: what lacks these is not tried. */
  words: string;
  names: string[];
  said: string;
}

/** Longer sentences stay as they are: names in them may be as long as an author likes. */
const LONGEST = 3000;
/** How deep sentences stand in sentences. */
const DEEPEST = 4;
const PLACE = /\{(\w+)\}/;
/** Places in which sentences stand, which are told in the same language or not at all. */
const SENTENCES = new Set(["reason", "cause"]);

/** What stands in the places between words, each as short as can be; undefined where the sentence is another one. One way through:
 * names from a scene may be made of the words of a form, and an expression would try all the ways to part them. */
function valuesOf(sentence: string, parts: string[]): string[] | undefined {
  const [first = "", ...others] = parts;
  const last = others.pop();
  if (last === undefined) return sentence === first ? [] : undefined;
  if (!sentence.startsWith(first)) return undefined;
  const values: string[] = [];
  let at = first.length;
  for (const part of others) {
    const next = sentence.indexOf(part, at);
    if (next < 0) return undefined;
    values.push(sentence.slice(at, next));
    at = next + part.length;
  }
  const end = sentence.length - last.length;
  return end >= at && sentence.endsWith(last) ? [...values, sentence.slice(at, end)] : undefined;
}

/** Forms of a catalogue, the most telling first. */
export function formsOf(catalogue: Record<string, string>): Form[] {
  return Object.entries(catalogue)
    .map(([sentence, said]) => {
      const parts = sentence.split(PLACE);
      const words = parts.filter((_, k) => k % 2 === 0);
      return {
        parts: words,
        words: words.reduce((long, part) => (part.length > long.length ? part : long), ""),
        names: parts.filter((_, k) => k % 2 === 1),
        said,
        weight: words.join("").length,
      };
    })
    .sort((a, b) => b.weight - a.weight);
}

/** A sentence in the other language, with its values; undefined where its form is not known. */
export function translated(sentence: string, forms: Form[], depth = DEEPEST): string | undefined {
  if (sentence.length > LONGEST || depth === 0) return undefined;
  for (const form of forms) {
    if (!sentence.includes(form.words)) continue;
    const values = valuesOf(sentence, form.parts);
    if (!values) continue;
    const told = values.map((value, k) =>
      SENTENCES.has(form.names[k] ?? "") ? translated(value, forms, depth - 1) : value,
    );
    if (told.includes(undefined)) continue;
    return form.said.replace(/\{(\w+)\}/g, (place, name: string) => told[form.names.indexOf(name)] ?? place);
  }
  return undefined;
}

/** A sentence by itself begins with a capital, unless it begins with a name from a scene. */
const begun = (told: string): string =>
  /^\p{Ll}+(?: |:)/u.test(told) ? told.charAt(0).toUpperCase() + told.slice(1) : told;

let forms: Promise<Form[]> | undefined;
/** The catalogue, once it is there. */
let known: Form[] | undefined;

async function load(): Promise<Form[]> {
  const [scenes, runs] = await Promise.all([import("../texts/de/told"), import("../texts/de/told-runs")]);
  known = formsOf({ ...scenes.told, ...runs.toldOfRuns });
  return known;
}

/** What the server said, as an element's child: in the reader's language where that is known. */
export function told(sentence: string): Node {
  if (language() === "en") return document.createTextNode(sentence);
  const place = h("span", { lang: AUTHORED }, sentence);
  const show = (catalogue: Form[]): void => {
    const own = translated(sentence, catalogue);
    if (own === undefined) return;
    place.lang = language();
    place.title = sentence;
    place.textContent = begun(own);
  };
  if (known) show(known);
  else {
    forms ??= load();
    // Without the catalogue the English stays.
    forms.then(show, () => undefined);
  }
  return place;
}
