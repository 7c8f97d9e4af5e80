// Prepared states as slides: what a link would carry, kept in this browser for the page, gone through by a clicker's keys.

import { announce, h, setText } from "../core/dom";
import { bind } from "../core/keys";
import { recall, remember } from "../core/prefs";
import { t } from "../core/texts";
import type { Session } from "../session/session";
import { restore } from "../session/share";
import type { SharedView } from "../session/shared-view";
import { MOST, parseSlides } from "./kept-slides";

export class Slides {
  readonly root: HTMLElement;
  private readonly place = h("span", { class: "presenter-count" });
  private readonly undo: () => void;
  private readonly curtain = h("div", { class: "curtain", hidden: true });
  private readonly key = `slides:${location.pathname}` as const;
  private slides: SharedView[];
  /** The slide that was shown last; before the first one. */
  private at = -1;

  /** `seen` is what the page shows now. */
  constructor(
    private readonly session: Session,
    private readonly seen: () => SharedView,
  ) {
    this.slides = parseSlides(recall(this.key));
    const press = (label: string, run: () => void): HTMLElement =>
      h("button", { type: "button", class: "button small", onclick: run }, label);
    this.root = h(
      "div",
      { class: "row wrap tight", role: "group", "aria-label": t("Slides") },
      h("span", null, t("Slides")),
      this.place,
      press(t("Keep this state"), () => this.keep()),
      press(t("Back"), () => void this.go(-1)),
      press(t("Next"), () => void this.go(1)),
      press(t("Forget this slide"), () => this.forget()),
      press(t("Blank"), () => this.blank()),
    );
    this.curtain.addEventListener("click", () => this.blank());
    document.body.append(this.curtain);
    this.undo = bind([
      { keys: ["PageDown"], shown: "PageDown", does: t("Lecture: next slide"), run: () => void this.go(1) },
      { keys: ["PageUp"], shown: "PageUp", does: t("Lecture: slide before"), run: () => void this.go(-1) },
      {
        keys: ["b", "B"],
        shown: "B",
        does: t("Lecture: blank the screen, and back"),
        run: () => this.blank(),
      },
    ]);
    this.paint();
  }

  dispose(): void {
    this.undo();
    this.curtain.remove();
  }

  private keep(): void {
    if (this.slides.length >= MOST) return;
    this.at += 1;
    this.slides.splice(this.at, 0, this.seen());
    this.save();
  }

  private forget(): void {
    if (this.at < 0) return;
    this.slides.splice(this.at, 1);
    this.at = Math.min(this.at, this.slides.length - 1);
    this.save();
  }

  private async go(by: number): Promise<void> {
    const at = Math.max(0, Math.min(this.slides.length - 1, this.at + by));
    const slide = this.slides[at];
    if (!slide) return;
    this.at = at;
    this.paint();
    announce(t("Slide {at} of {slides}.", { at: at + 1, slides: this.slides.length }));
    try {
      await this.session.change(slide.numbers ?? { values: {}, places: {} });
      await restore(this.session, slide);
    } catch {
      announce(t("This slide belongs to another mechanism: its numbers do not fit."));
    }
  }

  private blank(): void {
    this.curtain.hidden = !this.curtain.hidden;
    announce(this.curtain.hidden ? t("The screen is back.") : t("The screen is blank; B brings it back."));
  }

  private save(): void {
    remember(this.key, this.slides.length > 0 ? JSON.stringify(this.slides) : null);
    this.paint();
  }

  private paint(): void {
    const { at, slides } = this;
    setText(
      this.place,
      slides.length === 0
        ? t("none yet")
        : t("{at} of {slides}", { at: at < 0 ? "–" : at + 1, slides: slides.length }),
    );
  }
}
