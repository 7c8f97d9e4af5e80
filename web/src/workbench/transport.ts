// Play, pause, step, look back: the clock of the page.

import type { SessionState } from "../api/types";
import { h, setText } from "../core/dom";
import { fixedPlain, seconds, typedIn, unclearComma } from "../core/format";
import { bind } from "../core/keys";
import { t } from "../core/texts";
import { endedBy } from "../session/happened";
import type { Session } from "../session/session";
import { type IconName, icon } from "../ui/icons";
import type { HappenedMarks } from "./happened-marks";

/** Simulated seconds by second of the wall clock. */
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const START_SPEED = 1;
/** Steps by time, s. */
const STRIDES = [0.01, 0.05, 0.1, 0.5, 1];
const START_STRIDE = 0.1;
const CLOCK_DECIMALS = 3;
/** Length of the timeline until the run says how long it is planned to be, s. */
const UNKNOWN_DURATION = 10;

export class Transport {
  readonly root: HTMLElement;
  private readonly stride = h(
    "select",
    { class: "field compact", "aria-label": t("Length of a step by time") },
    ...STRIDES.map((value) =>
      h("option", { value: String(value), selected: value === START_STRIDE }, `${value} s`),
    ),
  );
  private readonly speed = h(
    "select",
    { class: "field compact", "aria-label": t("Speed"), title: t("Speed") },
    ...SPEEDS.map((value) =>
      h("option", { value: String(value), selected: value === START_SPEED }, `${value} ×`),
    ),
  );
  private readonly play = button(
    "play",
    t("Play"),
    t("space"),
    () => void this.session.toggle(),
    "primary play",
  );
  private readonly back = button("back", t("Back to the moment before"), "←", () => this.session.back());
  private readonly live = h(
    "button",
    {
      type: "button",
      class: "button small live",
      hidden: true,
      title: t("Looking back: go to the newest time"),
      onclick: () => this.session.seek(Infinity),
    },
    icon("live"),
    t("To newest"),
  );
  private readonly loop = h(
    "button",
    {
      type: "button",
      class: "button quiet small icon-only",
      "aria-label": t("Loop: show the run again and again"),
      title: t("Loop: show the run again and again (L)"),
      "aria-pressed": "false",
      onclick: () => this.toggleLoop(),
    },
    icon("loop"),
  );
  private readonly timeline: HTMLInputElement;
  /** What is marked, as strokes; the panel that marks it tells it in words. */
  private readonly ticks = h("span", { class: "timeline-marks", "aria-hidden": "true" });
  private ticked = "";
  private readonly clock = h("input", {
    class: "clock",
    type: "text",
    inputmode: "decimal",
    autocomplete: "off",
    value: "0.000",
    "aria-label": t("Run to a time, in seconds"),
    title: t("Type a time and press Enter: the run goes there"),
  });
  private readonly until: HTMLElement;
  private readonly mode = h("span", { class: "clock-mode" });
  private readonly undo: (() => void)[];
  /** What the play button shows. */
  private moving: boolean | undefined;

  /** `more` stands beside the timeline. */
  constructor(
    private readonly session: Session,
    plannedDuration: number | undefined,
    more: HTMLElement,
    private readonly happened: HappenedMarks,
  ) {
    this.timeline = h("input", {
      type: "range",
      class: "timeline",
      min: "0",
      max: String(plannedDuration ?? UNKNOWN_DURATION),
      step: "0.001",
      value: "0",
      "aria-label": t("Time"),
    });
    this.until = h(
      "span",
      { class: "clock-until" },
      plannedDuration ? t("of {duration}", { duration: seconds(plannedDuration, 0) }) : "",
    );
    this.root = this.layout(more);
    this.listen();
    const waits = (): void => {
      this.root.classList.toggle("waits", session.held);
    };
    this.undo = [
      session.on("shown", () => this.paint()),
      session.on("view", () => {
        waits();
        this.paint();
      }),
      this.bindKeys(),
    ];
    waits();
  }

  dispose(): void {
    for (const step of this.undo) step();
  }

  private layout(more: HTMLElement): HTMLElement {
    const { session } = this;
    return h(
      "div",
      { class: "transport", role: "group", "aria-label": t("Run of the simulation") },
      h(
        "div",
        { class: "timeline-row" },
        h("span", { class: "timeline-box" }, this.timeline, this.ticks, this.happened.marks),
        this.loop,
        more,
      ),
      h(
        "div",
        { class: "transport-row" },
        h(
          "div",
          { class: "transport-group" },
          button("reset", t("Reset to the start"), t("backspace"), () => void session.reset()),
          this.back,
          this.play,
          button("step", t("One integrator step"), "→", () => void session.forward()),
        ),
        h(
          "div",
          { class: "transport-group joined", hidden: !session.controls },
          button("skip", t("Step by time"), t("full stop"), () => this.stepTime()),
          this.stride,
        ),
        h(
          "p",
          { class: "clock-box" },
          this.clock,
          " ",
          this.until,
          h("span", { class: "clock-slot" }, this.mode, this.live),
        ),
        h("div", { class: "transport-group speed" }, this.speed),
      ),
      this.happened.line,
    );
  }

