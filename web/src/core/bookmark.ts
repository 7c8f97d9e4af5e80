// A lesson and a part of it, as the browser keeps them.
export interface Bookmark {
  title: string;
  href: string;
}

/** What was kept may be of another version, or damaged. */
export function parseBookmark(text: string | null): Bookmark | null {
  try {
    const place = JSON.parse(text ?? "null") as Partial<Bookmark> | null;
    if (typeof place?.title !== "string" || typeof place.href !== "string") return null;
    return /^\/lessons\/[^/#]+(#[\w.-]+)?$/.test(place.href)
      ? { title: place.title, href: place.href }
      : null;
  } catch {
    return null;
  }
}
