// Paths to pages. A page fills the outlet and returns what must be undone when it is left.

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
  history.pushState(null, "", path);
  dispatchEvent(new Event("triad:navigate"));
}

export function startRouter(outlet: HTMLElement, routes: Route[], missing: Route["open"]): void {
  let current: Page | undefined;

  let shownPath = "";

  const show = (first: boolean): void => {
    shownPath = location.pathname;
    current?.dispose?.();
    outlet.replaceChildren();
    const path = location.pathname.replace(/\/+$/, "") || "/";
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
        link.pathname === "/" ? path === "/" || path.startsWith("/lessons") : path.startsWith(link.pathname);
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
    if (location.pathname !== shownPath) show(false);
  });
  addEventListener("triad:navigate", () => show(false));
  document.addEventListener("click", (event) => {
    if (event.defaultPrevented || event.button !== 0) return;
    if (event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return;
    const link = (event.target as Element).closest?.("a");
    if (!link || link.target || link.origin !== location.origin || link.hasAttribute("download")) return;
    if (link.pathname.startsWith("/api/")) return;
    if (link.pathname === location.pathname && link.hash) return;
    event.preventDefault();
    if (link.href !== location.href) navigate(link.pathname + link.search + link.hash);
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
