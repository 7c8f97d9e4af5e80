// Where the mechanism is seen: the sketch at once, the 3-D view when it has arrived.

import type { Scene } from "../api/types";
import { announce, h, setText } from "../core/dom";
import { onTheme, recall, reducedMotion, remember } from "../core/prefs";
import type { Session } from "../session/session";
import { icon } from "../ui/icons";
import { cameras } from "./cameras";
import { forceLayer } from "./force-layer";
import { legend } from "./legend";
import { dragging, pullLayer } from "./pull-layer";
import { sketch } from "./sketch";
import { ViewerUnavailable } from "./unavailable";
import type { ViewerHandle } from "./viewer";

export interface Stage {
  root: HTMLElement;
  /** Changes between sketch and 3-D view; it has its place among the controls. */
  toggle: HTMLElement;
  current: () => "sketch" | "viewer";
  dispose: () => void;
}

export function stage(session: Session, scene: Scene | undefined, picture?: "sketch" | "viewer"): Stage {
  const drawing = sketch(scene, [forceLayer(session), pullLayer(session)], (joint) =>
    session.select(session.joint === joint ? null : joint),
  );
  if (session.controls) dragging(session, drawing.root, drawing.grip, drawing.move);
  const host = h("div", { class: "viewer-host", hidden: true, "data-viewer": true });
  const bar = h("progress", { max: "1", value: "0", "aria-label": "Loading the 3-D view" });
  const said = h("span");
  const loading = h("div", { class: "stage-loading", hidden: true }, said, bar);
  const toggle = h("button", { type: "button", class: "button quiet small" });
  const scale = legend(session);
  const sides = cameras(session);
  const root = h(
    "div",
    { class: "stage" },
    h("div", { class: "sketch-holder" }, drawing.root),
    host,
    scale.root,
    loading,
  );

  let viewer: ViewerHandle | undefined;
  let wanted = picture ? picture === "viewer" : recall("picture") !== "sketch" && !savesData();
  let visible = false;
  let starting = false;
  let failed = false;
  let gone = false;
  let ticking = false;
  let swinging = false;
  let tickedAt = 0;
  let shownAt = 0;
  let frameCost = 0;
  let held = 0;
  const waiting: Uint8Array[] = [];

  /** An analysis shows its result in the sketch, also where the 3-D view is open: that one shows the run. */
  const posed = (): boolean => {
    root.classList.toggle("is-posed", session.pose !== undefined);
    if (!session.pose) return false;
    drawing.update(session.pose(performance.now()));
    return true;
  };
  const swing = (): void => {
    if (gone || !posed()) {
      swinging = false;
      return;
    }
    swinging = true;
    requestAnimationFrame(swing);
  };

  const draw = (): void => {
    if (posed()) {
      if (!swinging && !reducedMotion()) swing();
      return;
    }
    scale.update();
    const time = session.smoothTime;
    const state = session.past.between(time) ?? session.shown;
    if (!state) return;
    if (!viewer || !wanted) drawing.update(state);
    if (ticking && performance.now() - shownAt < rest(frameCost)) return;
    shownAt = performance.now();
    for (const block of waiting.splice(0)) viewer?.send(block);
    viewer?.show(time);
  };
  const tick = (now: number): void => {
    if (ticking) frameCost = Math.max(now - tickedAt, 0.9 * frameCost);
    tickedAt = now;
    ticking = !gone && session.moving;
    draw();
    if (ticking) requestAnimationFrame(tick);
  };
  const paint = (): void => {
    const on = viewer !== undefined && wanted;
    sides.root.hidden = !on || !session.controls;
    host.hidden = !on;
    drawing.root.toggleAttribute("inert", on);
    root.classList.toggle("has-viewer", on);
    loading.hidden = !failed && !(starting && wanted);
    toggle.replaceChildren(icon("cube"), wanted ? "Sketch instead" : "3-D view");
  };

  const start = async (): Promise<void> => {
    if (viewer || starting || !wanted || !visible || gone) return;
    starting = true;
    failed = false;
    setText(said, "Loading the 3-D view…");
    bar.hidden = false;
    paint();
    try {
      const { openViewer } = await import("./viewer");
      host.hidden = false;
      host.classList.add("is-starting");
      const opened = await openViewer(host, {
        progress: (fraction) => {
          bar.value = fraction;
          setText(
            said,
            fraction < 1 ? `Loading the 3-D view, ${Math.round(fraction * 100)} %` : "Starting the 3-D view…",
          );
        },
        selected: (path) => {
          const joint = /^\/?world\/joints\/([^/]+)/.exec(path)?.[1];
          if (joint) session.select(unescaped(joint));
        },
      });
      if (gone) {
        opened.close();
        return;
      }
      viewer = opened;
      session.resubscribe();
    } catch (error) {
      failed = true;
      bar.hidden = true;
      host.replaceChildren();
      wanted = false;
      setText(
        said,
        `${error instanceof ViewerUnavailable ? error.message : "The 3-D view could not be started."} The sketch and the tables show the same run.`,
      );
      said.title = error instanceof Error ? error.message : String(error);
      announce("The 3-D view could not be loaded. The sketch and the tables show the same run.");
    } finally {
      host.classList.remove("is-starting");
      starting = false;
      paint();
    }
  };

  const restart = (): void => {
    if (!viewer) return;
    viewer.close();
    viewer = undefined;
    held = 0;
    host.replaceChildren();
    void start();
  };

  toggle.addEventListener("click", () => {
    wanted = !wanted;
    failed = false;
    remember("picture", wanted ? null : "sketch");
    paint();
    void start();
  });

  const seen = new IntersectionObserver(
    (entries) => {
      visible = entries.some((entry) => entry.isIntersecting);
      void start();
    },
    { rootMargin: "200px" },
  );
  seen.observe(root);

  const undo = [
    session.on("opened", () => {
      waiting.length = 0;
      // A recording that is over stays in the viewer's memory: from time to time it starts afresh, from the cache.
      if (held > MOST_HELD) restart();
      else viewer?.begin();
    }),
    session.on("blocks", (block) => {
      if (!viewer) return;
      held += block.byteLength;
      waiting.push(block);
      if (!ticking) draw();
    }),
    session.on("shown", () => {
      draw();
      if (session.moving && !ticking && !reducedMotion()) requestAnimationFrame(tick);
    }),
    session.on("view", draw),
    session.on("selected", draw),
    // Only at its start does a scene say where the parts of its bodies are.
    session.on("scene", () => {
      const first = session.past.all[0];
      if (!session.view || first?.time !== 0) return;
      drawing.rebuild(session.view.scene as Scene);
      drawing.update(first);
      draw();
    }),
    // The viewer takes its theme when it starts: it is started again, from the browser's cache.
    onTheme(() => restart()),
  ];
  paint();

  return {
    root,
    toggle: h("span", { class: "row tight" }, sides.root, toggle),
    current: () => (wanted ? "viewer" : "sketch"),
    dispose: () => {
      gone = true;
      seen.disconnect();
      sides.dispose();
      for (const step of undo) step();
      viewer?.close();
    },
  };
}

/** Bytes of recordings after which the viewer starts afresh: its memory is bounded, and it has no way to forget one. */
const MOST_HELD = 150e6;

/**
 * How long the viewer is left alone between two pictures, ms. Where a picture is slow to draw (no
 * graphics card, a weak phone) the page's own controls must still answer.
 */
function rest(frameCost: number): number {
  return frameCost > 50 ? Math.min(1500, 3 * frameCost) : 0;
}

/** The viewer writes special signs in paths with a backslash. */
const unescaped = (part: string): string => part.replace(/\\(.)/g, "$1");

/** Somebody who asked the browser to save data gets 11 MB only on request. */
function savesData(): boolean {
  const connection = (navigator as Navigator & { connection?: { saveData?: boolean } }).connection;
  return connection?.saveData === true;
}
