// The gallery of built-in mechanisms, and the way to a scene of one's own.
import { api } from "../api/client";
import type { SceneEntry } from "../api/types";
import { h } from "../core/dom";
import { recall } from "../core/prefs";
import type { Page } from "../core/router";
import { urdfImport } from "../editor/import";
import { empty, problemNotice, skeleton } from "../ui/notice";

export const OWN_SCENE = "own";

/** A family of scenes takes a number in place of N. */
const FAMILY = /^(.+):N$/;
/** The number with which the link to a family begins. */
const FAMILY_START = "2";

export function scenesPage(outlet: HTMLElement): Page {
  const leaving = new AbortController();
  const list = h("div", { class: "gallery", "aria-busy": "true" }, skeleton(6));
  outlet.append(
    h(
      "div",
      { class: "page" },
      h(
        "header",
        { class: "page-head" },
        h("h1", null, "Scenes"),
        h(
          "p",
          { class: "lead" },
          "Mechanisms without a lesson. Open one, run it, change its text and run it again.",
        ),
        h(
          "p",
          null,
          h(
            "a",
            { class: "button", href: `/scenes/${OWN_SCENE}` },
            recall("scene-draft") ? "Continue your own scene" : "Write your own scene",
          ),
          " ",
          h("a", { href: "/guide", target: "_blank", rel: "noopener" }, "How a scene is written"),
        ),
        urdfImport(`/scenes/${OWN_SCENE}`),
      ),
      list,
    ),
  );

  const load = async (): Promise<void> => {
    try {
      const scenes = await api.scenes(leaving.signal);
      list.removeAttribute("aria-busy");
      list.replaceChildren(
        scenes.length === 0
          ? empty("No built-in scenes", "This server offers none. You can still write your own.")
          : h("ul", { class: "scene-list" }, ...scenes.map(card)),
      );
    } catch (error) {
      if (!leaving.signal.aborted)
        list.replaceChildren(problemNotice(error, [{ label: "Try again", run: () => void load() }]));
    }
  };
  void load();
  return { title: "Scenes", dispose: () => leaving.abort() };
}

function card(scene: SceneEntry): HTMLElement {
  const family = FAMILY.exec(scene.name)?.[1];
  const name = family ? `${family}:${FAMILY_START}` : scene.name;
  return h(
    "li",
    { class: "scene-row" },
    h("h2", null, h("a", { href: `/scenes/${encodeURIComponent(name)}` }, titled(family ?? scene.name))),
    h("p", null, scene.summary),
    h("code", null, scene.name),
  );
}

const titled = (name: string): string => {
  const words = name.replaceAll("-", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
};
