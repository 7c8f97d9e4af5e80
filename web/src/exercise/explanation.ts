// An explanation in words, with their number beside it.
import type { Question } from "../api/types";
import { h, setText } from "../core/dom";
import { t } from "../core/texts";
import type { Inputs, QuestionContext } from "./field";

/** Letters of Thai, Lao, Tibetan, Burmese, Khmer, Japanese and Chinese, whose words have no spaces between them. */
const WITHOUT_SPACES =
  /(?=\p{Alphabetic})[\u{e00}-\u{109f}\u{1780}-\u{17ff}\u{3040}-\u{30ff}\u{3400}-\u{4dbf}\u{4e00}-\u{9fff}\u{f900}-\u{faff}\u{20000}-\u{3ffff}]/gu;

/** Of these letters so many count as a word. */
const LETTERS_OF_A_WORD = 2;

/** Words as the grader counts them: what has a letter between spaces; so many letters where there are no spaces. */
export function words(text: string): number {
  const letters = text.match(WITHOUT_SPACES)?.length ?? 0;
  const apart = text.replace(WITHOUT_SPACES, " ").split(/\s+/u);
  return apart.filter((word) => /\p{Alphabetic}/u.test(word)).length + Math.ceil(letters / LETTERS_OF_A_WORD);
}

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
