// Prepared states as slides: what a link would carry, kept in this browser for the page, gone through by a clicker's keys.

import { announce, h, setText } from "../core/dom";
import { bind } from "../core/keys";
import { recall, remember } from "../core/prefs";
import { t } from "../core/texts";
import type { Session } from "../session/session";
import { restore } from "../session/share";
import type { SharedView } from "../session/shared-view";
import { MOST, MOST_NOTES, parseSlides, type Slide } from "./kept-slides";

export interface SlidesOptions {
  session: Session;
  /** What the page shows now, and a small picture of it. */
  seen: () => SharedView;
  picture: () => string | undefined;
  /** The screen is to be blank, or no longer. */
  blank: (on: boolean) => void;
}

export class Slides {
  readonly root: HTMLElement;
  /** Notes to the slide and what comes next, for the presenter alone. */
  readonly notes: HTMLElement;
  blanked = false;
  private readonly place = h("span", { class: "presenter-count" });
  private readonly text = h("textarea", {
    class: "field",
    rows: "4",
    maxlength: String(MOST_NOTES),
    "aria-label": t("Notes to this slide"),
  });
  private readonly next = h("div", { class: "desk-next" });
  private readonly undo: () => void;
  private readonly key = `slides:${location.pathname}` as const;
  private slides: Slide[];
  /** The slide that was shown last; before the first one. */
  private at = -1;

  constructor(private readonly options: SlidesOptions) {
    this.slides = parseSlides(recall(this.key));
    const press = (label: string, run: () => void): HTMLElement =>
      h("button", { type: "button", class: "button small", onclick: run }, label);
    this.root = h(
      "div",
      { class: "row wrap tight", role: "group", "aria-label": t("Slides") },
      h("span", null, t("Slides")),
      this.place,
      press(t("Keep this state"), () => this.keep()),
      press(t("Back"), () => this.step(-1)),
      press(t("Next"), () => this.step(1)),
      press(t("Forget this slide"), () => this.forget()),
      press(t("Blank"), () => this.blank()),
    );
    this.notes = h(
      "section",
      { class: "desk-part" },
      h("h2", null, t("Notes to this slide")),
      this.text,
      h("h2", null, t("Next slide")),
      this.next,
    );
    this.text.addEventListener("input", () => {
      const slide = this.slides[this.at];
      if (!slide) return;
      slide.notes = this.text.value;
      this.store();
    });
    this.undo = bind([
      { keys: ["PageDown"], shown: "PageDown", does: t("Lecture: next slide"), run: () => this.step(1) },
      { keys: ["PageUp"], shown: "PageUp", does: t("Lecture: slide before"), run: () => this.step(-1) },
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
  }

  /** The next slide, or the one before. */
  step(by: number): void {
    void this.go(by);
  }

  blank(): void {
    this.blanked = !this.blanked;
    this.options.blank(this.blanked);
    announce(this.blanked ? t("The screen is blank; B brings it back.") : t("The screen is back."));
  }

  private keep(): void {
    if (this.slides.length >= MOST) return;
    this.at += 1;
    const picture = this.options.picture();
    this.slides.splice(this.at, 0, { view: this.options.seen(), ...(picture ? { picture } : {}) });
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
    const { session } = this.options;
    try {
      await session.change(slide.view.numbers ?? { values: {}, places: {} });
      await restore(session, slide.view);
    } catch {
      announce(t("This slide belongs to another mechanism: its numbers do not fit."));
    }
  }

  private save(): void {
    this.store();
    this.paint();
  }

  private store(): void {
    remember(this.key, this.slides.length > 0 ? JSON.stringify(this.slides) : null);
  }

  private paint(): void {
    const { at, slides } = this;
    setText(
      this.place,
      slides.length === 0
        ? t("none yet")
        : t("{at} of {slides}", { at: at < 0 ? "–" : at + 1, slides: slides.length }),
    );
    this.text.disabled = at < 0;
    this.text.value = slides[at]?.notes ?? "";
    this.text.placeholder = at < 0 ? t("Keep this state as a slide; then it can have notes.") : "";
    const next = slides[at + 1];
    this.next.replaceChildren(
      ...(next
        ? [
            next.picture ? h("img", { src: next.picture, alt: "" }) : "",
            h(
              "p",
              null,
              next.notes?.split("\n")[0] || t("at {time} s", { time: (next.view.time ?? 0).toFixed(2) }),
            ),
          ]
        : [h("p", null, t("This is the last one."))]),
    );
  }
}
