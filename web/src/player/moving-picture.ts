// A picture of a mechanism in a list: it stands still, and moves while one points at it or has pressed its button.

import type { Motion } from "../api/types";
import { authored, h } from "../core/dom";
import { reducedMotion } from "../core/prefs";
import { t } from "../core/texts";
import { onTheme } from "../core/theme";
import { icon } from "../ui/icons";
import { Player } from "./player";
import { thumbnail } from "./thumbnail";

/** Whoever passes over a picture faster than this does not mean it, ms. */
const MEANT_MS = 180;

export class MovingPicture {
  readonly root: HTMLElement;
  private readonly still = h("div", { class: "picture-still", "aria-hidden": "true" });
  private readonly button: HTMLButtonElement;
  private readonly silence: () => void;
  private player: Player | undefined;
  private motion: Motion | undefined;
  private timer = 0;
  private on = false;
  /** The button keeps it moving when the pointer leaves. */
  private held = false;

  /** `hovered` is what one points at. */
  constructor(
    private readonly start: Motion,
    private readonly load: () => Promise<Motion>,
    hovered?: HTMLElement,
  ) {
    this.button = h("button", { type: "button", class: "button small icon-only picture-play" });
    this.button.addEventListener("click", () => {
      this.held = !(this.on && this.held);
      void this.turn(this.held);
    });
    this.root = h("div", { class: "picture" }, this.still, this.button);
    const over = hovered ?? this.root;
    over.addEventListener("pointerenter", (event) => {
      if (event.pointerType !== "mouse" || reducedMotion()) return;
      this.timer = window.setTimeout(() => void this.turn(true), MEANT_MS);
    });
    over.addEventListener("pointerleave", () => {
      clearTimeout(this.timer);
      if (!this.held) void this.turn(false);
    });
    this.silence = onTheme(() => this.paint());
    this.paint();
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.silence();
    this.player?.dispose();
  }

  private async turn(on: boolean): Promise<void> {
    this.on = on;
    this.paintButton();
    if (!on) {
      this.player?.dispose();
      this.player?.root.remove();
      this.player = undefined;
      return;
    }
    try {
      this.motion ??= await this.load();
    } catch {
      // Without the motion the picture stands still.
      this.on = false;
      this.held = false;
      this.paintButton();
      return;
    }
    if (!this.on || this.player) return;
    this.player = new Player(this.motion, { controls: "none", plain: true });
    this.root.prepend(this.player.root);
    this.player.play(true);
  }

  private paint(): void {
    authored(this.still, thumbnail(this.start));
    this.paintButton();
  }

  private paintButton(): void {
    const moves = this.on;
    this.button.replaceChildren(icon(moves ? "pause" : "play"));
    this.button.setAttribute("aria-label", `${moves ? t("Stop") : t("Play")}: ${this.start.title}`);
    this.root.classList.toggle("is-moving", moves);
  }
}
