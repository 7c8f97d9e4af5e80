// What the numbers of a state are worth, by the run's own estimate; its words stand beside the numbers.

import type { Accuracy, SessionState } from "../api/types";
import { h, setText } from "../core/dom";
import { sci, seconds } from "../core/format";
import { parts, t } from "../core/texts";

/** About how far a quantity of a state may be off. The unit stays in the line of its number. */
export function within(state: SessionState, what: keyof Accuracy, unit: string): string {
  const error = state.accuracy?.[what];
  if (typeof error === "number") return t("about {error}", { error: `${sci(error, 1)}\u00a0${unit}` });
  const lost = state.error_unknown_from;
  return typeof lost === "number" && !state.accuracy
    ? t("unknown from {lost}", { lost: seconds(lost) })
    : "–";
}

/** A quantity whose error is told, with the words for it. */
interface Told {
  what: keyof Accuracy;
  unit: string;
  words: (error: string) => string;
}

export const OF_BODIES: readonly Told[] = [
  { what: "position", unit: "m", words: (error) => t("positions {error}", { error }) },
  { what: "velocity", unit: "m/s", words: (error) => t("velocities {error}", { error }) },
  { what: "turn", unit: "rad", words: (error) => t("directions {error}", { error }) },
  { what: "angular_velocity", unit: "rad/s", words: (error) => t("angular velocities {error}", { error }) },
];
export const OF_JOINTS: readonly Told[] = [
  { what: "force", unit: "N", words: (error) => t("forces {error}", { error }) },
  { what: "moment", unit: "N m", words: (error) => t("moments about the joint {error}", { error }) },
];

/** What the numbers of a table are worth: a sentence, or that nothing is known. */
export function worth(state: SessionState, quantities: readonly Told[]): string {
  const errors = quantities.flatMap(({ what, unit, words }) => {
    const error = state.accuracy?.[what];
    return typeof error === "number" ? [words(`${sci(error, 1)}\u00a0${unit.replace(" ", "\u00a0")}`)] : [];
  });
  if (errors.length > 0)
    return t("Estimated error at {time}, the largest of all: {errors}.", {
      time: seconds(state.time),
      errors: errors.join(", "),
    });
  const lost = state.error_unknown_from;
  return typeof lost === "number" && !state.accuracy
    ? t("From {lost} on nothing is known of the error: these numbers may be far off.", {
        lost: seconds(lost),
      })
    : t("This run gives no estimate of their error.");
}

/** The sentence beside the numbers of a table. */
export function worthLine(quantities: readonly Told[]): {
  root: HTMLElement;
  show: (state: SessionState) => void;
} {
  const root = h("p", { class: "when" });
  return { root, show: (state) => setText(root, worth(state, quantities)) };
}

/** What an estimate is of, and what it is not. */
export const meaning = (): HTMLElement =>
  h(
    "p",
    { class: "when" },
    ...parts(
      "“Right to” is the run’s own estimate of its error since the start, the largest over all bodies or joints: of the method and its rounding. Whether the model is the mechanism is not in it. {more}.",
      {
        more: h(
          "a",
          { href: "/docs/accuracy.html", target: "_blank", rel: "noopener" },
          t("What it promises"),
        ),
      },
    ),
  );
