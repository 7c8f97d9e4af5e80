// Numbers as text. One place, so that the page never shows two roundings of one value.
import { locale, pointPartsThousands, t } from "./texts";

/** Up to `digits` significant digits; scientific outside 1e-3 … 1e6; a true minus sign. */
export function num(value: number, digits = 6): string {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? t("not a number") : value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e6) return sci(value, Math.min(digits, 4));
  return written(Number(value.toPrecision(digits)).toString());
}

/** Scientific notation such as 1.23e−9. */
export function sci(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return num(value);
  if (value === 0) return "0";
  return minus(value.toExponential(digits - 1).replace("e+", "e"));
}

/** Fixed decimals, for columns that must not dance while they change. */
export function fixed(value: number, decimals = 4): string {
  if (!Number.isFinite(value)) return num(value);
  if (value !== 0 && (Math.abs(value) >= 1e7 || Math.abs(value) < 0.5 * 10 ** -decimals)) {
    return sci(value, 3);
  }
  return fixedPlain(value, decimals);
}

export function seconds(value: number, decimals = 3): string {
  return `${fixedPlain(value, decimals)} s`;
}

export function fixedPlain(value: number, decimals: number): string {
  return minus(value.toFixed(decimals === 3 && pointPartsThousands() ? 4 : decimals));
}

/** What is wrong with a comma that may part thousands or decimals, as in 1,500; nothing where it is clear. Answers are read likewise. */
export function unclearComma(text: string): string | undefined {
  const found = /^\s*[+−-]?\s*([1-9](?:\d{1,2},\d{3}|,\d{3}(?!\s*e)))(?![\d,.])/i.exec(text)?.[1];
  return found === undefined
    ? undefined
    : t("The comma in “{text}” can be read in two ways: write the decimal sign as a point.", { text: found });
}

/** A number as somebody types it, with a comma or a true minus sign too; NaN where it is none, or may be two. */
export function typedNumber(text: string): number {
  if (unclearComma(text) !== undefined) return NaN;
  const plain = text.trim().replace(",", ".").replace("−", "-");
  return plain === "" ? NaN : Number(plain);
}

/** The same of a field with a unit behind it: whoever types that unit too means no other number. */
export function typedIn(unit: string, text: string): number {
  let rest = text.trimEnd();
  let parted = rest;
  for (const sign of [...unit.replace(/\s/g, "")].reverse()) {
    if (!rest.endsWith(sign)) return typedNumber(text);
    parted = rest.slice(0, -sign.length);
    rest = parted.trimEnd();
  }
  // The 1 of "1/s" right behind a digit belongs to the number.
  return /^\d/.test(unit) && parted === rest ? typedNumber(text) : typedNumber(rest);
}

export function points(value: number): string {
  return minus(Number(value.toFixed(2)).toString());
}

/** The page writes decimals behind a point in all its languages, as scenes and formulas have it: never three alone where that parts thousands. */
function written(text: string): string {
  const unclear = pointPartsThousands() && /^-?[1-9]\d{0,2}\.\d{3}$/.test(text);
  return minus(unclear ? `${text}0` : text);
}

function minus(text: string): string {
  return text.replaceAll("-", "−");
}

let dates: Intl.DateTimeFormat | undefined;
/** Made once it is needed: the language is chosen by then. */
const stamp = (): Intl.DateTimeFormat => {
  dates ??= new Intl.DateTimeFormat(locale(), { dateStyle: "medium", timeStyle: "short" });
  return dates;
};

export function dateTime(iso: string): string {
  const date = new Date(iso);
  return Number.isNaN(date.getTime()) ? iso : stamp().format(date);
}

/** Words as the name of a file. */
export const fileName = (words: string): string =>
  words
    .toLowerCase()
    .replace(/[^a-z0-9.]+/g, "-")
    .replace(/^-+|-+$/g, "") || "mechanism";
