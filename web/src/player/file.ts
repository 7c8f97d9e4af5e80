// The start of a file that plays by itself: everything that it needs stands in it.

import { h } from "../core/dom";
import { t } from "../core/texts";
import player from "../styles/player.css?inline";
import timeline from "../styles/timeline.css?inline";
import tokens from "../styles/tokens.css?inline";
import type { Played } from "./played";
import { Player } from "./player";

const OWN = `
  body { margin: 0; background: var(--bg); color: var(--ink); font: 1rem/1.5 var(--sans); }
  main { display: grid; grid-template-rows: auto minmax(0, 1fr) auto; gap: .5rem; box-sizing: border-box; height: 100vh; padding: 1rem; }
  h1 { margin: 0; font: 600 1.25rem/1.3 var(--serif); }
  p { margin: 0; font-size: .8125rem; color: var(--ink-2); }
  .drawing { position: absolute; inset: 0; width: 100%; height: 100%; touch-action: pan-y; }
  .button { display: inline-flex; align-items: center; justify-content: center; min-height: 2rem; border: 1px solid var(--line-strong);
    border-radius: var(--round); background: var(--surface); color: var(--ink); cursor: pointer; }
  .icon { width: 1.1rem; height: 1.1rem; fill: none; stroke: currentColor; stroke-width: 1.6; }
  :focus-visible { outline: 2px solid var(--focus); outline-offset: 2px; }
`;

document.documentElement.dataset.theme = matchMedia("(prefers-color-scheme: dark)").matches
  ? "dark"
  : "light";
document.head.append(h("style", null, tokens, timeline, player, OWN));
const text = document.getElementById("motion")?.textContent;
if (text) {
  const { motion, drawn, camera } = JSON.parse(text) as Played;
  document.title = motion.title;
  const shown = new Player(motion, {
    plays: true,
    drawn: drawn ?? { what: "none" },
    camera: camera ?? "corner",
  });
  document.body.append(
    h(
      "main",
      null,
      h("h1", null, motion.title),
      shown.root,
      h(
        "p",
        null,
        t(
          "Recorded with Triad. Drag to look from elsewhere, Ctrl and the wheel to come closer; with the keys: Shift and the arrows, + and −.",
        ),
      ),
    ),
  );
} else document.body.append(t("No motion stands in this file."));
