// A recorded run in a frame of somebody else's page: slides, a course in a learning management system. It has no session and
// asks for nothing but the motion; links leave the frame.

import { ApiError, api } from "../api/client";
import { h } from "../core/dom";
import type { Page } from "../core/router";
import { t } from "../core/texts";
import { onTheme } from "../core/theme";
import { Player } from "../player/player";
import { wishOf } from "../player/wish";

export function embedPage(outlet: HTMLElement, params: string[]): Page {
  const kind = params[0] === "lessons" ? "lessons" : "scenes";
  const name = params[1] ?? "";
  const wish = wishOf(location.search);
  const document_ = document.documentElement;
  document_.dataset.embed = "";
  if (wish.theme) document_.dataset.theme = wish.theme;
  const root = h("div", { class: "embed" });
  outlet.append(root);
  let player: Player | undefined;
  const silence = onTheme(() => player?.drawing.recolour());
  api
    .motion(kind, name)
    .then((motion) => {
      player = new Player(motion, wish);
      root.append(
        player.root,
        h(
          "p",
          { class: "embed-foot" },
          h("span", null, motion.title),
          h(
            "a",
            { href: `/${kind}/${encodeURIComponent(name)}`, target: "_blank", rel: "noopener" },
            t("Open in Triad"),
          ),
        ),
      );
    })
    .catch((error: unknown) => {
      const said = error instanceof ApiError ? error.problem : undefined;
      root.append(
        h(
          "p",
          { class: "embed-foot" },
          said?.detail ?? said?.title ?? t("The mechanism could not be loaded."),
        ),
      );
    });
  return {
    title: name,
    dispose: () => {
      silence();
      player?.dispose();
    },
  };
}
