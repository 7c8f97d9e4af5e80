// Paths to pages. A page fills the outlet and returns what must be undone when it is left.
import { addressOf, pathOf } from "./address";

export interface Page {
  title: string;
  dispose?: () => void;
}

export type Route = {
  pattern: RegExp;
  open: (outlet: HTMLElement, params: string[]) => Page;
};

export function setTitle(title: string): void {
  document.title = title === "Triad" ? title : `${title} · Triad`;
}

export function navigate(path: string): void {
  history.pushState(null, "", addressOf(path));
  dispatchEvent(new Event("triad:navigate"));
}

export function startRouter(outlet: HTMLElement, routes: Route[], missing: Route["open"]): void {
  let current: Page | undefined;

  let shownPath = "";

  const show = (first: boolean): void => {
    shownPath = pathOf(location);
    current?.dispose?.();
    outlet.replaceChildren();
    const path = pathOf(location).replace(/\/+$/, "") || "/";
    let page: Page | undefined;
    for (const route of routes) {
      const match = route.pattern.exec(path);
      if (match) {
        page = route.open(outlet, match.slice(1).map(decodeSafely));
        break;
      }
    }
    current = page ?? missing(outlet, [path]);
    setTitle(current.title);
    for (const link of document.querySelectorAll<HTMLAnchorElement>("#header nav a")) {
      const here =
        pathOf(link) === "/" ? path === "/" || path.startsWith("/lessons") : path.startsWith(pathOf(link));
      if (here) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
    if (!first && !location.hash) {
      scrollTo(0, 0);
      outlet.focus({ preventScroll: true });
    }
  };

  addEventListener("popstate", () => {
    // A step to another place of the same page is the browser's own business.
    if (pathOf(location) !== shownPath) show(false);
  });
  addEventListener("triad:navigate", () => show(false));
  document.addEventListener("click", (event) => {
    if (event.defaultPrevented || event.button !== 0) return;
    if (event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return;
    const link = (event.target as Element).closest?.("a");
    if (!link || link.target || link.origin !== location.origin || link.hasAttribute("download")) return;
    if (/\/(?:api|data|docs)\//.test(link.pathname)) return;
    if (link.pathname === location.pathname && link.search === location.search && link.hash) return;
    event.preventDefault();
    if (link.href === location.href) return;
    history.pushState(null, "", link.href);
    dispatchEvent(new Event("triad:navigate"));
  });
  show(true);
}

function decodeSafely(part: string): string {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}
