// What the text beside the mechanism may ask of it.

import type { Session } from "../session/session";

/** What a step of a lesson asks for. */
export type Action =
  | { do: "play" | "step" | "reset" | "numbers" }
  | { do: "run"; time: number }
  | { do: "panel"; panel: string };

/** Does it, where the reader sees it. */
export function acting(
  session: Session,
  root: HTMLElement,
  selectPanel: (key: string) => void,
): (action: Action) => void {
  return (action) => {
    root.scrollIntoView({ block: "nearest" });
    if (action.do === "play") {
      if (!session.moving) void session.play();
    } else if (action.do === "step") void session.forward();
    else if (action.do === "reset") void session.reset();
    else if (action.do === "run") void session.goTo(action.time);
    // What the run shows is hidden while it waits.
    else if (session.asked()) return;
    else if (action.do === "panel") showPanel(root, selectPanel, action.panel);
    else {
      showPanel(root, selectPanel, "parameters");
      const numbers = root.querySelector<HTMLDetailsElement>("#all-numbers");
      if (numbers) numbers.open = true;
      numbers?.querySelector("summary")?.focus();
    }
  };
}

/** Opens a panel and goes there: who reads with their ears hears its name. */
function showPanel(root: HTMLElement, selectPanel: (key: string) => void, panel: string): void {
  selectPanel(panel);
  root.querySelector<HTMLElement>('[role="tab"][aria-selected="true"]')?.focus();
}
