// A lesson and a part of it, as the browser keeps them.
export interface Place {
  title: string;
  href: string;
}

/** What was kept may be of another version, or damaged. */
export function placeIn(text: string | null): Place | null {
  try {
    const place = JSON.parse(text ?? "null") as Partial<Place> | null;
    if (typeof place?.title !== "string" || typeof place.href !== "string") return null;
    return /^\/lessons\/[^/#]+(#[\w.-]+)?$/.test(place.href)
      ? { title: place.title, href: place.href }
      : null;
  } catch {
    return null;
  }
}
