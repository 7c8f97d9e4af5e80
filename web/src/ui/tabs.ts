// Tabs after the ARIA pattern: arrows move, the panel follows at once.
import { h, uid } from "../core/dom";

export interface Tab {
  key: string;
  label: string;
  panel: HTMLElement;
}

export interface Tabs {
  root: HTMLElement;
  current: () => string;
  select: (key: string) => void;
}

export function tabs(label: string, list: Tab[], start: string | null, changed: (key: string) => void): Tabs {
  let current = list.some((tab) => tab.key === start) ? (start as string) : (list[0]?.key ?? "");
  const buttons = new Map<string, HTMLButtonElement>();

  const select = (key: string): void => {
    // Somebody else may look at a tab that is not offered here: what is open stays.
    if (!buttons.has(key)) return;
    current = key;
    for (const tab of list) {
      const on = tab.key === key;
      const button = buttons.get(tab.key);
      button?.setAttribute("aria-selected", String(on));
      if (button) button.tabIndex = on ? 0 : -1;
      tab.panel.hidden = !on;
    }
    changed(key);
  };

  const bar = h("div", { class: "tab-bar", role: "tablist", "aria-label": label });
  for (const [at, tab] of list.entries()) {
    const id = uid("tab");
    const panelId = uid("panel");
    const button = h(
      "button",
      {
        type: "button",
        class: "tab",
        role: "tab",
        id,
        "aria-controls": panelId,
        onclick: () => select(tab.key),
      },
      tab.label,
    );
    button.addEventListener("keydown", (event) => {
      const moves: Record<string, number> = {
        ArrowRight: at + 1,
        ArrowLeft: at - 1,
        Home: 0,
        End: list.length - 1,
      };
      const to = moves[event.key];
      if (to === undefined) return;
      event.preventDefault();
      const next = list[(to + list.length) % list.length];
      if (!next) return;
      select(next.key);
      buttons.get(next.key)?.focus();
    });
    buttons.set(tab.key, button);
    bar.append(button);
    tab.panel.id = panelId;
    tab.panel.setAttribute("role", "tabpanel");
    tab.panel.setAttribute("aria-labelledby", id);
    tab.panel.tabIndex = 0;
    tab.panel.classList.add("tab-panel");
  }
  const root = h("div", { class: "tabs" }, bar, ...list.map((tab) => tab.panel));
  select(current);
  return { root, current: () => current, select };
}
