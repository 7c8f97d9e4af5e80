// What was predicted, for who teaches; at home, for all names that were used here.

import { api } from "../api/client";
import { inClass, teaches } from "../api/identity";
import type { Lesson, PredictionCounts } from "../api/types";
import { authored, h } from "../core/dom";
import { setMaths } from "../core/maths";
import { t } from "../core/texts";
import { histogram } from "../lecture/histogram";
import { problemNotice } from "../ui/notice";

export function predictionCounts(lesson: Lesson): HTMLElement | null {
  if (lesson.predictions.length === 0 || (inClass() && !teaches())) return null;
  const place = h("div");
  const load = async (): Promise<void> => {
    try {
      const found = await api.predictionCounts(lesson.slug);
      place.replaceChildren(...found.map(one));
      await setMaths(place);
    } catch (error) {
      place.replaceChildren(problemNotice(error));
    }
  };
  const title = inClass() ? t("What the class predicted") : t("What was predicted here");
  const details = h("details", { class: "prose prediction-counts" }, h("summary", null, title), place);
  details.addEventListener("toggle", () => {
    if (details.open) void load();
  });
  return details;
}

function one(found: PredictionCounts): HTMLElement {
  const names = found.options.map((option) => authored(h("span"), option.html).textContent ?? option.id);
  const right = found.options.findIndex((option) => option.id === found.happens);
  return h(
    "div",
    { class: "prediction-count" },
    authored(h("div"), found.html),
    histogram(names, { counts: found.chosen, right, revealed: true }),
    h(
      "p",
      { class: "help" },
      t("{skipped} skipped, {students} not there yet.", {
        skipped: found.skipped,
        students: t("{n} student | {n} students", { n: found.missing }),
      }),
    ),
    found.reasons.length > 0
      ? h(
          "ul",
          null,
          ...found.reasons.map((reason) =>
            h(
              "li",
              null,
              h("b", null, reason.name),
              reason.option ? authored(h("span"), ` (${reason.option.html})`) : ` (${t("skipped")})`,
              `: ${reason.why}`,
            ),
          ),
        )
      : null,
  );
}
