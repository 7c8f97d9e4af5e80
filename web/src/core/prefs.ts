// What the browser remembers. Private windows may refuse storage: then nothing is remembered.

type Key =
  | "theme"
  | "projector"
  | "student"
  | "shortcuts"
  | "picture"
  | `draft:${string}`
  | `tab:${string}`
  | "scene-draft"
  | `scene-draft:${string}`
  | `said:${string}`
  | "place"
  | "voter";

export function recall(key: Key): string | null {
  try {
    return localStorage.getItem(`triad:${key}`);
  } catch {
    return null;
  }
}

export function remember(key: Key, value: string | null): void {
  try {
    if (value === null) localStorage.removeItem(`triad:${key}`);
    else localStorage.setItem(`triad:${key}`, value);
  } catch {
    // Nothing is remembered; the page works all the same.
  }
}

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

/** Big type and strong lines, for the back of a room. */
export const projector = (): boolean => recall("projector") === "on";

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

systemDark.addEventListener("change", applyTheme);

/** The name of who is signed in, empty for nobody; undefined where there are no accounts and a name is typed. */
let account: string | undefined;

export const student = {
  get: (): string => account ?? recall("student") ?? "",
  set: (name: string): void => {
    if (account === undefined) remember("student", name.trim() || null);
  },
  /** From now on the name is that of an account. */
  signedIn: (name: string): void => {
    account = name;
  },
  /** Whether names belong to accounts. */
  known: (): boolean => account !== undefined,
};

export const reducedMotion = (): boolean => matchMedia("(prefers-reduced-motion: reduce)").matches;
