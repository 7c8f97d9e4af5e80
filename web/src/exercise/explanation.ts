// An explanation in words, with their number beside it.
import type { Question } from "../api/types";
import { h, setText } from "../core/dom";
import { t } from "../core/texts";
import type { Inputs, QuestionContext } from "./field";

/** Words as the grader counts them: what has a letter between spaces. */
export const words = (text: string): number =>
  text.split(/\s+/u).filter((word) => /\p{Alphabetic}/u.test(word)).length;

export function explanationInput(
  question: Question,
  place: QuestionContext,
  draft: string[] | undefined,
): Inputs {
  const wanted = question.min_words ?? 1;
  const countId = `${place.base}-count`;
  const text = h("textarea", {
    id: `${place.base}-text`,
    class: "field",
    rows: "6",
    maxlength: "10000",
    "aria-label": place.named(t("Your explanation")),
    "aria-describedby": `${countId} ${place.described}`,
  });
  text.value = draft?.[0] ?? "";
  const count = h("p", { class: "help", id: countId });
  const paint = (): void => {
    const found = words(text.value);
    setText(
      count,
      found >= wanted
        ? t("{found} of at least {wanted} words: enough", { found, wanted })
        : t("{found} of at least {wanted} words", { found, wanted }),
    );
  };
  text.addEventListener("input", paint);
  paint();
  return {
    root: h("div", { class: "answer is-explanation" }, text, count),
    answer: () => ({ value: text.value }),
    draft: () => [text.value],
  };
}
