// What moves on the first page, fetched when its text can be read: the mechanism at the top, pictures of lessons, ten scenes.

import { api } from "../api/client";
import type { Motion } from "../api/types";
import { authored, h } from "../core/dom";
import { t } from "../core/texts";
import { onTheme } from "../core/theme";
import { thumbnail } from "../player/thumbnail";
import { cards } from "./cards";
import { chosen } from "./groups";
import { heroPicture } from "./hero";

export interface HomePictures {
  /** Draws the pictures of the lessons into the places that are marked with their slugs. */
  lessons: () => void;
  dispose: () => void;
}

export async function homePictures(
  hero: HTMLElement,
  list: HTMLElement,
  gallery: HTMLElement,
  signal: AbortSignal,
): Promise<HomePictures> {
  const kept: { dispose: () => void }[] = [];
  const top = heroPicture(signal);
  hero.replaceChildren(top.root);
  kept.push(top);
  let pictures: Record<string, Motion> = {};
  const lessons = (): void => {
    for (const place of list.querySelectorAll<HTMLElement>("[data-picture]")) {
      const motion = pictures[place.dataset.picture ?? ""];
      if (motion) authored(place, thumbnail(motion));
    }
  };
  const dispose = (): void => {
    for (const one of kept) one.dispose();
  };
  kept.push({ dispose: onTheme(lessons) });
  try {
    const [all, scenes] = await Promise.all([api.pictures(signal), api.scenes(signal)]);
    pictures = all.lessons;
    lessons();
    gallery.append(
      h(
        "div",
        { class: "section-head" },
        h("h2", null, t("Ten mechanisms to watch")),
        h("p", null, h("a", { href: "/scenes" }, t("All scenes, and your own"))),
      ),
      cards(chosen(scenes), all.scenes, "h3", kept),
    );
  } catch {
    // The page does without its pictures.
  }
  return { lessons, dispose };
}
