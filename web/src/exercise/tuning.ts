// Settings of a run under a budget: integrator, tolerance, stabilization.

import type { IntegratorKind, Question } from "../api/types";
import { h, uid } from "../core/dom";
import { t } from "../core/texts";
import { type Inputs, type QuestionContext, textInput } from "./field";

interface TuningSettings {
  integrator: IntegratorKind;
  tolerance: string;
  baumgarte?: [string, string];
}

const NAMES: Record<string, () => string> = {
  dopri5: () => t("Dormand-Prince, order 5"),
  dop853: () => t("Dormand-Prince, order 8"),
  taylor: () => t("Taylor series"),
};

export function tuningInput(
  question: Question,
  context: QuestionContext,
  draft: string[] | undefined,
): Inputs {
  const { base, described } = context;
  const offered = question.tuning ?? { integrators: [], baumgarte: false, budget: 0, error: 0 };
  const integrator = h(
    "select",
    { id: `${base}-integrator`, class: "field", "aria-describedby": described },
    ...offered.integrators.map((kind) => h("option", { value: kind }, NAMES[kind]?.() ?? kind)),
  );
  const drafted = offered.integrators.find((kind) => kind === draft?.[0]);
  if (drafted) integrator.value = drafted;
  const tolerance = textInput(`${base}-tolerance`, t("Tolerance"), described, draft?.[1] ?? "");
  tolerance.placeholder = "1e-6";
  tolerance.inputMode = "text";
  const kind = h(
    "select",
    { id: `${base}-stabilization`, class: "field", "aria-describedby": described },
    h("option", { value: "projection" }, t("Projection")),
    h("option", { value: "baumgarte" }, "Baumgarte"),
  );
  kind.value = draft?.[2] === "baumgarte" ? "baumgarte" : "projection";
  const alpha = textInput(`${base}-alpha`, t("Alpha in 1/s"), described, draft?.[3] ?? "");
  const beta = textInput(`${base}-beta`, t("Beta in 1/s"), described, draft?.[4] ?? "");
  const parameters = h("div", { class: "settings" }, labelled("α, 1/s", alpha), labelled("β, 1/s", beta));
  const paint = (): void => {
    parameters.hidden = kind.value !== "baumgarte";
  };
  kind.addEventListener("change", paint);
  paint();
  const main = [labelled(t("Integrator"), integrator), labelled(t("Tolerance"), tolerance)];
  if (offered.baumgarte) main.push(labelled(t("Stabilization"), kind));
  const settings = (): TuningSettings => ({
    integrator: integrator.value as IntegratorKind,
    tolerance: tolerance.value.trim(),
    ...(offered.baumgarte && kind.value === "baumgarte"
      ? { baumgarte: [alpha.value.trim() || "0", beta.value.trim() || "0"] }
      : {}),
  });
  return {
    root: h(
      "div",
      { class: "answer is-tuning" },
      h("div", { class: "settings" }, ...main),
      offered.baumgarte ? parameters : null,
    ),
    answer: () => (tolerance.value.trim() === "" ? { value: "" } : { settings: settings() }),
    draft: () => [integrator.value, tolerance.value, kind.value, alpha.value, beta.value],
  };
}

function labelled(label: string, field: HTMLElement): HTMLElement {
  const id = field.id || uid("setting");
  field.id = id;
  return h("div", { class: "setting" }, h("label", { for: id }, label), field);
}
