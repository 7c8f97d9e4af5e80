// The view of a run that this tab keeps while its page is loaded anew, as when the language is changed: numbers, time, panel.

import type { SessionSource } from "../api/client";
import { isNone, none } from "../api/numbers";
import { t } from "../core/texts";
import { banner } from "../ui/notice";
import type { Session } from "./session";
import { parseView, type SharedView } from "./shared-view";

const STORED = "triad:view";

export interface KeptView {
  view: SharedView;
  /** The run was changed on its way, and does not come there again: it stands at its start. */
  altered: boolean;
}

/** The next run may be one that the page showed before it was loaded anew. */
let first = true;

/** Keeps what is shown of a run; a run that was changed on its way only with its numbers. */
export function keepView(source: SessionSource, view: SharedView, altered: boolean): void {
  const kept = { source: JSON.stringify(source), view: altered ? { ...view, time: 0 } : view, altered };
  try {
    sessionStorage.setItem(STORED, JSON.stringify(kept));
  } catch {
    // Without storage the run begins anew.
  }
}

/** What the page showed of this run before it was loaded anew: for its first run, and once. */
export function keptView(source: SessionSource): KeptView | undefined {
  if (!first) return undefined;
  first = false;
  try {
    const text = sessionStorage.getItem(STORED);
    sessionStorage.removeItem(STORED);
    const kept = JSON.parse(text ?? "null") as { source?: unknown; view?: unknown; altered?: unknown } | null;
    if (kept?.source !== JSON.stringify(source) || !loadedAnew()) return undefined;
    const view = parseView(kept.view);
    return view && { view, altered: kept.altered === true };
  } catch {
    return undefined;
  }
}

/** The same page came again, not by a link or an address, which say themselves what they show. */
function loadedAnew(): boolean {
  const [entry] = performance.getEntriesByType("navigation") as PerformanceNavigationTiming[];
  return entry?.type === "reload" || entry?.type === "back_forward";
}

/** Says what is as before, and offers the way to the author's run. */
export function tellKept(session: Session, { view, altered }: KeptView): void {
  const changed = !isNone(view.numbers ?? none());
  const said = altered
    ? t("The page was loaded anew. The run had been changed on its way: it stands at its start again.")
    : changed || (view.time ?? 0) > 0
      ? t("The page was loaded anew: numbers and time are those from before.")
      : undefined;
  if (said === undefined) return;
  const fine = { label: t("Fine"), run: () => banner(null) };
  const anew = {
    label: t("Begin anew"),
    run: () => {
      banner(null);
      void session.beginAnew();
    },
  };
  if (altered && !changed) banner(said, fine);
  else banner(said, anew, fine);
}
