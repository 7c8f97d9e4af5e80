// Where the mechanism is seen: the drawing, and in its place the rerun viewer for whoever opens it.

import type { Scene } from "../api/types";
import { authored, h, setText } from "../core/dom";
import { seconds } from "../core/format";
import { recall, reducedMotion, remember } from "../core/prefs";
import { t } from "../core/texts";
import { onPrint, onTheme } from "../core/theme";
import { posed } from "../mechanics/pose";
import type { Session } from "../session/session";
import { icon } from "../ui/icons";
import { cameras } from "./cameras";
import { Drawing } from "./drawing";
import { hands } from "./hands";
import { legend } from "./legend";
import { Loading } from "./loading";
import { toolbar } from "./toolbar";
import { drawsInSoftware } from "./unavailable";
import type { ViewerHandle } from "./viewer";

/** Bytes of recordings after which the viewer starts afresh: its memory is bounded, and it cannot forget one. */
const MAX_VIEWER_BYTES = 150e6;
/** A frame that takes longer than this is slow, ms: the viewer then rests between two pictures. */
const SLOW_FRAME_MS = 50;
/** Longest rest between two pictures, ms. */
const MAX_REST_MS = 1500;
/** How much of the cost of the slowest frame is remembered from one frame to the next. */
const FRAME_COST_DECAY = 0.9;
/** The viewer starts to load when the stage is this close to the visible part of the page. */
const LOAD_WITHIN = "200px";
/** How often the state at the start is looked for where the scene came before it, and between two of these, ms. */
const [START_TRIES, START_MS] = [25, 200];
/** A viewer that is behind the clock by more than this shows another moment, s: the drawing is shown in its place. */
const BEHIND = 0.1;

export class Stage {
  readonly root: HTMLElement;
  /** Changes between drawing and viewer; it has its place among the controls. */
  readonly toggle: HTMLElement;
  private readonly button = h("button", { type: "button", class: "button quiet small" });
  private readonly host = h("div", { class: "viewer-host", hidden: true, "data-viewer": true });
  private readonly behind = h("p", { class: "stage-behind", role: "status", hidden: true });
  /** The picture on paper, for the printed page alone. */
  private readonly printed = h("figure", { class: "stage-printed" });
  private readonly loading = new Loading();
  readonly drawing: Drawing;
  private readonly undo: (() => void)[];

