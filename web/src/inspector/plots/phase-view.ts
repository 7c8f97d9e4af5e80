// A plot of quantities over each other, in the page. A click in it moves the page's clock.

import type { SessionState } from "../../api/types";
import type { Session } from "../../session/session";
import type { Chart } from "./charts";
import type { Overlay } from "./overlay";
import { nearest, type PhasePlot, phasePlot, phaseSvg } from "./phase";
import type { Samples } from "./samples";
import type { Colors } from "./svg-file";

/** Height of the plot, px; on a file both sides. */
const HEIGHT = 340;
const FILE: [number, number] = [900, 620];

export class PhaseView {
  private plot: PhasePlot | undefined;
  private times: number[] = [];

  constructor(
    private readonly place: HTMLElement,
    session: Session,
  ) {
    place.addEventListener("click", (event) => {
      const picture = place.firstElementChild;
      if (!this.plot || !(picture instanceof SVGSVGElement)) return;
      const box = picture.getBoundingClientRect();
      const k = nearest(this.plot, box.width, HEIGHT, [event.clientX - box.left, event.clientY - box.top]);
      const time = k === undefined ? undefined : this.times[k];
      if (time !== undefined) session.seek(time);
    });
  }

  draw(chart: Chart, samples: Samples, now: SessionState, kept: Overlay | undefined): void {
    this.plot = phasePlot(chart, samples, now, kept);
    this.times = samples.times;
    this.place.innerHTML = phaseSvg(
      this.plot,
      this.colors(),
      this.color(),
      this.place.clientWidth || 400,
      HEIGHT,
    );
    const picture = this.place.firstElementChild;
    picture?.setAttribute("role", "img");
    picture?.setAttribute("aria-label", chart.label);
  }

  file(title: string, colors: Colors, color: (name: string) => string): string {
    return this.plot ? phaseSvg({ ...this.plot, title }, colors, color, ...FILE) : "";
  }

  /** The plot as it stands, twice as fine. */
  async png(): Promise<Blob | null> {
    const picture = new Image();
    const file = new Blob([this.file("", this.colors(), this.color())], { type: "image/svg+xml" });
    picture.src = URL.createObjectURL(file);
    await picture.decode().finally(() => URL.revokeObjectURL(picture.src));
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = FILE.map((length) => 2 * length) as [number, number];
    canvas.getContext("2d")?.drawImage(picture, 0, 0, canvas.width, canvas.height);
    return new Promise((done) => canvas.toBlob(done));
  }

  private color(): (name: string) => string {
    const css = getComputedStyle(this.place);
    return (name) => css.getPropertyValue(name).trim();
  }

  private colors(): Colors {
    const color = this.color();
    return { ink: color("--ink"), line: color("--line"), paper: color("--surface") };
  }
}
