// What the browser remembers. Private windows may refuse storage: then nothing is remembered.

type Key =
  | "theme"
  | "projector"
  | "student"
  | "shortcuts"
  | "picture"
  | "computed"
  | "language"
  | `draft:${string}`
  | `tab:${string}`
  | "scene-draft"
  | `scene-draft:${string}`
  | "scene-aside"
  | `scene-aside:${string}`
  | `said:${string}`
  | `why:${string}`
  | `slides:${string}`
  | "place"
  | "voter"
  | `divider:${string}`
  | "room-name"
  | "room-secret";

export function recall(key: Key): string | null {
  try {
    return localStorage.getItem(`triad:${key}`);
  } catch {
    return null;
  }
}

/** Whether something is kept under one of these names, or under one of them with more behind a colon. */
export function recallsAny(...names: string[]): boolean {
  try {
    return Object.keys(localStorage).some((key) =>
      names.some((name) => key === `triad:${name}` || key.startsWith(`triad:${name}:`)),
    );
  } catch {
    return false;
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

/** Calls back when another tab remembers something else under a name, until the returned function is called. */
export function onRemembered(key: Key, heard: () => void): () => void {
  const listener = (event: StorageEvent): void => {
    if (event.key === `triad:${key}`) heard();
  };
  addEventListener("storage", listener);
  return () => removeEventListener("storage", listener);
}

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
