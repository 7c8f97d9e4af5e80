// One of the author's parameters: a slider, the number beside it, and the way back to the author's value.

import type { SessionParameter } from "../../api/types";
import { h, setText } from "../../core/dom";
import { num, typedIn, unclearComma } from "../../core/format";
import { t } from "../../core/texts";

/** Steps of a slider whose author chose none. */
const STEPS = 200;
/** A positive range whose ends differ by more than this factor is dragged by its exponent. */
const LOGARITHMIC_FROM = 1e3;
/** Digits of a value that is dragged by its exponent. */
const LOGARITHMIC_DIGITS = 2;

export class ParameterRow {
  readonly root: HTMLElement;
  private readonly slider: HTMLInputElement;
  private readonly field: HTMLInputElement;
  private readonly initial: HTMLButtonElement;
  private readonly wrong = h("p", { class: "field-wrong", role: "alert" });
  private readonly logarithmic: boolean;

  /** `set` is called with each value that is chosen. */
  constructor(
    private readonly parameter: SessionParameter,
    private readonly set: (value: number) => void,
  ) {
    const { label, unit, low, high, step, initial } = parameter;
    this.logarithmic = step === null && low > 0 && high / low > LOGARITHMIC_FROM;
    this.slider = h("input", {
      type: "range",
      class: "slider",
      min: String(this.place(low)),
      max: String(this.place(high)),
      step: this.logarithmic ? "any" : String(step ?? (high - low) / STEPS),
      "aria-label": label,
    });
    this.field = h("input", {
      type: "text",
      inputmode: "decimal",
      autocomplete: "off",
      class: "field number compact",
      "aria-label": `${label}${unit ? `, ${t("in {unit}", { unit })}` : ""}`,
    });
    this.initial = h(
      "button",
      { type: "button", class: "button quiet small", hidden: true, onclick: () => set(initial) },
      t("back to {initial}", { initial: num(initial) }),
    );
    this.root = this.layout();
    this.slider.addEventListener("input", () => this.drag());
    this.field.addEventListener("change", () => this.read());
    this.field.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.field.blur();
    });
  }

  show(parameter: SessionParameter, value: number): void {
    const { slider, field } = this;
    const { low, high, unit, initial } = parameter;
    if (document.activeElement !== slider) slider.value = String(this.place(value));
    if (document.activeElement !== field || field.value === "") field.value = plain(value);
    slider.setAttribute("aria-valuetext", `${num(value)}${unit ? ` ${unit}` : ""}`);
    const done = (this.place(value) - this.place(low)) / (this.place(high) - this.place(low));
    slider.style.setProperty("--done", `${100 * done}%`);
    this.initial.hidden = value === initial;
    this.root.classList.toggle("is-changed", value !== initial);
    if (!field.matches("[aria-invalid]")) setText(this.wrong, "");
  }

  private layout(): HTMLElement {
    const { label, unit, on_change: onChange } = this.parameter;
    const goesOn = onChange === "continue";
    return h(
      "div",
      { class: "parameter" },
      h(
        "div",
        { class: "parameter-head" },
        h("span", { class: "parameter-label" }, label),
        this.initial,
        h(
          "span",
          {
            class: "help",
            title: goesOn ? t("The run goes on from where it stands") : t("The run starts over"),
          },
          goesOn ? t("changes at once") : t("restarts the run"),
        ),
      ),
      h(
        "div",
        { class: "parameter-row" },
        this.slider,
        h("span", { class: "parameter-value" }, this.field, h("span", { class: "unit" }, unit ?? "")),
      ),
      this.wrong,
    );
  }

  /** Where a value stands on the slider. */
  private place(value: number): number {
    return this.logarithmic ? Math.log10(value) : value;
  }

  private drag(): void {
    const at = Number(this.slider.value);
    const value = this.logarithmic ? Number((10 ** at).toPrecision(LOGARITHMIC_DIGITS)) : at;
    this.field.value = plain(value);
    this.set(value);
  }

  private read(): void {
    const { low, high, unit } = this.parameter;
    const value = typedIn(unit ?? "", this.field.value);
    const good = value >= low && value <= high;
    if (good) this.field.removeAttribute("aria-invalid");
    else this.field.setAttribute("aria-invalid", "true");
    setText(
      this.wrong,
      good
        ? ""
        : (unclearComma(this.field.value) ??
            t("Write a number from {low} to {high}.", { low: num(low), high: num(high) })),
    );
    if (!good) return;
    // The unit stands behind the field.
    this.field.value = plain(value);
    this.set(value);
  }
}

/** As one would type it. */
const plain = (value: number): string => String(Number(value.toPrecision(10)));
