// Who uses the page: nobody in particular at home, an account in a class.
import { student } from "../core/prefs";
import { t } from "../core/texts";
import { api } from "./client";
import type { Me } from "./types";

const ROLES: Record<string, () => string> = {
  student: () => t("student"),
  grader: () => t("grader"),
  instructor: () => t("instructor"),
  owner: () => t("owner"),
};

let current: Me = { mode: "home", join_open: false };

export const me = (): Me => current;

export const inClass = (): boolean => current.mode === "class";

/** Whether who is signed in sees the work of others. */
export const teaches = (): boolean => (current.person?.role ?? "student") !== "student";

/** A role in the reader's language. */
export function roleWord(role: string): string {
  return ROLES[role]?.() ?? role;
}

/** Asks the server, once at the start and after coming in. A server that does not answer is told by what comes next. */
export async function loadMe(): Promise<void> {
  current = await api.me().catch(() => current);
  if (inClass()) student.signedIn(current.person?.name ?? "");
  dispatchEvent(new Event("triad:student"));
}
