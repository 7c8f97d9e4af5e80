// A recorded run that plays: the stage's own drawing, with play and pause and a time line. No session is needed.

import type { Camera, Motion } from "../api/types";
import { h, setText } from "../core/dom";
import { seconds } from "../core/format";
import { reducedMotion } from "../core/prefs";
import { t } from "../core/texts";
import type { Drawn } from "../session/events";
import { Recorded } from "../session/recorded";
import { Drawing } from "../stage/drawing";
import { turning } from "../stage/hands";
import { icon } from "../ui/icons";

/** Pause at the end before it begins again, ms. */
const REST_MS = 700;

export interface PlayerOptions {
  /** It plays as soon as it is seen, unless less motion is asked for. */
  plays?: boolean;
  drawn?: Drawn;
  camera?: Camera;
  /** A bar with time line and clock, a button alone, or nothing. */
  controls?: "bar" | "button" | "none";
  /** Without axes and names: a picture for its own sake. */
  plain?: boolean;
  /** It starts here, s. */
  time?: number;
}

export class Player {
  readonly root: HTMLElement;
  readonly drawing: Drawing;
  private readonly run: Recorded;
  private readonly button = h("button", { type: "button", class: "button small player-button" });
  private readonly timeline: HTMLInputElement;
  private readonly clock = h("span", { class: "player-clock" });
  private readonly near: IntersectionObserver;
  private time: number;
  private seen = false;
  private wanted: boolean;
  private gone = false;
  /** When the last picture was drawn, or when the next may be, ms. */
  private drawnAt = 0;
  private ticking = false;

  constructor(motion: Motion, options: PlayerOptions = {}) {
    this.run = new Recorded(motion, options.drawn, options.camera);
    this.drawing = new Drawing(this.run.scene, this.run, reducedMotion, options.plain);
    this.time = Math.min(options.time ?? 0, motion.until);
    this.wanted = (options.plays ?? false) && !reducedMotion();
    turning(this.drawing);
    this.timeline = h("input", {
      type: "range",
      class: "timeline",
      min: "0",
      max: String(motion.until),
      step: "any",
      "aria-label": t("Time"),
    });
    this.button.addEventListener("click", () => this.toggle());
    this.timeline.addEventListener("input", () => this.seek(Number(this.timeline.value)));
    const { controls = "bar" } = options;
    const bar =
      controls === "bar"
        ? h("div", { class: "player-bar" }, this.button, this.timeline, this.clock)
        : h("div", { class: "player-bar is-small", hidden: controls === "none" }, this.button);
    this.root = h(
      "div",
      { class: "player", role: "group", "aria-label": motion.title },
      h("div", { class: "player-stage" }, this.drawing.root),
      bar,
    );
    this.near = new IntersectionObserver((entries) => {
      this.seen = entries.some((entry) => entry.isIntersecting);
      this.go();
    });
    this.near.observe(this.root);
    this.show();
  }

  dispose(): void {
    this.gone = true;
    this.near.disconnect();
    this.drawing.dispose();
  }

  /** Starts or stops it. */
  play(on: boolean): void {
    this.wanted = on;
    if (on && this.time >= this.run.motion.until) this.time = 0;
    this.go();
    this.paint();
  }

  private toggle(): void {
    this.play(!this.wanted);
  }

  private seek(time: number): void {
    this.wanted = false;
    this.time = time;
    this.show();
  }

  private go(): void {
    if (this.ticking || !this.wanted || !this.seen || this.gone || this.run.motion.until <= 0) return;
    this.ticking = true;
    this.drawnAt = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  private tick(now: number): void {
    const { until, speed } = this.run.motion;
    this.ticking = this.wanted && this.seen && !this.gone;
    if (!this.ticking) return;
    if (now >= this.drawnAt) {
      this.time += ((now - this.drawnAt) / 1000) * speed;
      this.drawnAt = now;
      if (this.time >= until) {
        this.time = until;
        this.show();
        // It rests at its end, and begins again.
        this.time = 0;
        this.drawnAt = now + REST_MS;
      } else this.show();
    }
    requestAnimationFrame((next) => this.tick(next));
  }

  private show(): void {
    this.run.moving = this.wanted;
    this.drawing.update(this.run.moment(this.time));
    this.paint();
  }

  private paint(): void {
    const { until } = this.run.motion;
    const label = this.wanted ? t("Pause") : t("Play");
    if (this.button.getAttribute("aria-label") !== label) {
      this.button.replaceChildren(icon(this.wanted ? "pause" : "play"));
      this.button.setAttribute("aria-label", label);
    }
    this.timeline.value = String(this.time);
    this.timeline.style.setProperty("--done", `${until > 0 ? (100 * this.time) / until : 0}%`);
    this.timeline.setAttribute(
      "aria-valuetext",
      t("{time} of {until}", { time: seconds(this.time), until: seconds(until) }),
    );
    setText(this.clock, `${this.time.toFixed(until < 1 ? 3 : 2)} s`);
  }
}
