// Answers that were typed but not handed in yet: kept in this browser, for each lesson and its numbers.
import type { Lesson } from "../api/types";
import { recall, remember } from "../core/prefs";
import type { Draft, QuestionField } from "./question";

type Key = `draft:${string}`;
type Kept = Pick<QuestionField, "id" | "draft" | "hints">;

export class DraftStore {
  /** What the fields of this page held when they were made, or saved; none until all are: hints that are being opened again must not
   * be forgotten meanwhile. */
  private held: Map<string, string[]> | undefined;
  private readonly key: Key;
  private values: Record<string, string[]>;

  constructor(lesson: Lesson) {
    // Answers belong to the numbers that they are about.
    const nameless: Key = `draft:${lesson.slug}`;
    this.key = lesson.has_variants && lesson.seed ? `${nameless}:${lesson.seed}` : nameless;
    this.values = parse(recall(this.key));
    if (this.key !== nameless) this.takeOver(nameless);
  }

  /** What was typed into a question, and how many of its hints were open. */
  of(question: string): Draft {
    return { draft: this.values[question], hints: this.hintsOf(question) };
  }

  /** All fields are made: from now on they are saved. */
  begin(fields: Kept[]): void {
    this.held = new Map(fields.map((field) => [field.id, field.draft()]));
  }

  save(fields: Kept[]): void {
    if (!this.held) return;
    // Another tab may have kept answers meanwhile: they stay, but for those that were typed here.
    this.values = parse(recall(this.key));
    for (const field of fields) {
      const draft = field.draft();
      if (JSON.stringify(draft) !== JSON.stringify(this.held.get(field.id))) this.values[field.id] = draft;
      this.held.set(field.id, draft);
      const opened = Math.max(field.hints(), this.hintsOf(field.id));
      if (opened > 0) this.values[hintsKey(field.id)] = [String(opened)];
    }
    remember(this.key, JSON.stringify(this.values));
  }

  /** What was typed before a name was given, wherever that was, goes on under the name where that one has nothing yet; once, as the next
   * name is somebody else's. */
  private takeOver(nameless: Key): void {
    const before = parse(recall(nameless));
    const filled = ([, draft]: [string, string[]]): boolean => draft.some((part) => part !== "");
    const own = Object.entries(this.values).filter(filled);
    const left = Object.entries(before).filter(filled);
    if (left.length === 0) return;
    this.values = { ...this.values, ...Object.fromEntries([...left, ...own]) };
    remember(this.key, JSON.stringify(this.values));
    remember(nameless, null);
  }

  private hintsOf(question: string): number {
    return Number(this.values[hintsKey(question)]?.[0] ?? 0);
  }
}

const hintsKey = (question: string): string => `${question}#hints`;

function parse(text: string | null): Record<string, string[]> {
  if (!text) return {};
  try {
    const value: unknown = JSON.parse(text);
    if (typeof value !== "object" || value === null) return {};
    return Object.fromEntries(
      Object.entries(value).filter(
        (entry): entry is [string, string[]] =>
          Array.isArray(entry[1]) && entry[1].every((part) => typeof part === "string"),
      ),
    );
  } catch {
    return {};
  }
}
