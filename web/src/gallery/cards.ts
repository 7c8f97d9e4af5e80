// Built-in mechanisms as cards with pictures that play.
import { api } from "../api/client";
import type { Motion, SceneEntry } from "../api/types";
import { AUTHORED, h } from "../core/dom";
import { MovingPicture } from "../player/moving-picture";
import { runName, titled } from "./groups";

/** Cards of scenes, with pictures where there are some; `kept` are to be disposed of with the page. */
export function cards(
  scenes: SceneEntry[],
  pictures: Record<string, Motion>,
  level: "h2" | "h3",
  kept: { dispose: () => void }[],
): HTMLElement {
  return h("ul", { class: "scene-list" }, ...scenes.map((scene) => card(scene, pictures, level, kept)));
}

function card(
  scene: SceneEntry,
  pictures: Record<string, Motion>,
  level: "h2" | "h3",
  kept: { dispose: () => void }[],
): HTMLElement {
  const name = runName(scene.name);
  const start = pictures[name];
  const item = h("li", { class: "scene-card" });
  if (start) {
    const picture = new MovingPicture(start, () => api.motion("scenes", name), item);
    kept.push(picture);
    item.append(picture.root);
  }
  item.append(
    h(
      level,
      null,
      h("a", { href: `/scenes/${encodeURIComponent(name)}`, lang: AUTHORED }, titled(scene.name)),
    ),
    h("p", { lang: AUTHORED }, scene.summary),
  );
  return item;
}
