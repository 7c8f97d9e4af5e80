// Light or dark, for the screen or for the back of a room.

import { recall, remember } from "./prefs";

export type Theme = "light" | "dark";
const themeListeners = new Set<(theme: Theme) => void>();
const systemDark = matchMedia("(prefers-color-scheme: dark)");

export function theme(): Theme {
  const chosen = recall("theme");
  if (chosen === "light" || chosen === "dark") return chosen;
  return systemDark.matches ? "dark" : "light";
}

export function applyTheme(): void {
  document.documentElement.dataset.theme = theme();
  document.documentElement.toggleAttribute("data-projector", projector());
  for (const listener of themeListeners) listener(theme());
}

/** This window is for the back of a room, whatever the others are. */
let hall = false;

/** Big type and strong lines, for the back of a room. */
export const projector = (): boolean => hall || recall("projector") === "on";

/** This window alone is for the back of a room, until the returned function is called. */
export function forTheHall(): () => void {
  hall = true;
  applyTheme();
  return () => {
    hall = false;
    applyTheme();
  };
}

export function toggleProjector(): void {
  remember("projector", projector() ? null : "on");
  applyTheme();
}

export function toggleTheme(): Theme {
  const next: Theme = theme() === "dark" ? "light" : "dark";
  const system: Theme = systemDark.matches ? "dark" : "light";
  remember("theme", next === system ? null : next);
  applyTheme();
  return next;
}

/** Calls back on every change of theme until the returned function is called. */
export function onTheme(listener: (theme: Theme) => void): () => void {
  themeListeners.add(listener);
  return () => themeListeners.delete(listener);
}

/** Calls back when the page is about to be printed, in light colours, until the returned function is called. */
export function onPrint(listener: () => void): () => void {
  const before = (): void => {
    document.documentElement.dataset.theme = "light";
    document.documentElement.removeAttribute("data-projector");
    for (const each of themeListeners) each("light");
    listener();
  };
  addEventListener("beforeprint", before);
  addEventListener("afterprint", applyTheme);
  return () => {
    removeEventListener("beforeprint", before);
    removeEventListener("afterprint", applyTheme);
  };
}

systemDark.addEventListener("change", applyTheme);
