// Where the mechanism is seen: the sketch at once, the 3-D view when it has arrived.

import type { Scene } from "../api/types";
import { h } from "../core/dom";
import { recall, reducedMotion, remember } from "../core/prefs";
import { onTheme } from "../core/theme";
import type { Session } from "../session/session";
import { icon } from "../ui/icons";
import { cameras } from "./cameras";
import { forceLayer } from "./force-layer";
import { legend } from "./legend";
import { Loading } from "./loading";
import { dragging, pullLayer } from "./pull-layer";
import { Sketch } from "./sketch";
import type { ViewerHandle } from "./viewer";

/** Bytes of recordings after which the viewer starts afresh: its memory is bounded, and it cannot forget one. */
const MAX_VIEWER_BYTES = 150e6;
/** A frame that takes longer than this is slow, ms: the viewer then rests between two pictures. */
const SLOW_FRAME_MS = 50;
/** Longest rest between two pictures, ms. */
const MAX_REST_MS = 1500;
/** How much of the cost of the slowest frame is remembered from one frame to the next. */
const FRAME_COST_DECAY = 0.9;
/** The 3-D view starts to load when the stage is this close to the visible part of the page. */
const LOAD_WITHIN = "200px";

export class Stage {
  readonly root: HTMLElement;
  /** Changes between sketch and 3-D view; it has its place among the controls. */
  readonly toggle: HTMLElement;
  private readonly button = h("button", { type: "button", class: "button quiet small" });
  private readonly host = h("div", { class: "viewer-host", hidden: true, "data-viewer": true });
  private readonly loading = new Loading();
  private readonly sketch: Sketch;
  private readonly legend: ReturnType<typeof legend>;
  private readonly cameras: ReturnType<typeof cameras>;
  private readonly undo: (() => void)[];

  private viewer: ViewerHandle | undefined;
  /** The 3-D view is wanted, not the sketch. */
  private wanted: boolean;
  private visible = false;
  private starting = false;
  private failed = false;
  private gone = false;
  /** The picture is drawn anew in every frame. */
  private ticking = false;
  /** The result of an analysis is drawn anew in every frame. */
  private posing = false;
  private tickedAt = 0;
  private shownAt = 0;
  /** Time that a frame takes at present, ms. */
  private frameCost = 0;
  /** Bytes of recordings that the viewer has been given. */
  private viewerBytes = 0;
  /** Blocks of the recording that the viewer has not been given yet. */
  private readonly waiting: Uint8Array[] = [];

  constructor(
    private readonly session: Session,
    scene: Scene | undefined,
    picture?: "sketch" | "viewer",
  ) {
    this.wanted = picture ? picture === "viewer" : recall("picture") !== "sketch" && !savesData();
    this.sketch = new Sketch(scene, [forceLayer(session), pullLayer(session)], (joint) =>
      session.select(session.joint === joint ? null : joint),
    );
    if (session.controls) dragging(session, this.sketch);
    this.legend = legend(session);
    this.cameras = cameras(session);
    this.toggle = h("span", { class: "row tight" }, this.cameras.root, this.button);
    this.root = h(
      "div",
      { class: "stage" },
      h("div", { class: "sketch-holder" }, this.sketch.root),
      this.host,
      this.legend.root,
      this.loading.root,
    );
    this.button.addEventListener("click", () => this.change());
    this.undo = this.listen();
    this.paint();
  }

  current(): "sketch" | "viewer" {
    return this.wanted ? "viewer" : "sketch";
  }

  dispose(): void {
    this.gone = true;
    this.cameras.dispose();
    for (const step of this.undo) step();
    this.viewer?.close();
  }

  private listen(): (() => void)[] {
    const { session } = this;
    const near = new IntersectionObserver(
      (entries) => {
        this.visible = entries.some((entry) => entry.isIntersecting);
        void this.start();
      },
      { rootMargin: LOAD_WITHIN },
    );
    near.observe(this.root);
    return [
      () => near.disconnect(),
      session.on("opened", () => this.begin()),
      session.on("blocks", (block) => this.receive(block)),
      session.on("shown", () => {
        this.draw();
        if (session.moving && !this.ticking && !reducedMotion())
          requestAnimationFrame((now) => this.tick(now));
      }),
      session.on("view", () => this.draw()),
      session.on("selected", () => this.draw()),
      session.on("scene", () => this.rebuild()),
      // The viewer takes its theme when it starts: it is started again, from the browser's cache.
      onTheme(() => this.restart()),
    ];
  }

  /** A recording follows from its beginning. */
  private begin(): void {
    this.waiting.length = 0;
    // A recording that is over stays in the viewer's memory: from time to time it starts afresh, from the cache.
    if (this.viewerBytes > MAX_VIEWER_BYTES) this.restart();
    else this.viewer?.begin();
  }

