// What has happened, on the time line: marks that lead to their moments, the newest in words below, and all of it in the inspector.

import { announce, h, setText } from "../core/dom";
import { t } from "../core/texts";
import { endedBy, type Happening, happenings, leftOut } from "../session/happened";
import type { Session } from "../session/session";
import { keyed } from "../ui/keyed";

/** Between two of them that a screen reader is told while the run goes on, ms. */
const CALM = 2000;

export class HappenedMarks {
  /** Below the time line. */
  readonly line: HTMLElement;
  /** On it. */
  readonly marks: HTMLElement;
  private readonly newest = h("button", {
    type: "button",
    class: "happened-newest",
    title: t("Look at this moment"),
    onclick: () => this.go(this.shown.at(-1)),
  });
  private readonly all = h("button", { type: "button", class: "button quiet small" });
  private readonly row = h("span", {
    class: "happened-marks",
    role: "toolbar",
    "aria-label": t("What happened, on the time line"),
    // Arrows go from mark to mark here.
    "data-keys": "",
  });
  /** What a mark stands for, while it is pointed at or has the focus. */
  private readonly told = h("span", { class: "happened-told", "aria-hidden": "true", hidden: true });
  private shown: readonly Happening[] = [];
  private seen = "";
  private saidAt = Number.NEGATIVE_INFINITY;

  /** `openList` shows all of it. */
  constructor(
    private readonly session: Session,
    openList: () => void,
  ) {
    this.all.addEventListener("click", openList);
    this.line = h("div", { class: "happened-line", hidden: true }, this.newest, this.all);
    this.marks = h("span", { class: "happened-marks-box", hidden: true }, this.row, this.told);
    this.row.addEventListener("keydown", (event) => this.move(event));
    this.row.addEventListener("focusout", () => this.tell(undefined));
    this.row.addEventListener("pointerleave", () => this.tell(undefined));
    session.on("shown", () => this.paint());
  }

  private paint(): void {
    const state = this.session.latest;
    if (!state) return;
    const ended = endedBy(state);
    const { duration } = state;
    const now = happenings(state);
    const seen = `${state.id} ${duration} ${ended?.time}`;
    if (now === this.shown && seen === this.seen) return;
    this.seen = seen;
    const before = this.shown;
    this.shown = now;
    const newest = now.at(-1);
    this.line.hidden = this.marks.hidden = newest === undefined;
    if (!newest) this.tell(undefined);
    setText(this.newest, newest?.sentence ?? "");
    this.newest.classList.toggle("is-end", ended !== undefined);
    setText(this.all, t("What happened ({n})", { n: now.length + leftOut(state) }));
    keyed(
      this.row,
      now.map(({ when, words }) => `${duration} ${when} ${words}`),
      (at) => this.mark(now[at] as Happening, duration),
    );
    this.rove();
    if (newest && newest.time > (before.at(-1)?.time ?? Number.NEGATIVE_INFINITY)) this.say(newest);
  }

  /** Says that something has happened; how the run ended is said with its state. */
  private say({ sentence }: Happening): void {
    const now = performance.now();
    if (this.session.latest?.finished || now - this.saidAt < CALM) return;
    this.saidAt = now;
    announce(sentence);
  }

  private mark(happening: Happening, duration: number): HTMLElement {
    const at = duration > 0 ? happening.time / duration : 0;
    return h("button", {
      type: "button",
      class: `happened-tick is-${happening.kind}`,
      style: `--at:${at}`,
      tabindex: "-1",
      "aria-label": happening.sentence,
      onclick: () => this.go(happening),
      onfocus: () => this.tell(happening, at),
      onpointerenter: () => this.tell(happening, at),
    });
  }

  private go(happening: Happening | undefined): void {
    if (happening) this.session.seek(happening.time);
  }

  private tell(happening: Happening | undefined, at = 0): void {
    this.told.hidden = happening === undefined;
    if (!happening) return;
    this.told.style.setProperty("--at", String(at));
    setText(this.told, happening.sentence);
  }

  private get buttons(): HTMLElement[] {
    return [...this.row.children] as HTMLElement[];
  }

  /** One of the marks is met by the tab key: the one that has it, else the newest. */
  private rove(to?: HTMLElement): void {
    const { buttons } = this;
    const stop = to ?? buttons.find((button) => button === document.activeElement) ?? buttons.at(-1);
    for (const button of buttons) button.tabIndex = button === stop ? 0 : -1;
  }

  private move(event: KeyboardEvent): void {
    const { buttons } = this;
    const at = buttons.indexOf(event.target as HTMLElement);
    const moves: Record<string, number> = {
      ArrowRight: at + 1,
      ArrowLeft: at - 1,
      Home: 0,
      End: buttons.length - 1,
    };
    const to = buttons[moves[event.key] ?? -1];
    if (!to || event.shiftKey) return;
    event.preventDefault();
    this.rove(to);
    to.focus();
  }
}
