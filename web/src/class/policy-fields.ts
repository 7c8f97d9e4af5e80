// Fields of a policy: moments, numbers, shares and people, as they are shown and as they are typed.

import type { Somebody } from "../api/types";
import { h } from "../core/dom";
import { num, typedNumber, unclearComma } from "../core/format";
import { t } from "../core/texts";

/** A moment as a field of local time has it, with seconds where there are any. */
export function local(moment: string | null | undefined): string {
  if (!moment) return "";
  const at = new Date(moment);
  const here = new Date(at.getTime() - at.getTimezoneOffset() * 60_000);
  return here.toISOString().replace(/(?::00)?(?:\.000)?Z$/, "");
}

export const moment = (input: HTMLInputElement): string | undefined =>
  input.value ? new Date(input.value).toISOString() : undefined;

/** A share in percent, without the last digits that doubles add. */
export const percent = (share: number): string => String(Number((100 * share).toPrecision(15)));

/** What a field for one number takes. */
export interface Takes {
  low: number;
  high?: number;
  whole?: true;
  /** It may stay empty. */
  empty?: true;
}

/** What is wrong with what is typed as one number; nothing where it fits. */
export function wrongNumber(text: string, { low, high, whole, empty }: Takes): string | undefined {
  if (empty && text.trim() === "") return undefined;
  const value = typedNumber(text);
  if (value >= low && value <= (high ?? Infinity) && (!whole || Number.isInteger(value))) return undefined;
  const unclear = unclearComma(text);
  if (unclear !== undefined) return unclear;
  return high === undefined
    ? t("Write a whole number, {low} or more.", { low })
    : t("Write a number from {low} to {high}.", { low: num(low), high: num(high) });
}

/** A share list as it is typed, in percent. */
const words = (text: string): string[] => text.split(/[\s,;%]+/).filter(Boolean);

/** Shares in percent, one after the other. */
export const shares = (text: string): number[] => words(text).map((word) => typedNumber(word) / 100);

/** What is wrong with a list of shares; nothing where it is one. */
export function wrongShares(text: string): string | undefined {
  const unclear = /[^\s;]*\d,\d[^\s;]*/.exec(text)?.[0];
  if (unclear !== undefined)
    return t(
      "{word}: a decimal comma, or two numbers? Write a point in the one, a blank after the comma between the others.",
      { word: unclear },
    );
  const word = words(text).find((one) => wrongNumber(one, { low: 0, high: 100 }) !== undefined);
  return word === undefined
    ? undefined
    : t("{word} is no share: write numbers from 0 to 100, such as 100, 87.5, 80.", { word });
}

/** A field that takes no form along while something is wrong with its text. */
function checked(
  props: Record<string, string>,
  wrong: (text: string) => string | undefined,
): HTMLInputElement {
  const input = h("input", { type: "text", autocomplete: "off", ...props });
  input.addEventListener("input", () => input.setCustomValidity(wrong(input.value) ?? ""));
  return input;
}

/** A field for one number, a decimal comma in it or a point: a browser's own field drops the sign that its language does not have. */
export const numberField = (value: string, takes: Takes): HTMLInputElement =>
  checked({ class: "field number", inputmode: takes.whole ? "numeric" : "decimal", value }, (text) =>
    wrongNumber(text, takes),
  );

export const sharesField = (value: readonly number[]): HTMLInputElement =>
  checked({ class: "field", placeholder: "100, 90, 80", value: value.map(percent).join(", ") }, wrongShares);

/** A field with its label above it. */
export function labelled(label: string, input: HTMLElement, id: string): HTMLElement {
  input.id = id;
  return h("div", { class: "stack tight" }, h("label", { for: id }, label), input);
}

/** A choice of one student, or of none. */
export function personChoice(students: Somebody[], none: string): HTMLSelectElement {
  return h(
    "select",
    { class: "field" },
    h("option", { value: "" }, none),
    ...students.map((person) => h("option", { value: person.id }, person.name)),
  );
}
