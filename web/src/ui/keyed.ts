// Children of a list that are kept while others come and go: one that has the focus keeps it.

/** Gives `root` one child for each key, in this order; those that are there are not touched. */
export function keyed(root: HTMLElement, keys: readonly string[], make: (at: number) => HTMLElement): void {
  const there = new Map<string, HTMLElement>();
  for (const child of [...root.children] as HTMLElement[]) {
    const key = child.dataset.key ?? "";
    if (keys.includes(key)) there.set(key, child);
    else child.remove();
  }
  for (const [at, key] of keys.entries()) {
    let child = there.get(key);
    if (!child) {
      child = make(at);
      child.dataset.key = key;
    }
    if (root.children[at] !== child) root.insertBefore(child, root.children[at] ?? null);
  }
}
