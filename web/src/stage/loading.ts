// The line over the drawing while the 3-D view loads, and where it says that it cannot.

import { announce, h, setText } from "../core/dom";
import { t } from "../core/texts";
import { ViewerUnavailable } from "./unavailable";

const sketchStays = (): string => t("The drawing and the tables show the same run.");

export class Loading {
  private readonly bar = h("progress", { max: "1", value: "0", "aria-label": t("Loading the 3-D view") });
  private readonly text = h("span");
  private what = t("the viewer");
  readonly root = h("div", { class: "stage-loading", hidden: true }, this.text, this.bar);

  /** `slow`: this computer draws 3-D without a graphics card. */
  begin(slow: boolean): void {
    this.what = slow
      ? t("the viewer (slow on this computer: it has no graphics card to use)")
      : t("the viewer");
    setText(this.text, t("Loading {what}…", { what: this.what }));
    this.bar.hidden = false;
  }

  /** The loaded part of the viewer, from 0 to 1. */
  progress(fraction: number): void {
    // What still arrives after a failure must not hide its reason.
    if (this.bar.hidden) return;
    this.bar.value = fraction;
    setText(
      this.text,
      fraction < 1
        ? t("Loading {what}, {fraction} %", { what: this.what, fraction: Math.round(fraction * 100) })
        : t("Starting {what}…", { what: this.what }),
    );
  }

  fail(error: unknown): void {
    this.bar.hidden = true;
    const reason =
      error instanceof ViewerUnavailable ? error.message : t("The 3-D view could not be started.");
    setText(this.text, `${reason} ${sketchStays()}`);
    this.text.title = error instanceof Error ? error.message : String(error);
    announce(`${t("The 3-D view could not be loaded.")} ${sketchStays()}`);
  }
}
