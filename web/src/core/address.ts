// Where a page of the workbench stands. A server answers at each page's own path; a site of plain files has one file for
// all of them, which the query names, so that it can lie in any folder of any host.

/** This is a site of files without a server: the export writes it into the page. */
export const site: boolean =
  typeof document === "object" && document.documentElement.dataset.site !== undefined;

/** The path below which a server answers that stands at a part of another site, as `/triad`: it writes it into the page. */
export const base: string = typeof document === "object" ? (document.documentElement.dataset.base ?? "") : "";

const NAME = "page";

/** The address of a page in a site: `/lessons/x?y#z` as it is written there. */
export function inSite(path: string): string {
  const url = new URL(path, "page:/");
  // The documentation is pages of its own, in files beside this one.
  if (url.pathname.startsWith("/docs/"))
    return `.${url.pathname}${url.pathname.endsWith("/") ? "index.html" : ""}${url.hash}`;
  const page =
    url.pathname === "/"
      ? ""
      : `${NAME}=${encodeURIComponent(decodeURIComponent(url.pathname)).replaceAll("%2F", "/")}`;
  const search = [page, url.search.slice(1)].filter((part) => part !== "").join("&");
  return `./${search === "" ? "" : `?${search}`}${url.hash}`;
}

/** The path of the page that a query names in a site. */
export const pageIn = (search: string): string => new URLSearchParams(search).get(NAME) ?? "/";

/** The address of a page, for a link. */
export const addressOf = (path: string): string =>
  /^\/(?!\/)/.test(path) ? (site ? inSite(path) : base + path) : path;

/** The path below `base`: what the server names stands there. */
export const withoutBase = (path: string, base: string): string =>
  path === base || path.startsWith(`${base}/`) ? path.slice(base.length) || "/" : path;

/** The path of the page that an address names. */
export const pathOf = (place: { pathname: string; search: string }): string =>
  site ? pageIn(place.search) : withoutBase(place.pathname, base);

/** The address of a file of the site, where there is one; it stands beside the page. */
export const fileOf = (path: string): string => new URL(path, document.baseURI).href;
