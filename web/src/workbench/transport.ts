// Play, pause, step, look back: the clock of the page.
import { h, setText } from "../core/dom";
import { fixedPlain, seconds } from "../core/format";
import { bind } from "../core/keys";
import type { Session } from "../session/session";
import { type IconName, icon } from "../ui/icons";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const STRIDES = [0.01, 0.05, 0.1, 0.5, 1];

export function transport(
  session: Session,
  plannedDuration: number | undefined,
  more: HTMLElement,
): { root: HTMLElement; dispose: () => void } {
  const button = (
    name: IconName,
    label: string,
    keys: string,
    run: () => void,
    cls = "",
  ): HTMLButtonElement =>
    h(
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

  const stride = h(
    "select",
    { class: "field compact", "aria-label": "Length of a step by time" },
    ...STRIDES.map((value) => h("option", { value: String(value), selected: value === 0.1 }, `${value} s`)),
  );
  const speed = h(
    "select",
    { class: "field compact", "aria-label": "Speed", title: "Speed" },
    ...SPEEDS.map((value) => h("option", { value: String(value), selected: value === 1 }, `${value} ×`)),
  );

  const stepTime = (): void => void session.step({ seconds: Number(stride.value) });
  const stepOnce = (): void => void session.forward();
  const changeSpeed = (by: number): void => {
    speed.selectedIndex = Math.max(0, Math.min(SPEEDS.length - 1, speed.selectedIndex + by));
    session.setSpeed(Number(speed.value));
  };
  speed.addEventListener("change", () => session.setSpeed(Number(speed.value)));

  const play = button("play", "Play", "space", () => void session.toggle(), "primary play");
  const back = button("back", "Back to the moment before", "←", () => session.back());
  const live = h(
    "button",
    {
      type: "button",
      class: "button small live",
      hidden: true,
      title: "Looking back: go to the newest time",
      onclick: () => session.seek(Infinity),
    },
    icon("live"),
    "To newest",
  );
  const slider = h("input", {
    type: "range",
    class: "timeline",
    min: "0",
    max: String(plannedDuration ?? 10),
    step: "0.001",
    value: "0",
    "aria-label": "Time",
  });
  slider.addEventListener("input", () => session.seek(Number(slider.value)));
  const clock = h("input", {
    class: "clock",
    type: "text",
    inputmode: "decimal",
    autocomplete: "off",
    value: "0.000",
    "aria-label": "Run to a time, in seconds",
    title: "Type a time and press Enter: the run goes there",
  });
  clock.addEventListener("focus", () => clock.select());
  clock.addEventListener("blur", () => paint());
  clock.addEventListener("keydown", (event) => {
    if (event.key === "Escape") clock.blur();
    if (event.key !== "Enter") return;
    const typed = clock.value.trim().replace(",", ".");
    clock.blur();
    if (typed !== "" && Number.isFinite(Number(typed))) void session.goTo(Number(typed));
  });
  const until = h(
    "span",
    { class: "clock-until" },
    plannedDuration ? `of ${seconds(plannedDuration, 0)}` : "",
  );
  const mode = h("span", { class: "clock-mode" });

  const loop = h(
    "button",
    {
      type: "button",
      class: "button quiet small icon-only",
      "aria-label": "Loop: show the run again and again",
      title: "Loop: show the run again and again (L)",
      "aria-pressed": "false",
      onclick: () => setLoop(),
    },
    icon("loop"),
  );
  const setLoop = (): void => {
    session.loop = !session.loop;
    loop.setAttribute("aria-pressed", String(session.loop));
  };

  let playing: boolean | undefined;
  const paint = (): void => {
    const state = session.latest;
    if (!state) return;
    const time = session.time;
    slider.max = String(state.duration);
    slider.value = String(time);
    slider.style.setProperty("--done", `${state.duration > 0 ? (100 * time) / state.duration : 0}%`);
    slider.style.setProperty(
      "--computed",
      `${state.duration > 0 ? (100 * state.time) / state.duration : 0}%`,
    );
    slider.setAttribute(
      "aria-valuetext",
      `${seconds(time)} of ${seconds(state.duration, 0)}, computed up to ${seconds(state.time)}`,
    );
    if (document.activeElement !== clock) clock.value = fixedPlain(time, 3);
    setText(until, `of ${Number(state.duration.toFixed(3))} s`);
    setText(
      mode,
      session.replaying
        ? "replay"
        : state.error
          ? "stopped"
          : state.finished
            ? "complete"
            : state.playing
              ? "running"
              : "paused",
    );
    live.hidden = !session.reviewing || session.replaying;
    mode.hidden = !live.hidden;
    back.disabled = time <= 0;
    if (playing !== session.moving) {
      playing = session.moving;
      const label = playing ? "Pause" : "Play";
      play.replaceChildren(icon(playing ? "pause" : "play"));
      play.setAttribute("aria-label", label);
      play.title = `${label} (space)`;
    }
  };
  const silence = session.on("shown", paint);

  const release = bind([
    { keys: [" "], shown: "space", says: "Play or pause", run: () => void session.toggle() },
    {
      keys: ["ArrowRight"],
      shown: "→",
      says: "One integrator step, or the next moment while looking back",
      run: stepOnce,
    },
    { keys: ["l", "L"], shown: "L", says: "Loop: show the run again and again", run: setLoop },
    {
      keys: ["ArrowLeft"],
      shown: "←",
      says: "Back to the moment before, without computing",
      run: () => session.back(),
    },
    { keys: ["."], shown: ".", says: "Step by time", run: stepTime },
    { keys: ["+", "="], shown: "+", says: "Faster", run: () => changeSpeed(1) },
    { keys: ["-"], shown: "−", says: "Slower", run: () => changeSpeed(-1) },
    { keys: ["Backspace"], shown: "Backspace", says: "Back to the start", run: () => void session.reset() },
  ]);

  const root = h(
    "div",
    { class: "transport", role: "group", "aria-label": "Run of the simulation" },
    h("div", { class: "timeline-row" }, slider, loop, more),
    h(
      "div",
      { class: "transport-row" },
      h(
        "div",
        { class: "transport-group" },
        button("reset", "Reset to the start", "backspace", () => void session.reset()),
        back,
        play,
        button("step", "One integrator step", "→", stepOnce),
      ),
      h(
        "div",
        { class: "transport-group joined", hidden: !session.controls },
        button("skip", "Step by time", "full stop", stepTime),
        stride,
      ),
      h("p", { class: "clock-box" }, clock, " ", until, h("span", { class: "clock-slot" }, mode, live)),
      h("div", { class: "transport-group speed" }, speed),
    ),
  );

  return {
    root,
    dispose: () => {
      release();
      silence();
    },
  };
}
