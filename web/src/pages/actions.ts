// Steps that act: what a step names in bold, and the times to which it runs, can be pressed.

import { h } from "../core/dom";
import type { Action } from "../workbench/acting";

/** Names of controls and panels, as lessons write them in bold. */
const NAMED: Record<string, Action> = {
  play: { do: "play" },
  step: { do: "step" },
  "one integrator step": { do: "step" },
  "all numbers of this scene": { do: "numbers" },
  parameters: { do: "panel", panel: "parameters" },
  state: { do: "panel", panel: "state" },
  jacobian: { do: "panel", panel: "jacobian" },
  reactions: { do: "panel", panel: "multipliers" },
  bodies: { do: "panel", panel: "bodies" },
  plots: { do: "panel", panel: "plots" },
  analyses: { do: "panel", panel: "analyses" },
};

/** Phrases outside bold: "run to 2 s", "stop at 0.5 s", "Reset", "open the Jacobian", "open the multipliers". */
const PHRASES =
  /\b(?:(?:run(?: it| the scene)?|play(?: at a low speed)?) to (\d+(?:\.\d+)?) s\b|stop at (\d+(?:\.\d+)?) s\b|(reset)\b|open the (jacobian|multipliers|reactions|plots|bodies)\b)/gi;

/** What a piece of text asks for; the pieces around it stay as they are. */
export function actionsOf(text: string): { from: number; to: number; action: Action }[] {
  return Array.from(text.matchAll(PHRASES), (found) => {
    const [whole, runTo, stopAt, reset, panel] = found;
    const time = Number(runTo ?? stopAt);
    const name = panel?.toLowerCase();
    const action: Action = reset
      ? { do: "reset" }
      : name
        ? { do: "panel", panel: name === "reactions" ? "multipliers" : name }
        : { do: "run", time };
    return { from: found.index, to: found.index + whole.length, action };
  });
}

/** The control that a step names in bold. */
export const actionNamed = (name: string): Action | undefined => NAMED[name.trim().toLowerCase()];

/** Makes what an author's step asks for pressable. */
export function makePressable(step: HTMLElement, act: (action: Action) => void): void {
  const button = (words: string, action: Action): HTMLElement =>
    h("button", { type: "button", class: "do", onclick: () => act(action) }, words);
  for (const bold of step.querySelectorAll("strong")) {
    const action = actionNamed(bold.textContent ?? "");
    if (action) bold.replaceWith(button(bold.textContent ?? "", action));
  }
  const texts: Text[] = [];
  const walker = document.createTreeWalker(step, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const text = walker.currentNode as Text;
    if (!text.parentElement?.closest("a, button, code, .math")) texts.push(text);
  }
  for (const text of texts) {
    const found = actionsOf(text.data);
    if (found.length === 0) continue;
    const parts: (string | HTMLElement)[] = [];
    let at = 0;
    for (const { from, to, action } of found) {
      parts.push(text.data.slice(at, from), button(text.data.slice(from, to), action));
      at = to;
    }
    text.replaceWith(...parts, text.data.slice(at));
  }
}
