// What may be changed while it runs: the author's parameters as sliders, every other number for experts.

import { count, type Numbers, none } from "../api/numbers";
import type { AfterChange, SessionParameter } from "../api/types";
import { announce, h, setText } from "../core/dom";
import { num, plural } from "../core/format";
import type { Session } from "../session/session";
import { empty, problemNotice } from "../ui/notice";
import type { Panel } from "../ui/panel";
import { expertPanel } from "./expert-panel";
import { pullPanel } from "./pull-panel";

/** Steps of a slider whose author chose none. */
const STEPS = 200;

interface Row {
  root: HTMLElement;
  show: (parameter: SessionParameter, value: number) => void;
}

export function parametersTab(session: Session): Panel {
  const rows = new Map<string, Row>();
  const list = h("div", { class: "parameters" });
  const trouble = h("div", { "aria-live": "polite" });
  const state = h("p", { class: "help", role: "status" });
  const undo = h(
    "button",
    { type: "button", class: "button small", onclick: () => void attempt(() => session.undo()) },
    "Undo",
  );
  const reset = h(
    "button",
    { type: "button", class: "button small", onclick: () => void attempt(() => session.change(none())) },
    "Reset all",
  );
  let wanted: { to: Numbers; then?: AfterChange | undefined } | undefined;
  let sending = false;

  const attempt = async (change: () => Promise<void>): Promise<void> => {
    try {
      await change();
      trouble.replaceChildren();
    } catch (error) {
      trouble.replaceChildren(problemNotice(error));
    }
    paint();
  };
  /** A slider that is dragged asks often: one request at a time, the newest wins. */
  const ask = (to: Numbers, then?: AfterChange): void => {
    wanted = { to, then };
    if (sending) return;
    sending = true;
    void (async () => {
      while (wanted) {
        const { to: next, then: after } = wanted;
        wanted = undefined;
        await attempt(() => session.change(next, after));
      }
      sending = false;
      paint();
    })();
  };
  const setValue = (name: string, value: number): void => {
    const base = wanted?.to ?? session.numbers;
    ask({ values: { ...base.values, [name]: value }, places: base.places });
  };
  const expert = expertPanel(session, (pointer, value, then) => {
    const base = wanted?.to ?? session.numbers;
    ask({ values: base.values, places: { ...base.places, [pointer]: value } }, then);
  });

  const hand = pullPanel(session);

  const paint = (): void => {
    const view = session.view;
    if (!view) return;
    const names = view.parameters.map((parameter) => parameter.name);
    if (names.join("|") !== [...rows.keys()].join("|") || list.childElementCount === 0) {
      rows.clear();
      for (const parameter of view.parameters) rows.set(parameter.name, parameterRow(parameter, setValue));
      list.replaceChildren(
        ...(rows.size > 0
          ? [...rows.values()].map((row) => row.root)
          : [
              empty(
                "No sliders here",
                "The author of this scene offers no parameters. Every number of it can be changed below.",
              ),
            ]),
      );
    }
    for (const parameter of view.parameters)
      if (!sending) rows.get(parameter.name)?.show(parameter, parameter.value);
    const changed = count(session.numbers);
    setText(state, changed === 0 ? "As the author wrote it." : `${plural(changed, "number")} changed.`);
    undo.disabled = !session.canUndo;
    reset.disabled = changed === 0;
  };
  session.on("scene", () => {
    paint();
    expert.refresh();
    if (count(session.numbers) === 0 && session.canUndo)
      announce("All numbers stand as the author wrote them.");
  });

  return {
    root: h(
      "div",
      { class: "stack" },
      h("div", { class: "row between" }, state, h("div", { class: "row" }, undo, reset)),
      trouble,
      list,
      hand.root,
      expert.root,
    ),
    refresh: () => {
      paint();
      expert.refresh();
      hand.refresh();
    },
  };
}

function parameterRow(start: SessionParameter, set: (name: string, value: number) => void): Row {
  const { name, label, low, high } = start;
  const step = start.step ?? (high - low) / STEPS;
  // A range over many powers of ten is dragged by its exponent.
  const log = start.step === null && low > 0 && high / low > 1e3;
  const place = (value: number): number => (log ? Math.log10(value) : value);
  const slider = h("input", {
    type: "range",
    class: "slider",
    min: String(place(low)),
    max: String(place(high)),
    step: log ? "any" : String(step),
    "aria-label": label,
  });
  const field = h("input", {
    type: "text",
    inputmode: "decimal",
    autocomplete: "off",
    class: "field number compact",
    "aria-label": `${label}${start.unit ? `, in ${start.unit}` : ""}`,
  });
  const initial = h("button", {
    type: "button",
    class: "button quiet small",
    hidden: true,
    onclick: () => set(name, start.initial),
  });
  const wrong = h("p", { class: "field-wrong", role: "alert" });
  const root = h(
    "div",
    { class: "parameter" },
    h(
      "div",
      { class: "parameter-head" },
      h("span", { class: "parameter-label" }, label),
      initial,
      h(
        "span",
        {
          class: "help",
          title:
            start.on_change === "continue" ? "The run goes on from where it stands" : "The run starts over",
        },
        start.on_change === "continue" ? "goes on" : "starts over",
      ),
    ),
    h(
      "div",
      { class: "parameter-row" },
      slider,
      h("span", { class: "parameter-value" }, field, h("span", { class: "unit" }, start.unit ?? "")),
    ),
    wrong,
  );
  setText(initial, `back to ${num(start.initial)}`);

  slider.addEventListener("input", () => {
    const value = log ? Number((10 ** Number(slider.value)).toPrecision(2)) : Number(slider.value);
    field.value = plain(value);
    set(name, value);
  });
  const read = (): void => {
    const typed = field.value.trim().replace(",", ".").replace("−", "-");
    const value = Number(typed);
    const good = typed !== "" && Number.isFinite(value) && value >= low && value <= high;
    field.toggleAttribute("aria-invalid", !good);
    if (!good) field.setAttribute("aria-invalid", "true");
    setText(wrong, good ? "" : `Write a number from ${num(low)} to ${num(high)}.`);
    if (good) set(name, value);
  };
  field.addEventListener("change", read);
  field.addEventListener("keydown", (event) => {
    if (event.key === "Escape") field.blur();
  });

  return {
    root,
    show: (parameter, value) => {
      if (document.activeElement !== slider) slider.value = String(place(value));
      if (document.activeElement !== field || field.value === "") field.value = plain(value);
      slider.setAttribute("aria-valuetext", `${num(value)}${parameter.unit ? ` ${parameter.unit}` : ""}`);
      slider.style.setProperty(
        "--done",
        `${(100 * (place(value) - place(low))) / (place(high) - place(low))}%`,
      );
      const same = value === parameter.initial;
      initial.hidden = same;
      root.classList.toggle("is-changed", !same);
      if (!field.matches("[aria-invalid]")) setText(wrong, "");
    },
  };
}

/** As one would type it. */
const plain = (value: number): string => String(Number(value.toPrecision(10)));
