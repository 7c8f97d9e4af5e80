// The gallery of built-in mechanisms, and the way to a scene of one's own.

import { api } from "../api/client";
import { h } from "../core/dom";
import { recall } from "../core/prefs";
import { navigate, type Page } from "../core/router";
import { t } from "../core/texts";
import { replaceOwn } from "../editor/draft";
import { urdfImport } from "../editor/import";
import { takeIncoming } from "../editor/incoming";
import { cards } from "../gallery/cards";
import { grouped } from "../gallery/groups";
import { empty, problemNotice, skeleton } from "../ui/notice";

export const OWN_SCENE = "own";

export function scenesPage(outlet: HTMLElement): Page {
  const leaving = new AbortController();
  const kept: { dispose: () => void }[] = [];
  const list = h("div", { class: "gallery", "aria-busy": "true" }, skeleton(6));
  outlet.append(
    h(
      "div",
      { class: "page" },
      h(
        "header",
        { class: "page-head" },
        h("h1", null, t("Scenes")),
        h(
          "p",
          { class: "lead" },
          t(
            "Mechanisms without a lesson. Point at one to see it move; open it to run it, change its text and run it again.",
          ),
        ),
        h(
          "p",
          null,
          h(
            "a",
            { class: "button", href: `/scenes/${OWN_SCENE}` },
            recall("scene-draft") ? t("Continue your own scene") : t("Write your own scene"),
          ),
          " ",
          h(
            "a",
            { href: "/docs/scenes.html", target: "_blank", rel: "noopener" },
            t("How a scene is written"),
          ),
        ),
        urdfImport(`/scenes/${OWN_SCENE}`),
      ),
      list,
    ),
  );

  const load = async (): Promise<void> => {
    try {
      const groups = await sceneGroups(leaving.signal, kept);
      list.removeAttribute("aria-busy");
      list.replaceChildren(groups);
    } catch (error) {
      if (!leaving.signal.aborted)
        list.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
  const refuse = takeIncoming({ undoable: false, open: openOwn });
  return {
    title: t("Scenes"),
    dispose: () => {
      refuse();
      leaving.abort();
      for (const one of kept) one.dispose();
    },
  };
}

/** Puts a text in the place of one's own scene, and goes there. */
export function openOwn(text: string): void {
  replaceOwn(text);
  navigate(`/scenes/${OWN_SCENE}`);
}

async function sceneGroups(signal: AbortSignal, kept: { dispose: () => void }[]): Promise<HTMLElement> {
  const [scenes, pictures] = await Promise.all([
    api.scenes(signal),
    // Pictures are a nicety.
    api.pictures(signal).then(
      (all) => all.scenes,
      () => ({}),
    ),
  ]);
  if (scenes.length === 0)
    return empty(t("No built-in scenes"), t("This server offers none. You can still write your own."));
  return h(
    "div",
    { class: "scene-groups" },
    ...grouped(scenes).map(([title, list]) =>
      h("section", null, h("h2", { class: "group-title" }, title), cards(list, pictures, "h3", kept)),
    ),
  );
}
