// What the numbers of a state are worth, by the run's own estimate; its words stand beside the numbers.

import type { Accuracy, SessionState } from "../api/types";
import { h, setText } from "../core/dom";
import { sci, seconds } from "../core/format";
import { parts, t } from "../core/texts";
import { told } from "../core/told";

/** From when on the error of a quantity is not known, s, in a run that estimates errors; undefined where it is known, or none is. */
export function unknownFrom(state: SessionState, what: keyof Accuracy): number | undefined {
  const { accuracy, error_unknown_from: lost, forces, time } = state;
  if (!accuracy) return lost ?? undefined;
  // Where rows lose their hold forces have no estimate, though all else has one.
  return accuracy[what] == null && forces.length > 0 ? time : undefined;
}

/** About how far a quantity of a state may be off. The unit stays in the line of its number. */
export function within(state: SessionState, what: keyof Accuracy, unit: string): string {
  const error = state.accuracy?.[what];
  if (typeof error === "number") return t("about {error}", { error: `${sci(error, 1)}\u00a0${unit}` });
  const lost = unknownFrom(state, what);
  if (lost === undefined) return "–";
  return state.accuracy ? t("unknown here") : t("unknown from {lost}", { lost: seconds(lost) });
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

/** What the numbers of a table are worth: a sentence, or that nothing is known; why, say the notes of the run. */
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
  const lost = lostIn(state, quantities);
  if (lost === undefined) return t("This run gives no estimate of their error.");
  return state.accuracy
    ? t("At {lost} nothing is known of their error: these numbers may be far off.", { lost: seconds(lost) })
    : t("From {lost} on nothing is known of the error: these numbers may be far off.", {
        lost: seconds(lost),
      });
}

/** From when on nothing is known of the errors of all these quantities. */
function lostIn(state: SessionState, quantities: readonly Told[]): number | undefined {
  const lost = quantities.map(({ what }) => unknownFrom(state, what));
  return lost.includes(undefined) ? undefined : lost[0];
}

/** The sentence beside the numbers of a table. */
export function worthLine(quantities: readonly Told[]): {
  root: HTMLElement;
  show: (state: SessionState) => void;
} {
  const line = h("p");
  const why = h("ul", {
    class: "worth-why",
    hidden: true,
    "aria-label": t("Notes of the engine about this scene"),
  });
  let noted = "";
  const show = (state: SessionState): void => {
    setText(line, worth(state, quantities));
    const notes = lostIn(state, quantities) === undefined ? [] : state.notes;
    why.hidden = notes.length === 0;
    if (notes.join("\n") === noted) return;
    noted = notes.join("\n");
    why.replaceChildren(...notes.map((text) => h("li", null, told(text))));
  };
  return { root: h("div", { class: "when" }, line, why), show };
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
