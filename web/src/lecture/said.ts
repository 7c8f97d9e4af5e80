// What a class predicted and explained in a lesson, for the lecture hall: without names, since it is projected.
import { api } from "../api/client";
import type { ClassWords } from "../api/types";
import { authored, h, setText } from "../core/dom";
import { setMaths } from "../core/maths";
import { t } from "../core/texts";
import { dialog } from "../ui/dialog";
import { problemNotice, skeleton } from "../ui/notice";
import { histogram } from "./histogram";

export function showSaid(slug: string): void {
  const place = h("div", { class: "stack" }, skeleton(4));
  const box = dialog(t("What the class said"), place);
  box.classList.add("is-wide");
  const load = async (): Promise<void> => {
    try {
      const words = await api.classWords(slug);
      const parts = [
        ...words.predictions.map((asked) => predicted(words, asked)),
        ...words.explanations.map((asked) => explained(words, asked)),
      ];
      place.replaceChildren(
        ...(parts.length > 0
          ? parts
          : [h("p", null, t("This lesson asks for no prediction and no explanation."))]),
      );
      await setMaths(place);
    } catch (error) {
      place.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
}

/** How many predicted what. What comes true is told at a press: some may not have seen it. */
function predicted(words: ClassWords, asked: ClassWords["predictions"][number]): HTMLElement {
  const made = words.students.flatMap((one) => one.predicted.filter((each) => each.prediction === asked.id));
  const names = asked.options.map((option) => authored(h("span"), option.html).textContent ?? option.id);
  const counts = asked.options.map((option) => made.filter((each) => each.choice === option.id).length);
  const right = asked.options.findIndex((option) => option.id === asked.happens);
  const bars = h("div", null, histogram(names, { counts, right: null, revealed: false }, undefined));
  const reveal = h("button", { type: "button", class: "button" }, t("What came true"));
  reveal.addEventListener("click", () => {
    bars.replaceChildren(histogram(names, { counts, right, revealed: true }, undefined));
    reveal.remove();
  });
  const skipped = made.filter((each) => each.choice == null).length;
  return h(
    "section",
    null,
    authored(h("div", { class: "presenter-question" }), asked.html),
    bars,
    skipped > 0 ? h("p", { class: "help" }, t("{skipped} skipped it.", { skipped })) : null,
    reveal,
  );
}

/** The explanations one by one, in an order that tells nothing of whose they are. */
function explained(words: ClassWords, asked: ClassWords["explanations"][number]): HTMLElement {
  const all = words.students.flatMap((one) => one.explained.filter((each) => each.question === asked.id));
  const texts = all.map((each) => each.text).sort((a, b) => a.length - b.length || a.localeCompare(b));
  const text = h("blockquote", { class: "said-text" });
  const where = h("span", { role: "status" });
  let at = 0;
  const show = (to: number): void => {
    at = (to + texts.length) % texts.length;
    setText(text, texts[at] ?? "");
    setText(where, t("{place} of {all}", { place: at + 1, all: texts.length }));
  };
  if (texts.length > 0) show(0);
  const step = (by: number, label: string): HTMLElement =>
    h("button", { type: "button", class: "button", onclick: () => show(at + by) }, label);
  return h(
    "section",
    null,
    authored(h("div", { class: "presenter-question" }), asked.prompt_html),
    texts.length === 0
      ? h("p", { class: "help" }, t("Nobody has explained it yet."))
      : h(
          "div",
          null,
          text,
          h("p", { class: "row wrap" }, step(-1, t("← Before")), where, step(1, t("Next →"))),
          h("p", { class: "help" }, t("The shortest first, without names.")),
        ),
  );
}
