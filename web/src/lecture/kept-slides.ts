// Slides as the browser keeps them.
import { parseView, type SharedView } from "../session/shared-view";

/** More slides than these are not kept. */
export const MOST = 60;
/** Longest notes to a slide, characters. */
export const MOST_NOTES = 2000;
/** Longest picture of a slide, characters of its address: a thumbnail has some thousand. */
const MOST_PICTURE = 40_000;

export interface Slide {
  view: SharedView;
  /** For the presenter alone. */
  notes?: string;
  /** What the stage showed, as the address of a small picture. */
  picture?: string;
}

/** What was kept may be of another version, or damaged; once a slide was its view alone. */
export function parseSlides(text: string | null): Slide[] {
  try {
    const kept: unknown = JSON.parse(text ?? "[]");
    return Array.isArray(kept) ? kept.flatMap((slide) => parseSlide(slide) ?? []).slice(0, MOST) : [];
  } catch {
    return [];
  }
}

function parseSlide(kept: unknown): Slide | undefined {
  const given = kept as { view?: unknown; notes?: unknown; picture?: unknown } | null;
  const view = parseView(given && typeof given === "object" && "view" in given ? given.view : kept);
  if (!view) return undefined;
  const slide: Slide = { view };
  if (typeof given?.notes === "string") slide.notes = given.notes.slice(0, MOST_NOTES);
  if (
    typeof given?.picture === "string" &&
    given.picture.startsWith("data:image/") &&
    given.picture.length <= MOST_PICTURE
  )
    slide.picture = given.picture;
  return slide;
}
