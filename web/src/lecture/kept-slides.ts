// Slides as the browser keeps them.
import { parseView, type SharedView } from "../session/shared-view";

/** More slides than these are not kept. */
export const MOST = 60;

/** What was kept may be of another version, or damaged. */
export function parseSlides(text: string | null): SharedView[] {
  try {
    const kept: unknown = JSON.parse(text ?? "[]");
    return Array.isArray(kept) ? kept.flatMap((slide) => parseView(slide) ?? []).slice(0, MOST) : [];
  } catch {
    return [];
  }
}
