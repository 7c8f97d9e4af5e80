// What the server said, in the reader's language: its sentences are English, and are known by their form. Where one is not known the
// English stays, and is marked as that; where it is, the original is told as the element is pointed at.
import { AUTHORED, h } from "./dom";
import { language } from "./texts";

/** A sentence with places for values, and what it is in the other language. */
interface Form {
  matches: RegExp;
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

const escaped = (text: string): string => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

/** Forms of a catalogue, the most telling first. */
export function formsOf(catalogue: Record<string, string>): Form[] {
  return Object.entries(catalogue)
    .map(([sentence, said]) => {
      const parts = sentence.split(PLACE);
      const words = parts.filter((_, k) => k % 2 === 0);
      const pattern = parts.map((part, k) => (k % 2 === 0 ? escaped(part) : "([^]*?)")).join("");
      return {
        matches: new RegExp(`^${pattern}$`),
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
    const values = form.matches.exec(sentence)?.slice(1);
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
