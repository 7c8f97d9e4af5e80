// What may stand at a place of a scene, from its JSON Schema: keys of an object, words of a value.
import { locate } from "./pointer";

interface Schema {
  $ref?: string;
  $defs?: Record<string, Schema>;
  properties?: Record<string, Schema>;
  items?: Schema;
  prefixItems?: Schema[];
  anyOf?: Schema[];
  oneOf?: Schema[];
  allOf?: Schema[];
  enum?: unknown[];
  const?: unknown;
  type?: string | string[];
  description?: string;
  additionalProperties?: Schema | boolean;
}

export interface Offer {
  /** What is written. */
  text: string;
  about: string;
}

export interface Completion {
  /** The part of the text that an offer replaces. */
  from: number;
  to: number;
  offers: Offer[];
}

/** What fits at the cursor; nothing outside of keys and words. */
export function complete(schema: unknown, text: string, cursor: number): Completion | undefined {
  const place = placeOf(text, cursor);
  if (!place) return undefined;
  const root = schema as Schema;
  const here = place.path.reduce((at, step) => at.flatMap((one) => below(root, one, step)), flat(root, root));
  const typed = text.slice(place.from, cursor).replaceAll('"', "").toLowerCase();
  const offers = place.key ? keys(root, narrowed(root, here, text, place.path), text, place) : words(here);
  const fit = offers.filter(
    (offer) => offer.text.toLowerCase().includes(typed) && offer.text !== text.slice(place.from, place.to),
  );
  return fit.length > 0 ? { from: place.from, to: place.to, offers: fit } : undefined;
}

/** The schemas that a schema amounts to, references and alternatives resolved. */
function flat(root: Schema, schema: Schema, depth = 0): Schema[] {
  if (depth > 8) return [];
  const own =
    schema.properties ||
    schema.items ||
    schema.prefixItems ||
    schema.enum ||
    schema.const !== undefined ||
    schema.type
      ? [schema]
      : [];
  const referred = schema.$ref ? [root.$defs?.[schema.$ref.replace("#/$defs/", "")]] : [];
  return [
    ...own,
    ...[...referred, ...(schema.anyOf ?? []), ...(schema.oneOf ?? []), ...(schema.allOf ?? [])].flatMap(
      (one) => (one ? flat(root, one, depth + 1) : []),
    ),
  ];
}

function below(root: Schema, schema: Schema, step: string): Schema[] {
  const next =
    schema.properties?.[step] ??
    (/^\d+$/.test(step) ? (schema.prefixItems?.[Number(step)] ?? schema.items) : undefined) ??
    (typeof schema.additionalProperties === "object" ? schema.additionalProperties : undefined);
  return next ? flat(root, next) : [];
}

/** Of several kinds of object, those that the words already written leave possible, such as "type": "spring". */
function narrowed(root: Schema, here: Schema[], text: string, path: string[]): Schema[] {
  const objects = here.filter((one) => one.properties);
  const fitting = objects.filter((one) =>
    Object.entries(one.properties ?? {}).every(([key, value]) => {
      const stated = flat(root, value)
        .map((part) => part.const)
        .find((word) => typeof word === "string");
      if (typeof stated !== "string") return true;
      const at = locate(text, `/${[...path, key].join("/")}`);
      const written = /^"((?:[^"\\]|\\.)*)"/.exec(text.slice(at))?.[1];
      return (
        written === undefined ||
        written === stated ||
        !new RegExp(`"${key}"\\s*:\\s*$`).test(text.slice(0, at))
      );
    }),
  );
  return fitting.length > 0 ? fitting : objects;
}

function keys(root: Schema, here: Schema[], text: string, place: Place): Offer[] {
  const found = new Map<string, Offer>();
  for (const one of here) {
    for (const [key, value] of Object.entries(one.properties ?? {})) {
      if (found.has(key) || place.siblings.has(key)) continue;
      const about =
        value.description ??
        flat(root, value)
          .map((part) => part.description)
          .find(Boolean) ??
        "";
      found.set(key, { text: `"${key}": `, about });
    }
  }
  // Where a value follows already only the name is replaced.
  if (/^\s*:/.test(text.slice(place.to)))
    for (const offer of found.values()) offer.text = offer.text.replace(": ", "");
  return [...found.values()];
}

function words(here: Schema[]): Offer[] {
  const found = new Map<string, Offer>();
  for (const one of here) {
    for (const word of [...(one.enum ?? []), ...(one.const === undefined ? [] : [one.const])])
      found.set(JSON.stringify(word), { text: JSON.stringify(word), about: one.description ?? "" });
    if (one.type === "boolean")
      for (const word of ["true", "false"]) found.set(word, { text: word, about: one.description ?? "" });
  }
  return [...found.values()];
}

interface Place {
  path: string[];
  /** A key is written here, not a value. */
  key: boolean;
  from: number;
  to: number;
  /** Keys that the object has already. */
  siblings: Set<string>;
}

/** Where the cursor stands, in text that need not be whole. */
export function placeOf(text: string, cursor: number): Place | undefined {
  interface Level {
    object: boolean;
    key: string | undefined;
    index: number;
    afterColon: boolean;
    keys: Set<string>;
  }
  const levels: Level[] = [];
  let from = cursor;
  for (let at = 0; at < cursor; at += 1) {
    const sign = text[at];
    const level = levels.at(-1);
    if (sign === '"') {
      let end = at + 1;
      while (end < text.length && text[end] !== '"' && text[end] !== "\n") end += text[end] === "\\" ? 2 : 1;
      if (end >= cursor) {
        from = at;
        break;
      }
      if (level?.object && !level.afterColon) {
        level.key = text.slice(at + 1, end);
        level.keys.add(level.key);
      }
      at = end;
    } else if (sign === "{" || sign === "[")
      levels.push({ object: sign === "{", key: undefined, index: 0, afterColon: false, keys: new Set() });
    else if (sign === "}" || sign === "]") levels.pop();
    else if (sign === ":" && level) level.afterColon = true;
    else if (sign === "," && level) {
      level.index += 1;
      level.afterColon = false;
    }
  }
  const level = levels.at(-1);
  if (!level) return undefined;
  const word = text[from] === '"' ? /^"(?:[^"\\\n]|\\.)*"?/.exec(text.slice(from))?.[0] : undefined;
  if (word === undefined) {
    const bare = /[\w-]*$/.exec(text.slice(0, cursor))?.[0] ?? "";
    from = cursor - bare.length;
  }
  const to = from + (word?.length ?? cursor - from);
  const path = levels.slice(0, -1).map((one) => (one.object ? (one.key ?? "") : String(one.index)));
  const key = level.object && !level.afterColon;
  if (!key) path.push(level.object ? (level.key ?? "") : String(level.index));
  // Keys after the cursor count too.
  for (const match of siblingsAfter(text.slice(to))) level.keys.add(match);
  return { path, key, from, to, siblings: level.keys };
}

/** Keys of the rest of an object, up to its end. */
function siblingsAfter(rest: string): string[] {
  const found: string[] = [];
  let depth = 0;
  for (const part of rest.matchAll(/"((?:[^"\\\n]|\\.)*)"(\s*:)?|[{}[\]]/g)) {
    if (part[0] === "{" || part[0] === "[") depth += 1;
    else if (part[0] === "}" || part[0] === "]") {
      if (depth === 0) break;
      depth -= 1;
    } else if (depth === 0 && part[2] && part[1] !== undefined) found.push(part[1]);
  }
  return found;
}
