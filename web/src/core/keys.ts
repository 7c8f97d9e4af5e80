// Single-key shortcuts. They stay silent while somebody types, and can be switched off.
import { recall, remember } from "./prefs";

export interface Shortcut {
  keys: string[];
  shown: string;
  says: string;
  run: () => void;
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
  if (target.isContentEditable || target.closest("textarea, input:not([type=range]):not([type=radio]):not([type=checkbox]), select, dialog, [data-keys]")) {
    return true;
  }
  if (event.key === " ") return target.closest(ACTIVATED_BY_SPACE) !== null;
  if (event.key.startsWith("Arrow")) return target.closest("input, [role=tab]") !== null;
  return false;
}

addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing) return;
  if (!shortcuts.on() && event.key !== "?") return;
  if (taken(event) || document.querySelector("dialog[open]")) return;
  const shortcut = active.get(event.key);
  if (!shortcut) return;
  event.preventDefault();
  shortcut.run();
});
