// Where a page of the workbench stands. A server answers at each page's own path; a site of plain files has one file for
// all of them, which the query names, so that it can lie in any folder of any host.

/** This is a site of files without a server: the export writes it into the page. */
export const site: boolean =
  typeof document === "object" && document.documentElement.dataset.site !== undefined;

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
export const addressOf = (path: string): string => (site && /^\/(?!\/)/.test(path) ? inSite(path) : path);

/** The path of the page that an address names. */
export const pathOf = (place: { pathname: string; search: string }): string =>
  site ? pageIn(place.search) : place.pathname;

/** The address of a file of the site, where there is one; it stands beside the page. */
export const fileOf = (path: string): string => new URL(path, document.baseURI).href;
