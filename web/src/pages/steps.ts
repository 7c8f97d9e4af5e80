// Predict, run, check, explain: what the student writes is kept in this browser, and a prediction is shown again at
// the check.

import type { Lesson } from "../api/types";
import { authored, h, setText } from "../core/dom";
import { recall, remember } from "../core/prefs";
import { parts, t } from "../core/texts";

/** Longest note, characters. */
const MAX_LENGTH = 2000;
const PROMPTS: Record<string, () => string> = {
  predict: () => t("Your prediction"),
  explain: () => t("In your own words"),
};

export function steps(lesson: Lesson): HTMLElement[] {
  if (!lesson.steps?.length) return [];
  const again = h("p", { class: "step-again" });
  const items = lesson.steps.map((step, at) => {
    const item = authored(
      h("li", null),
      `<p><strong>${step.kind[0]?.toUpperCase()}${step.kind.slice(1)}.</strong></p>${step.html}`,
    );
    const prompt = PROMPTS[step.kind]?.();
    if (step.kind === "predict" && lesson.predictions.length > 0)
      item.append(
        h(
          "p",
          null,
          ...parts("{prediction} is asked for beside the mechanism.", {
            prediction: h("a", { href: "#prediction" }, t("Your prediction")),
          }),
        ),
      );
    else if (prompt)
      item.append(note(`said:${lesson.slug}:${at}`, prompt, step.kind === "predict" ? again : null));
    if (step.kind === "check") item.append(again);
    return item;
  });
  return [
    h(
      "section",
      { class: "prose steps", id: "steps" },
      h("h2", null, t("Work with the mechanism")),
      h(
        "p",
        { class: "help" },
        t("What you write here is for you: it stays in this browser and is not graded."),
      ),
      h("ol", null, ...items),
      h(
        "p",
        { class: "help" },
        ...parts("For what has no slider: {link}.", {
          link: h(
            "a",
            { href: `/lessons/${encodeURIComponent(lesson.slug)}/scene` },
            t("open the scene as text"),
          ),
        }),
      ),
    ),
  ];
}

function note(key: `said:${string}`, label: string, again: HTMLElement | null): HTMLElement {
  const area = h("textarea", {
    class: "field",
    rows: "2",
    maxlength: String(MAX_LENGTH),
    "aria-label": label,
    placeholder: label,
  });
  const show = (): void => {
    const words = area.value.trim();
    if (again) setText(again, words ? t("You predicted: {words}", { words }) : "");
  };
  area.value = recall(key) ?? "";
  area.addEventListener("input", () => {
    remember(key, area.value.trim() ? area.value : null);
    show();
  });
  show();
  return area;
}