  private listen(): void {
    const { session, timeline, clock } = this;
    this.speed.addEventListener("change", () => session.setSpeed(Number(this.speed.value)));
    timeline.addEventListener("input", () => session.seek(Number(timeline.value)));
    clock.addEventListener("focus", () => clock.select());
    clock.addEventListener("blur", () => {
      clock.setCustomValidity("");
      this.paint();
    });
    clock.addEventListener("input", () => clock.setCustomValidity(""));
    clock.addEventListener("keydown", (event) => {
      if (event.key === "Escape") clock.blur();
      if (event.key !== "Enter") return;
      const time = typedIn("s", clock.value);
      const wrong = this.wrongTime(time);
      if (wrong === undefined) {
        clock.blur();
        void session.goTo(time);
        return;
      }
      clock.setCustomValidity(wrong);
      clock.reportValidity();
    });
  }

  /** What is wrong with a typed time. */
  private wrongTime(time: number): string | undefined {
    if (!Number.isFinite(time))
      return unclearComma(this.clock.value) ?? t("Write a time in seconds, such as 1.5");
    const ended = endedBy(this.session.latest);
    if (ended && time > ended.time) return t("{sentence}: write a time before", { sentence: ended.sentence });
    const duration = this.session.latest?.duration ?? Infinity;
    if (time >= 0 && time <= duration) return undefined;
    return t("The run goes from 0 to {duration} s: write a time within", { duration: shortest(duration) });
  }

  private bindKeys(): () => void {
    const { session } = this;
    return bind([
      {
        keys: [" "],
        shown: t("space"),
        does: t("Play or pause"),
        run: (held) => !held && void session.toggle(),
      },
      {
        keys: ["ArrowRight"],
        shown: "→",
        does: t("One integrator step, or the next moment while looking back"),
        // A held key steps as fast as the run answers: steps do not pile up for when it is let go.
        run: (held) => !(held && session.pending) && void session.forward(),
      },
      {
        keys: ["l", "L"],
        shown: "L",
        does: t("Loop: show the run again and again"),
        run: () => this.toggleLoop(),
      },
      {
        keys: ["ArrowLeft"],
        shown: "←",
        does: t("Back to the moment before, without computing"),
        run: () => session.back(),
      },
      {
        keys: ["."],
        shown: ".",
        does: t("Step by time"),
        run: (held) => !(held && session.pending) && this.stepTime(),
      },
      { keys: ["+", "="], shown: "+", does: t("Faster"), run: () => this.changeSpeed(1) },
      { keys: ["-"], shown: "−", does: t("Slower"), run: () => this.changeSpeed(-1) },
      {
        keys: ["Backspace"],
        shown: "Backspace",
        does: t("Back to the start"),
        run: (held) => !held && void session.reset(),
      },
    ]);
  }

  private stepTime(): void {
    void this.session.step({ seconds: Number(this.stride.value) });
  }

  private changeSpeed(by: number): void {
    const at = this.speed.selectedIndex + by;
    this.speed.selectedIndex = Math.max(0, Math.min(SPEEDS.length - 1, at));
    this.session.setSpeed(Number(this.speed.value));
  }

  private toggleLoop(): void {
    this.session.loop = !this.session.loop;
    this.loop.setAttribute("aria-pressed", String(this.session.loop));
  }

  private paint(): void {
    const { session } = this;
    const state = session.latest;
    if (!state) return;
    this.paintTimeline(session.time, state);
    if (document.activeElement !== this.clock) this.clock.value = fixedPlain(session.time, CLOCK_DECIMALS);
    setText(this.until, t("of {duration} s", { duration: shortest(state.duration) }));
    setText(this.mode, session.replaying ? t("replay") : modeOf(state));
    this.live.hidden = !session.reviewing || session.replaying;
    this.mode.hidden = !this.live.hidden;
    this.back.disabled = session.time <= 0;
    if (this.moving !== session.moving) this.paintPlay(session.moving);
  }

  private paintTimeline(time: number, { time: computed, duration }: SessionState): void {
    const { timeline, ticks } = this;
    const percent = (part: number): string => `${duration > 0 ? (100 * part) / duration : 0}%`;
    timeline.max = String(duration);
    this.clock.style.setProperty("--digits", String(fixedPlain(duration, CLOCK_DECIMALS).length));
    timeline.value = String(time);
    timeline.style.setProperty("--done", percent(time));
    timeline.style.setProperty("--computed", percent(computed));
    const ticked = `${duration}|${this.session.marks.map((mark) => mark.time).join("|")}`;
    if (ticked !== this.ticked) {
      this.ticked = ticked;
      ticks.replaceChildren(
        ...this.session.marks.map((mark) =>
          h("i", { style: `--at:${duration > 0 ? mark.time / duration : 0}` }),
        ),
      );
    }
    timeline.setAttribute(
      "aria-valuetext",
      t("{time} of {duration}, computed up to {computed}", {
        time: seconds(time),
        duration: seconds(duration, 0),
        computed: seconds(computed),
      }),
    );
  }

  private paintPlay(moving: boolean): void {
    this.moving = moving;
    const label = moving ? t("Pause") : t("Play");
    this.play.replaceChildren(icon(moving ? "pause" : "play"));
    this.play.setAttribute("aria-label", label);
    this.play.title = `${label} (${t("space")})`;
  }
}

/** A duration to the millisecond, without zeros at its end. */
function shortest(duration: number): number {
  return Number(duration.toFixed(3));
}

function modeOf(state: SessionState): string {
  if (state.error) return t("stopped");
  if (endedBy(state)) return t("ended");
  if (state.finished) return t("complete");
  return state.playing ? t("running") : t("paused");
}

function button(name: IconName, label: string, keys: string, run: () => void, cls = ""): HTMLButtonElement {
  return h(
    "button",
    {
      type: "button",
      class: `button icon-button ${cls}`,
      "aria-label": label,
      title: `${label} (${keys})`,
      onclick: run,
    },
    icon(name),
  );
}
