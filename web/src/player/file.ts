// The start of a file that plays by itself: everything that it needs stands in it.

import { h } from "../core/dom";
import { t } from "../core/texts";
import type { Taped } from "../lecture/tape";
import histogram from "../styles/histogram.css?inline";
import player from "../styles/player.css?inline";
import timeline from "../styles/timeline.css?inline";
import tokens from "../styles/tokens.css?inline";
import { LecturePlayer } from "./lecture-player";
import type { Played, PlayedRun } from "./played";
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
document.head.append(h("style", null, tokens, timeline, player, histogram, OWN));
const text = document.getElementById("motion")?.textContent;
if (text) {
  const played = JSON.parse(text) as Played;
  document.body.append("lecture" in played ? lecture(played.lecture) : run(played));
} else document.body.append(t("No motion stands in this file."));

function run({ motion, drawn, camera }: PlayedRun): HTMLElement {
  document.title = motion.title;
  const shown = new Player(motion, {
    plays: true,
    drawn: drawn ?? { what: "none" },
    camera: camera ?? "corner",
  });
  return h("main", null, h("h1", null, motion.title), shown.root, about());
}

function lecture(taped: Taped): HTMLElement {
  document.title = taped.title;
  const shown = new LecturePlayer(taped);
  return h("main", null, h("h1", null, `${taped.title}, ${taped.began.slice(0, 10)}`), shown.root, about());
}

function about(): HTMLElement {
  return h(
    "p",
    null,
    t(
      "Recorded with Triad. Drag to look from elsewhere, Ctrl and the wheel to come closer; with the keys: Shift and the arrows, + and −.",
    ),
  );
}
