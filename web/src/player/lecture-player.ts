// A lecture that was recorded, played: the mechanism as it was shown, the joint that was marked, questions and their votes.

import { h, setText } from "../core/dom";
import { reducedMotion } from "../core/prefs";
import { t } from "../core/texts";
import { histogram } from "../lecture/histogram";
import { at, type Look, playing, type Shown, type Taped } from "../lecture/tape";
import { Recorded } from "../session/recorded";
import { Drawing } from "../stage/drawing";
import { turning } from "../stage/hands";
import { icon } from "../ui/icons";

/** How fast it may be played. */
const SPEEDS = [1, 2, 4];

export class LecturePlayer {
  readonly root: HTMLElement;
  private readonly shown: Shown[];
  private readonly length: number;
  private readonly place = h("div", { class: "player-stage" });
  private readonly asked = h("section", { class: "player-asked", hidden: true });
  private readonly title = h("p", { class: "player-title" });
  private readonly button = h("button", { type: "button", class: "button small player-button" });
  private readonly speed = h("select", { class: "field compact", "aria-label": t("Speed") });
  private readonly timeline: HTMLInputElement;
  private readonly clock = h("span", { class: "player-clock" });
  private readonly runs: Recorded[];
  private drawing: Drawing | undefined;
  private part = -1;
  private look: Look | undefined;
  private time = 0;
  private tickedAt = 0;
  private on = false;
  private gone = false;

  constructor(private readonly taped: Taped) {
    this.shown = playing(taped);
    const last = this.shown.at(-1);
    this.length = last ? last.from + last.lasts : 0;
    this.runs = taped.parts.map((motion) => new Recorded(motion));
    this.timeline = h("input", {
      type: "range",
      class: "timeline",
      min: "0",
      max: String(this.length),
      step: "any",
      "aria-label": t("Time of the lecture"),
    });
    for (const speed of SPEEDS) this.speed.append(h("option", { value: String(speed) }, `${speed}×`));
    this.button.addEventListener("click", () => this.play(!this.on));
    this.timeline.addEventListener("input", () => {
      this.time = Number(this.timeline.value);
      this.play(false);
    });
    this.root = h(
      "div",
      { class: "player is-lecture", role: "group", "aria-label": taped.title },
      this.title,
      this.place,
      this.asked,
      h("div", { class: "player-bar" }, this.button, this.timeline, this.clock, this.speed),
    );
    this.show();
  }

  dispose(): void {
    this.gone = true;
    this.drawing?.dispose();
  }

  play(on: boolean): void {
    const starts = on && !this.on;
    this.on = on;
    if (starts) {
      if (this.time >= this.length) this.time = 0;
      this.tickedAt = performance.now();
      requestAnimationFrame((now) => this.tick(now));
    }
    this.show();
  }

  private tick(now: number): void {
    if (!this.on || this.gone) return;
    this.time += (Math.max(0, now - this.tickedAt) / 1000) * Number(this.speed.value);
    this.tickedAt = now;
    if (this.time >= this.length) {
      this.time = this.length;
      this.on = false;
    }
    this.show();
    requestAnimationFrame((next) => this.tick(next));
  }

  private show(): void {
    const found = at(this.shown, this.time);
    if (found) {
      const [, part, , , look] = found.moment;
      this.turnTo(part);
      this.paintLook(this.taped.looks[look]);
      const run = this.runs[part];
      if (run) {
        run.moving = this.on;
        this.drawing?.update(run.moment(found.run));
      }
    }
    this.paint();
  }

  /** Another run is shown. */
  private turnTo(part: number): void {
    if (part === this.part) return;
    this.part = part;
    this.look = undefined;
    this.drawing?.dispose();
    this.drawing = undefined;
    const run = this.runs[part];
    setText(this.title, run?.motion.title ?? "");
    if (!run) {
      this.place.replaceChildren(
        h("p", { class: "player-unknown" }, t("What was shown here is not recorded.")),
      );
      return;
    }
    this.drawing = new Drawing(run.scene, run, reducedMotion);
    turning(this.drawing);
    this.place.replaceChildren(this.drawing.root);
  }

  private paintLook(look: Look | undefined): void {
    if (!look || look === this.look) return;
    const before = this.look;
    this.look = look;
    const run = this.runs[this.part];
    if (run) {
      run.joint = look.joint;
      run.drawn = look.drawn;
      run.camera = look.camera;
      if (before && before.camera !== look.camera) this.drawing?.lookFrom(look.camera);
    }
    this.place.classList.toggle("is-blank", look.blank);
    const { question, remark } = look;
    this.asked.hidden = !question && !remark;
    this.asked.replaceChildren(
      ...(remark ? [h("h2", null, t("A question from the hall")), h("p", null, remark)] : []),
      ...(question
        ? [
            h("h2", null, question.text),
            question.result
              ? histogram(question.choices, question.result)
              : h("ul", null, ...question.choices.map((choice) => h("li", null, choice))),
          ]
        : []),
    );
  }

  private paint(): void {
    const label = this.on ? t("Pause") : t("Play");
    if (this.button.getAttribute("aria-label") !== label) {
      this.button.replaceChildren(icon(this.on ? "pause" : "play"));
      this.button.setAttribute("aria-label", label);
    }
    this.timeline.value = String(this.time);
    this.timeline.style.setProperty("--done", `${this.length > 0 ? (100 * this.time) / this.length : 0}%`);
    const said = t("{time} of {until}", { time: minutes(this.time), until: minutes(this.length) });
    this.timeline.setAttribute("aria-valuetext", said);
    setText(this.clock, said);
  }
}

const minutes = (seconds: number): string =>
  `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`;