  private receive(block: Uint8Array): void {
    if (!this.viewer) return;
    this.viewerBytes += block.byteLength;
    this.waiting.push(block);
    if (!this.ticking) this.draw();
  }

  /** Draws a changed scene. Only the state at the start tells where the parts of the bodies are. */
  private rebuild(): void {
    const first = this.session.past.all[0];
    if (!this.session.view || first?.time !== 0) return;
    this.sketch.rebuild(this.session.view.scene as Scene);
    this.sketch.update(first);
    this.draw();
  }

  private change(): void {
    this.wanted = !this.wanted;
    this.failed = false;
    remember("picture", this.wanted ? null : "sketch");
    this.paint();
    void this.start();
  }

  private paint(): void {
    const on = this.viewer !== undefined && this.wanted;
    this.cameras.root.hidden = !on || !this.session.controls;
    this.host.hidden = !on;
    this.sketch.root.toggleAttribute("inert", on);
    this.root.classList.toggle("has-viewer", on);
    this.loading.root.hidden = !this.failed && !(this.starting && this.wanted);
    this.button.replaceChildren(icon("cube"), this.wanted ? "Sketch instead" : "3-D view");
  }

  private draw(): void {
    const { session } = this;
    if (this.drawPose()) {
      if (!this.posing && !reducedMotion()) this.animatePose();
      return;
    }
    this.legend.update();
    const time = session.smoothTime;
    const state = session.past.between(time) ?? session.shown;
    if (!state) return;
    if (!this.viewer || !this.wanted) this.sketch.update(state);
    if (this.ticking && performance.now() - this.shownAt < restAfter(this.frameCost)) return;
    this.shownAt = performance.now();
    for (const block of this.waiting.splice(0)) this.viewer?.send(block);
    this.viewer?.show(time);
  }

  private tick(now: number): void {
    if (this.ticking) this.frameCost = Math.max(now - this.tickedAt, FRAME_COST_DECAY * this.frameCost);
    this.tickedAt = now;
    this.ticking = !this.gone && this.session.moving;
    this.draw();
    if (this.ticking) requestAnimationFrame((next) => this.tick(next));
  }

  /** Draws the result of an analysis in the sketch, also where the 3-D view is open: that one shows the run. */
  private drawPose(): boolean {
    const { pose } = this.session;
    this.root.classList.toggle("is-posed", pose !== undefined);
    if (!pose) return false;
    this.sketch.update(pose(performance.now()));
    return true;
  }

  private animatePose(): void {
    this.posing = !this.gone && this.drawPose();
    if (this.posing) requestAnimationFrame(() => this.animatePose());
  }

  private async start(): Promise<void> {
    if (this.viewer || this.starting || !this.wanted || !this.visible || this.gone) return;
    this.starting = true;
    this.failed = false;
    this.loading.begin();
    this.paint();
    try {
      const opened = await this.open();
      if (this.gone) {
        opened.close();
        return;
      }
      this.viewer = opened;
      this.session.resubscribe();
    } catch (error) {
      this.failed = true;
      this.wanted = false;
      this.host.replaceChildren();
      this.loading.fail(error);
    } finally {
      this.host.classList.remove("is-starting");
      this.starting = false;
      this.paint();
    }
  }

  private async open(): Promise<ViewerHandle> {
    const { openViewer } = await import("./viewer");
    this.host.hidden = false;
    this.host.classList.add("is-starting");
    return openViewer(this.host, {
      progress: (fraction) => this.loading.progress(fraction),
      selected: (path) => {
        const joint = /^\/?world\/joints\/([^/]+)/.exec(path)?.[1];
        if (joint) this.session.select(unescaped(joint));
      },
    });
  }

  private restart(): void {
    if (!this.viewer) return;
    this.viewer.close();
    this.viewer = undefined;
    this.viewerBytes = 0;
    this.host.replaceChildren();
    void this.start();
  }
}

/**
 * How long the viewer rests between two pictures, ms. Where a picture is slow to draw (no
 * graphics card, a weak phone) the page's own controls must still answer.
 */
function restAfter(frameCost: number): number {
  return frameCost > SLOW_FRAME_MS ? Math.min(MAX_REST_MS, 3 * frameCost) : 0;
}

/** The viewer writes special characters in paths with a backslash. */
const unescaped = (part: string): string => part.replace(/\\(.)/g, "$1");

/** A browser that is set to save data gets the 11 MB of the viewer only on request. */
function savesData(): boolean {
  const connection = (navigator as Navigator & { connection?: { saveData?: boolean } }).connection;
  return connection?.saveData === true;
}
