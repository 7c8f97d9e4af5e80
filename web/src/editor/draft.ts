// The text of a scene as this browser keeps it for all its tabs: what one tab writes in the place of another's is not lost.

import { onRemembered, recall, remember } from "../core/prefs";

export type DraftOf = "own" | { lesson: string };

/** Texts that are kept beside the one that is written. */
const MOST_ASIDE = 5;

export class SceneDraft {
  private readonly key: "scene-draft" | `scene-draft:${string}`;
  private readonly asideKey: "scene-aside" | `scene-aside:${string}`;
  /** What the browser kept when this tab last read or wrote it; null while it has done neither. */
  private known: string | null = null;

  constructor(of: DraftOf) {
    this.key = of === "own" ? "scene-draft" : `scene-draft:${of.lesson}`;
    this.asideKey = of === "own" ? "scene-aside" : `scene-aside:${of.lesson}`;
  }

  /** The text that is kept. From now on this tab goes on with it. */
  read(): string | null {
    this.known = recall(this.key);
    return this.known;
  }

  /** Keeps a text, or none. True where it took the place of one that this tab did not know, which is put aside. */
  keep(text: string | null): boolean {
    const theirs = this.theirs();
    const replaced = theirs !== undefined && theirs !== text;
    if (replaced) this.putAside(theirs);
    remember(this.key, text);
    this.known = text;
    return replaced;
  }

  /** What another tab has written since this one last read or wrote. */
  theirs(): string | undefined {
    const there = recall(this.key);
    return there !== null && there !== this.known ? there : undefined;
  }

  /** Calls back when another tab writes, until the returned function is called. */
  onTheirs(heard: () => void): () => void {
    return onRemembered(this.key, () => {
      if (this.theirs() !== undefined) heard();
    });
  }

  /** Texts that were put aside, the latest last. */
  aside(): string[] {
    try {
      const texts: unknown = JSON.parse(recall(this.asideKey) ?? "[]");
      return Array.isArray(texts) ? texts.filter((text) => typeof text === "string") : [];
    } catch {
      return [];
    }
  }

  putAside(text: string): void {
    this.setAside([...this.aside().filter((one) => one !== text), text]);
  }

  /** The text that was put aside last; the one that is shown takes the place of the oldest, so that each has its turn. */
  back(shown: string): string | undefined {
    const texts = this.aside().filter((one) => one !== shown);
    const last = texts.pop();
    if (last !== undefined) this.setAside([shown, ...texts]);
    return last;
  }

  private setAside(texts: string[]): void {
    remember(this.asideKey, texts.length > 0 ? JSON.stringify(texts.slice(-MOST_ASIDE)) : null);
  }
}

/** Puts a text in the place of one's own scene, which is put aside. */
export const replaceOwn = (text: string): void => void new SceneDraft("own").keep(text);