  private viewer: ViewerHandle | undefined;
  /** The viewer is wanted, not the drawing. */
  private wanted: boolean;
  private visible = false;
  private starting = false;
  private failed = false;
  private gone = false;
  /** How often the state at the start was not there yet, and when it is looked for again. */
  private triesForStart = 0;
  private startTimer = 0;
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
    picture?: "drawing" | "viewer",
  ) {
    this.wanted = !session.here && (picture ?? recall("picture")) === "viewer";
    this.drawing = new Drawing(scene, session, reducedMotion, false, () => [tools.root]);
    hands(session, this.drawing);
    const tools = toolbar(session, this.drawing, () => this.root);
    const views = cameras(session);
    const scale = legend(session);
    this.toggle = h("span", { class: "row tight" }, views.root, this.button);
    this.root = h(
      "div",
      { class: "stage" },
      this.drawing.root,
      this.host,
      scale.root,
      tools.root,
      this.behind,
      this.loading.root,
      this.printed,
    );
    this.button.addEventListener("click", () => this.change());
    this.undo = [...this.listen(), scale.dispose, tools.dispose, views.dispose, () => this.drawing.dispose()];
    this.paint();
  }

  current(): "drawing" | "viewer" {
    return this.wanted ? "viewer" : "drawing";
  }

  dispose(): void {
    this.gone = true;
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
    let camera = session.camera;
    return [
      () => near.disconnect(),
      session.on("opened", () => this.begin()),
      session.on("blocks", (block) => this.receive(block)),
      session.on("shown", () => {
        this.draw();
        if (session.moving && !this.ticking && !reducedMotion())
          requestAnimationFrame((now) => this.tick(now));
      }),
      session.on("view", () => {
        if (camera !== session.camera) this.drawing.lookFrom(session.camera);
        camera = session.camera;
        this.draw();
      }),
      session.on("selected", () => this.draw()),
      session.on("scene", () => this.rebuild()),
      onPrint(() => this.print()),
      onTheme(() => {
        this.drawing.recolour();
        // The viewer takes its theme when it starts: it is started again, from the browser's cache.
        this.restart();
      }),
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

  /**
   * Draws a changed scene. Only the state at the start tells where the parts of the bodies are: who comes to a run that goes on
   * learns it from the recorded motion, which may come after the scene.
   */
  private rebuild(): void {
    const { session } = this;
    const first = session.past.all[0];
    const known = first?.time === 0 ? first : session.moment(0);
    // Of a run that a server brought back after its restart nothing is recorded before.
    const start = known ?? (this.triesForStart >= START_TRIES ? session.latest : undefined);
    clearTimeout(this.startTimer);
    if (start) this.triesForStart = 0;
    else {
      this.triesForStart += 1;
      this.startTimer = window.setTimeout(() => !this.gone && this.rebuild(), START_MS);
    }
    if (!session.view || !start) return;
    this.drawing.rebuild(session.view.scene as Scene, start);
    this.draw();
  }

  private change(): void {
    this.wanted = !this.wanted;
    this.failed = false;
    remember("picture", this.wanted ? "viewer" : null);
    this.paint();
    if (this.wanted) void this.start();
    // What nobody looks at is not sent.
    else this.close();
  }

  private paint(): void {
    const on = this.viewer !== undefined && this.wanted;
    this.host.hidden = !on;
    this.root.classList.toggle("has-viewer", on);
    if (!on) this.root.classList.remove("is-behind");
    this.loading.root.hidden = !this.failed && !(this.starting && this.wanted);
    // The viewer shows a recording, which the server makes.
    this.button.hidden = this.session.here;
    this.button.replaceChildren(icon("cube"), this.wanted ? t("Back to the drawing") : t("Open in rerun"));
    this.button.title = this.wanted
      ? ""
      : t("The run in the rerun viewer: plots, the Jacobian, every quantity (11 MB once)");
  }

  private print(): void {
    const state = this.session.shown;
    if (!state) return;
    const words = t("{title} at t = {time}", { title: state.title, time: seconds(state.time) });
    authored(this.printed, this.drawing.svg(words));
    this.printed.append(h("figcaption", null, words));
  }

  private draw(): void {
    const { session } = this;
    if (this.drawPose()) {
      if (!this.posing && !reducedMotion()) this.animatePose();
      return;
    }
    const time = session.smoothTime;
    const state = session.moment(time) ?? session.shown;
    if (!state) return;
    if (!this.viewer || !this.wanted) {
      this.drawing.update(state);
      return;
    }
    const taken = this.viewer.taken();
    const behind = taken === undefined || taken < time - BEHIND;
    this.root.classList.toggle("is-behind", behind);
    this.behind.hidden = !behind || taken === undefined;
    if (behind) {
      this.drawing.update(state);
      if (taken !== undefined)
        setText(
          this.behind,
          t("The viewer catches up: {taken} of {time}. Till then the drawing.", {
            taken: seconds(taken, 1),
            time: seconds(time, 1),
          }),
        );
    }
    if (this.ticking && performance.now() - this.shownAt < restAfter(this.frameCost)) return;
    this.shownAt = performance.now();
    for (const block of this.waiting.splice(0)) this.viewer.send(block);
    this.viewer.show(time);
    // What it is given it takes in over several frames: it is asked again until it has caught up.
    if (behind && !this.ticking) setTimeout(() => !this.gone && !this.ticking && this.draw(), SLOW_FRAME_MS);
  }

  private tick(now: number): void {
    if (this.ticking) this.frameCost = Math.max(now - this.tickedAt, FRAME_COST_DECAY * this.frameCost);
    this.tickedAt = now;
    this.ticking = !this.gone && this.session.moving;
    this.draw();
    if (this.ticking) requestAnimationFrame((next) => this.tick(next));
  }

  /** Draws the result of an analysis, also where the viewer is open: that one shows the run. */
  private drawPose(): boolean {
    const { pose, latest } = this.session;
    this.root.classList.toggle("is-posed", pose !== undefined);
    this.root.dataset.posed = t("result of an analysis");
    if (!pose || !latest) return false;
    this.drawing.update(posed(latest, pose, performance.now(), reducedMotion()));
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
    this.loading.begin(drawsInSoftware());
    this.paint();
    try {
      const opened = await this.open();
      if (this.gone || !this.wanted) {
        opened.close();
        return;
      }
      this.viewer = opened;
      this.session.subscribe(true);
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

  private close(): void {
    if (!this.viewer) return;
    this.end();
    this.session.subscribe(false);
    this.paint();
    this.draw();
  }

  private restart(): void {
    if (!this.viewer) return;
    this.end();
    void this.start();
  }

  private end(): void {
    this.viewer?.close();
    this.viewer = undefined;
    this.viewerBytes = 0;
    this.waiting.length = 0;
    this.host.replaceChildren();
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
