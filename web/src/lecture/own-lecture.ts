// The lecture that this tab leads.

/** Where the tab keeps its lecture: it goes on after a reload and on the next lesson, but no other tab leads it. */
const STORED = "triad:room";

/** A lecture as its presenter knows it. */
export interface OwnLecture {
  code: string;
  /** Who has it may show, ask and end. */
  key: string;
}

export function store(lecture: OwnLecture | undefined): void {
  try {
    if (lecture) sessionStorage.setItem(STORED, JSON.stringify(lecture));
    else sessionStorage.removeItem(STORED);
  } catch {
    // Without storage the lecture ends with the page.
  }
}

export function stored(): OwnLecture | undefined {
  try {
    const found = JSON.parse(sessionStorage.getItem(STORED) ?? "null") as OwnLecture | null;
    return found && typeof found.code === "string" && typeof found.key === "string" ? found : undefined;
  } catch {
    return undefined;
  }
}
