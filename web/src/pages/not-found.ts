import { h } from "../core/dom";
import type { Page } from "../core/router";
import { parts, t } from "../core/texts";

export function notFoundPage(outlet: HTMLElement, params: string[]): Page {
  outlet.append(
    h(
      "div",
      { class: "page narrow" },
      h("h1", null, t("There is no such page")),
      h("p", null, ...parts("Nothing lives at {address}.", { address: h("code", null, params[0] ?? "") })),
      h(
        "p",
        null,
        h("a", { href: "/" }, t("All lessons")),
        " · ",
        h("a", { href: "/scenes" }, t("All scenes")),
      ),
    ),
  );
  return { title: t("Not found") };
}
