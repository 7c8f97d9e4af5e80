// From a JSON pointer to the place in the text that somebody wrote.

/** Offset of the value that `pointer` names, or of the deepest part of it that exists. */
export function locate(text: string, pointer: string): number {
  const steps = pointer
    .replace(/^#/, "")
    .split("/")
    .slice(1)
    .map((step) => step.replaceAll("~1", "/").replaceAll("~0", "~"));
  let at = space(text, 0);
  for (const step of steps) {
    const next = child(text, at, step);
    if (next === undefined) return at;
    at = next;
  }
  return at;
}

export function lineOf(text: string, offset: number): number {
  let line = 1;
  for (let k = 0; k < offset && k < text.length; k += 1) if (text[k] === "\n") line += 1;
  return line;
}

function space(text: string, from: number): number {
  let at = from;
  while (at < text.length && /\s/.test(text[at] ?? "")) at += 1;
  return at;
}

function child(text: string, start: number, step: string): number | undefined {
  const open = text[start];
  if (open !== "{" && open !== "[") return undefined;
  let at = space(text, start + 1);
  let index = 0;
  while (at < text.length && text[at] !== "}" && text[at] !== "]") {
    let key = String(index);
    if (open === "{") {
      const end = skipString(text, at);
      try {
        key = JSON.parse(text.slice(at, end)) as string;
      } catch {
        return undefined;
      }
      at = space(text, end);
      if (text[at] !== ":") return undefined;
      at = space(text, at + 1);
    }
    if (key === step) return at;
    at = space(text, skipValue(text, at));
    if (text[at] === ",") at = space(text, at + 1);
    else if (text[at] !== "}" && text[at] !== "]") return undefined;
    index += 1;
  }
  return undefined;
}

function skipString(text: string, start: number): number {
  let at = start + 1;
  while (at < text.length && text[at] !== '"') at += text[at] === "\\" ? 2 : 1;
  return at + 1;
}

function skipValue(text: string, start: number): number {
  let depth = 0;
  let at = start;
  while (at < text.length) {
    const sign = text[at];
    if (sign === '"') at = skipString(text, at) - 1;
    else if (sign === "{" || sign === "[") depth += 1;
    else if (sign === "}" || sign === "]") {
      if (depth === 0) return at;
      depth -= 1;
    } else if (sign === "," && depth === 0) return at;
    at += 1;
    if (depth === 0 && (sign === "}" || sign === "]")) return at;
  }
  return at;
}

/** JSON as a person would write it: short arrays of numbers stay on one line. */
export function pretty(value: unknown): string {
  return JSON.stringify(value, null, 2).replace(
    /\[\s+((?:-?[\d.eE+-]+,?\s+)+)\]/g,
    (_, inside: string) => `[${inside.trim().replace(/\s+/g, " ")}]`,
  );
}
