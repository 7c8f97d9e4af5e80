// Who uses the page: nobody in particular at home, an account in a class.
import { student } from "../core/prefs";
import { api } from "./client";
import type { Me } from "./types";

let current: Me = { mode: "home", join_open: false };

export const me = (): Me => current;

export const inClass = (): boolean => current.mode === "class";

/** Whether who is signed in sees the work of others. */
export const teaches = (): boolean => (current.person?.role ?? "student") !== "student";

/** Asks the server, once at the start and after coming in. A server that does not answer is told by what comes next. */
export async function loadMe(): Promise<void> {
  current = await api.me().catch(() => current);
  if (inClass()) student.signedIn(current.person?.name ?? "");
  dispatchEvent(new Event("triad:student"));
}
