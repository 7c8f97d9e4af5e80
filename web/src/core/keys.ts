// Single-key shortcuts. They stay silent while somebody types, and can be switched off.
import { recall, remember } from "./prefs";

export interface Shortcut {
  keys: string[];
  shown: string;
  /** What it does, as the help lists it. */
  does: string;
  /** `held` tells that the key was not pressed but is still down. */
  run: (held: boolean) => void;
}

const active = new Map<string, Shortcut>();
const listed: Shortcut[] = [];

export const shortcuts = {
  on: (): boolean => recall("shortcuts") !== "off",
  set: (on: boolean): void => remember("shortcuts", on ? null : "off"),
  list: (): readonly Shortcut[] => listed,
};

/** Adds shortcuts; the returned function removes them. */
export function bind(list: Shortcut[]): () => void {
  for (const shortcut of list) {
    // A view that is made anew takes the place of the one before.
    const before = listed.findIndex((other) => other.does === shortcut.does);
    if (before >= 0) listed.splice(before, 1);
    listed.push(shortcut);
    for (const key of shortcut.keys) active.set(key, shortcut);
  }
  return () => {
    for (const shortcut of list) {
      const at = listed.indexOf(shortcut);
      if (at >= 0) listed.splice(at, 1);
      for (const key of shortcut.keys) if (active.get(key) === shortcut) active.delete(key);
    }
  };
}

const ACTIVATED_BY_SPACE = "button, a[href], summary, input, select, [role=tab], [role=switch]";

/** True where a key belongs to the focused element and not to the page. */
function taken(event: KeyboardEvent): boolean {
  const target = event.target;
  if (!(target instanceof HTMLElement)) return false;
  if (
    target.isContentEditable ||
    target.closest(
      "textarea, input:not([type=range]):not([type=radio]):not([type=checkbox]), select, dialog, [data-keys]",
    )
  ) {
    return true;
  }
  if (event.key === " ") return target.closest(ACTIVATED_BY_SPACE) !== null;
  // With Shift, arrows turn the drawing that has the focus.
  if (event.key.startsWith("Arrow")) return event.shiftKey || target.closest("input, [role=tab]") !== null;
  return false;
}

/** The viewer's canvas swallows all keys; the page's own keys must work there too. */
function inViewer(event: KeyboardEvent): boolean {
  return event.target instanceof HTMLCanvasElement && event.target.closest("[data-viewer]") !== null;
}

// Heard before anything else, because the viewer stops the events that it sees.
addEventListener(
  "keydown",
  (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing) return;
    if (inViewer(event) && event.key === "Tab") {
      // The browser moves the focus on: nobody is caught inside the canvas.
      event.stopImmediatePropagation();
      return;
    }
    if (!shortcuts.on() && event.key !== "?") return;
    if (taken(event) || document.querySelector("dialog[open]")) return;
    const shortcut = active.get(event.key);
    if (!shortcut) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    shortcut.run(event.repeat);
  },
  { capture: true },
);
