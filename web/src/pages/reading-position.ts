// Where a student stopped reading, so that the first page can lead back there.
import { type Bookmark, parseBookmark } from "../core/bookmark";
import { recall, remember } from "../core/prefs";

/** Parts of a lesson that an address can name. */
const PARTS = ".math.display[id], #steps, fieldset.question[id]";
/** The place is remembered when nothing was scrolled for this long, ms. */
const AFTER_MS = 400;

/** Remembers the part that is being read until the returned function is called. */
export function trackReadingPosition(slug: string, title: string): () => void {
  let timer = 0;
  const note = (): void => {
    const middle = innerHeight / 2;
    const passed = [...document.querySelectorAll<HTMLElement>(PARTS)].filter(
      (part) => part.getBoundingClientRect().top < middle,
    );
    const part = passed.at(-1)?.id;
    remember(
      "place",
      JSON.stringify({ title, href: `/lessons/${encodeURIComponent(slug)}${part ? `#${part}` : ""}` }),
    );
  };
  const soon = (): void => {
    clearTimeout(timer);
    timer = window.setTimeout(note, AFTER_MS);
  };
  addEventListener("scroll", soon, { passive: true });
  soon();
  return () => {
    clearTimeout(timer);
    removeEventListener("scroll", soon);
  };
}

/** Where the student stopped, if anywhere. */
export function lastBookmark(): Bookmark | null {
  return parseBookmark(recall("place"));
}
