import { h } from "../core/dom";
import type { Page } from "../core/router";

export function notFoundPage(outlet: HTMLElement, params: string[]): Page {
  outlet.append(
    h(
      "div",
      { class: "page narrow" },
      h("h1", null, "There is no such page"),
      h("p", null, "Nothing lives at ", h("code", null, params[0] ?? ""), "."),
      h("p", null, h("a", { href: "/" }, "All lessons"), " · ", h("a", { href: "/scenes" }, "All scenes")),
    ),
  );
  return { title: "Not found" };
}
