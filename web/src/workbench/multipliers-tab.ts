// Multipliers joint by joint, and the force and moment that they stand for, said completely:
// on which body, about which point, in which frame.
import { api } from "../core/api";
import { h } from "../core/dom";
import { num, seconds } from "../core/format";
import type { BodyFrame, JointMultipliers, SessionState, Vec3 } from "../core/types";
import { empty, problemNotice } from "../ui/notice";
import { fetched } from "./fetched";
import type { InspectorTab } from "./inspector";
import type { Session } from "./session";
import { norm } from "./vec";
import { wrench, type About, type Frame, type Side } from "./wrench";

export function multipliersTab(session: Session): InspectorTab {
  const list = h("div", { class: "joints" });
  let seenSelection: string | null = null;
  const when = h("p", { class: "when" });
  let joints: JointMultipliers[] = [];
  let of: SessionState | undefined;

  const side = choice("Acting on", [["j", "second body"], ["i", "first body"]], "j");
  const about = choice("Moment about", [["joint", "the joint"], ["centre", "centre of mass"]], "joint");
  const frame = choice("Components in", [["world", "world frame"], ["body", "body axes"]], "world");
  const paint = (): void => {
    when.textContent = of ? `At ${seconds(of.time)}${session.reviewing ? ", the newest time: multipliers are not kept for earlier times" : ""}.` : "";
    seenSelection = session.joint;
    const keep = heldFocus(list);
    list.replaceChildren(...(joints.length === 0
      ? [empty("No joints", "This scene has no joint, hence no multiplier that is a joint force.")]
      : joints.map((joint) => card(joint, of?.bodies ?? [], side.value() as Side, about.value() as About, frame.value() as Frame, {
        on: session.joint === joint.joint,
        toggle: () => session.select(session.joint === joint.joint ? null : joint.joint),
      }))));
    keep();
  };
  for (const control of [side, about, frame]) control.root.addEventListener("change", paint);

  const source = fetched(session, api.multipliers, (value, state) => {
    joints = value;
    of = state;
    paint();
  }, (error) => list.replaceChildren(problemNotice(error)));

  return {
    root: h("div", { class: "stack" }, h("div", { class: "switches" }, side.root, about.root, frame.root), list, when),
    refresh: () => {
      if (seenSelection !== session.joint) {
        paint();
        list.querySelector(".joint.is-selected")?.scrollIntoView({ block: "nearest" });
      }
      source.refresh();
    },
  };
}

/** The cards are made anew as time goes on; whoever stands in one with the keyboard stays there. */
function heldFocus(list: HTMLElement): () => void {
  const focused = document.activeElement;
  if (!(focused instanceof HTMLElement) || !list.contains(focused)) return () => undefined;
  const at = [...list.children].findIndex((child) => child.contains(focused));
  const what = focused.classList.contains("joint-select") ? ".joint-select" : ".table-scroll";
  return () => list.children[at]?.querySelector<HTMLElement>(what)?.focus({ preventScroll: true });
}

function choice(label: string, options: [string, string][], start: string): { root: HTMLElement; value: () => string } {
  const select = h("select", { class: "field compact" }, ...options.map(([value, text]) => h("option", { value, selected: value === start }, text)));
  return { root: h("label", { class: "switch" }, h("span", null, label), select), value: () => select.value };
}

function card(joint: JointMultipliers, bodies: BodyFrame[], side: Side, about: About, frame: Frame, selection: { on: boolean; toggle: () => void }): HTMLElement {
  const on = side === "j" ? joint.on : joint.by;
  const body = bodies.find((entry) => entry.name === on);
  const { force, moment } = wrench(joint, body, side, about, frame);
  const point = about === "centre" && body ? body.position : joint.at;
  const axes = frame === "body" && body ? ["u", "v", "w"] : ["x", "y", "z"];
  const row = (label: string, symbol: string, value: Vec3, unit: string): HTMLElement => h("tr", null,
    h("th", { scope: "row" }, label),
    ...value.map((part, k) => h("td", { class: "number" }, h("span", { class: "component-name" }, `${symbol}${axes[k]} `), num(part, 6))),
    h("td", { class: "number strong" }, `${num(norm(value), 6)} `, h("span", { class: "unit" }, unit)));

  return h("article", { class: selection.on ? "joint is-selected" : "joint" },
    h("h3", null, h("button", { type: "button", class: "joint-select", "aria-pressed": String(selection.on), title: "Mark its rows in the Jacobian", onclick: selection.toggle }, joint.joint)),
    h("p", { class: "said" }, `On ${on}; moment about ${about === "centre" && body ? `the centre of mass of ${on}` : "the joint"} at (${point.map((part) => num(part, 4)).join(", ")}) m; components in ${frame === "body" && body ? `the axes of ${on}` : "the world frame"}.`),
    h("div", { class: "table-scroll", tabindex: "0", role: "region", "aria-label": `Reaction of ${joint.joint}` },
      h("table", { class: "data" },
        h("thead", { class: "visually-hidden" }, h("tr", null, h("th", { scope: "col" }, "Quantity"), ...axes.map((axis) => h("th", { scope: "col" }, axis)), h("th", { scope: "col" }, "Size"))),
        h("tbody", null, row("Force", "F", force, "N"), row("Moment", "M", moment, "N m")))),
    h("ul", { class: "lambdas", "aria-label": `Multipliers of ${joint.joint}` },
      ...joint.rows.map((entry) => h("li", null, h("span", null, entry.label), h("b", null, `λ = ${num(entry.value, 6)}`)))));
}
