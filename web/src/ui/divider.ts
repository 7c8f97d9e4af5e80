// A line between two parts of the page that is dragged, or moved by the arrow keys. The browser keeps where it stands.

import { h } from "../core/dom";
import { recall, remember } from "../core/prefs";
import { t } from "../core/texts";

/** What lines divide: the picture from what is below it, the picture from what is beside it, the text from the mechanism. */
export type Divided = "picture" | "beside" | "text";

/** Between these a line stands, and this is a step of an arrow key: percent of what is divided. */
const [LEAST, MOST, STEP] = [15, 80, 2];

/** The size of the first part, as the style sheets take it; each part keeps room for its controls. */
const SIZES: Record<Divided, (share: number) => string> = {
  picture: (share) =>
    `clamp(10rem, (100dvh - var(--header)) * ${share / 100}, max(10rem, 100dvh - var(--header) - 13rem))`,
  beside: (share) => `clamp(15rem, ${share}%, 100% - 20rem)`,
  text: (share) => `clamp(20rem, ${share}%, 100% - 24rem)`,
};

function place(divided: Divided, share: number | undefined): void {
  const { style } = document.documentElement;
  if (share === undefined) style.removeProperty(`--divide-${divided}`);
  else style.setProperty(`--divide-${divided}`, SIZES[divided](share));
}

/** Puts all lines where they stood last, before anything is laid out. */
export function restoreDividers(): void {
  for (const divided of Object.keys(SIZES) as Divided[]) {
    const share = Number(recall(`divider:${divided}`) ?? Number.NaN);
    if (share >= LEAST && share <= MOST) place(divided, share);
  }
}

export interface DividerOptions {
  label: string;
  /** What is divided at present: windows of other sizes have other layouts. */
  divided: () => Divided;
  /** The part before the line. */
  first: HTMLElement;
  /** The beginning and the size of what is divided, px. */
  whole: () => { start: number; size: number };
}

export class Divider {
  readonly root: HTMLElement;
  private readonly watch = new ResizeObserver(() => this.tell());
  private share = 0;

  constructor(private readonly options: DividerOptions) {
    const root = h("div", {
      class: "divider",
      role: "separator",
      tabindex: "0",
      "data-keys": "own",
      "aria-label": options.label,
      "aria-valuemin": LEAST,
      "aria-valuemax": MOST,
      title: t("Drag, or use the arrow keys. A double-click puts it back."),
    });
    this.root = root;
    root.addEventListener("keydown", (event) => this.press(event));
    root.addEventListener("dblclick", () => this.reset());
    root.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      event.preventDefault();
      root.focus({ preventScroll: true });
      root.setPointerCapture(event.pointerId);
    });
    root.addEventListener("pointermove", (event) => {
      if (root.hasPointerCapture(event.pointerId)) this.move(this.at(event));
    });
    root.addEventListener("lostpointercapture", () => this.keep());
    this.watch.observe(options.first);
    this.tell();
  }

  dispose(): void {
    this.watch.disconnect();
  }

  private get upright(): boolean {
    return this.options.divided() !== "picture";
  }

  /** Tells where the line stands. */
  tell(): void {
    const { root, options } = this;
    const box = options.first.getBoundingClientRect();
    const { size } = options.whole();
    if (size === 0) return;
    this.share = (100 * (this.upright ? box.width : box.height)) / size;
    root.setAttribute("aria-orientation", this.upright ? "vertical" : "horizontal");
    root.setAttribute("aria-valuenow", String(Math.round(clamped(this.share))));
  }

  private at({ clientX, clientY }: PointerEvent): number {
    const { start, size } = this.options.whole();
    return (100 * ((this.upright ? clientX : clientY) - start)) / size;
  }

  private move(share: number): void {
    place(this.options.divided(), clamped(share));
    this.tell();
  }

  private keep(): void {
    remember(`divider:${this.options.divided()}`, String(Math.round(10 * clamped(this.share)) / 10));
  }

  private reset(): void {
    place(this.options.divided(), undefined);
    remember(`divider:${this.options.divided()}`, null);
    this.tell();
  }

  private press(event: KeyboardEvent): void {
    const arrows: Record<string, number> = this.upright
      ? { ArrowLeft: -STEP, ArrowRight: STEP }
      : { ArrowUp: -STEP, ArrowDown: STEP };
    const by = arrows[event.key];
    const ends: Record<string, number> = { Home: LEAST, End: MOST };
    const to = by === undefined ? ends[event.key] : this.share + by;
    if (to === undefined && event.key !== "Enter") return;
    event.preventDefault();
    if (to === undefined) {
      this.reset();
      return;
    }
    this.move(to);
    this.keep();
  }
}

const clamped = (share: number): number => Math.max(LEAST, Math.min(MOST, share));
