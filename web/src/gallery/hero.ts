// The mechanism on the first page: a recorded run that plays; a session begins when somebody opens it.

import { api } from "../api/client";
import { h } from "../core/dom";
import { parts, t } from "../core/texts";
import { onTheme } from "../core/theme";
import { Player } from "../player/player";

/** A crank that turns evenly, and a rocker in another plane: a loop in space that comes round to where it began. */
const SCENE = "rssr";

export function heroPicture(signal: AbortSignal): { root: HTMLElement; dispose: () => void } {
  const stage = h("div", { class: "hero-stage" });
  const root = h(
    "figure",
    { class: "hero-figure" },
    stage,
    h(
      "figcaption",
      null,
      ...parts("A crank drives a rocker in space. {link}: its numbers, its forces, its Jacobian.", {
        link: h("a", { href: `/scenes/${SCENE}` }, t("Take it in hand")),
      }),
    ),
  );
  let player: Player | undefined;
  const silence = onTheme(() => player?.drawing.recolour());
  api
    .motion("scenes", SCENE, signal)
    .then((motion) => {
      player = new Player(motion, { plays: true, controls: "button", plain: true });
      stage.replaceChildren(player.root);
    })
    // The page does without its picture.
    .catch(() => root.remove());
  return {
    root,
    dispose: () => {
      silence();
      player?.dispose();
    },
  };
}
