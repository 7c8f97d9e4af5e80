// A free-body diagram: forces are dragged out of the points of a body that is cut free, moments are clicked there; or all
// is chosen from lists, by keyboard and with a screen reader.

import type { Question } from "../api/types";
import { announce, authored, h, svg } from "../core/dom";
import { t } from "../core/texts";
import {
  type Arrow,
  choicesOf,
  type Diagram,
  drafted,
  dragged,
  drawn,
  forceAt,
  inWords,
  labelledSelect,
  placesThere,
  sameLine,
} from "./arrows";
import type { Inputs, QuestionContext } from "./field";

/** Height of a point's name on the screen, px: where the picture is drawn smaller, names grow in it. */
const NAME = 12;
/** Width of a letter of a name at most, and the distance of its lines, in heights. */
const [LETTER, LINE] = [0.55, 1.33];

/** Lines of names below a body: each name stands on the first where there is room for it. */
class LabelRows {
  private readonly taken: [number, number][][] = [];

  /** Height of the names, px of the picture. */
  constructor(private readonly height: number) {}

  /** Where a name begins that is wanted at `x`, within a picture of this width, and its line. */
  take(wanted: number, width: number, words: string): [number, number] {
    const long = LETTER * this.height * words.length;
    const x = Math.max(2, Math.min(wanted, width - long - 2));
    const end = x + long;
    const free = (spans: [number, number][]): boolean => spans.every(([from, to]) => end < from || x > to);
    const found = this.taken.findIndex(free);
    const row = found < 0 ? this.taken.push([]) - 1 : found;
    this.taken[row]?.push([x, end]);
    return [x, row];
  }
}

/** Radius within which a point is taken, px of the screen. */
const REACH = 18;

export function diagramInput(
  question: Question,
  context: QuestionContext,
  draft: string[] | undefined,
): Inputs {
  const { diagram } = question;
  if (!diagram) return { root: h("div"), answer: () => ({ diagram: [] }), draft: () => [] };
  const field = new DiagramField(diagram, context, drafted(diagram, draft));
  return { root: field.root, answer: () => ({ diagram: field.arrows }), draft: () => field.draft() };
}

class DiagramField {
  arrows: Arrow[];
  readonly root: HTMLElement;
  private readonly layer: SVGGElement;
  private readonly spots = svg("g", {});
  private readonly trail = svg("path", { class: "drawn-trail", d: "" });
  private readonly overlay: SVGSVGElement;
  private readonly list = h("ul", { class: "arrow-list" });
  private readonly body: HTMLSelectElement;
  private readonly place: HTMLSelectElement;
  private readonly what: HTMLSelectElement;
  private readonly add: HTMLButtonElement;

  constructor(
    private readonly diagram: Diagram,
    { base, described }: QuestionContext,
    before: Arrow[],
  ) {
    this.arrows = before;
    const [width, height] = diagram.size as [number, number];
    this.layer = svg("g", {});
    this.overlay = svg(
      "svg",
      { viewBox: `0 0 ${width} ${height}`, class: "cut-layer", "aria-hidden": "true" },
      this.layer,
      this.trail,
      this.spots,
    );
    // A page that is left lets go of its elements, and of this with them.
    new ResizeObserver(() => this.placeSpots()).observe(this.overlay);
    const body = labelledSelect(`${base}-body`, t("Body"), described);
    const place = labelledSelect(`${base}-place`, t("Point"), described);
    const what = labelledSelect(`${base}-what`, t("Force or moment"), described);
    [this.body, this.place, this.what] = [body.select, place.select, what.select];
    this.body.append(...diagram.bodies.map((one) => h("option", { value: one.name }, one.name)));
    this.what.append(...choicesOf(diagram).map((one, at) => h("option", { value: String(at) }, one.label)));
    this.body.addEventListener("change", () => this.offerPlaces());
    this.add = h(
      "button",
      { type: "button", class: "button small", onclick: () => this.addChosen() },
      t("Add"),
    );
    this.root = h(
      "div",
      { class: "answer is-diagram" },
      h("div", { class: "cut-picture" }, authored(h("div"), diagram.picture_svg), this.overlay),
      h(
        "p",
        { class: "rule" },
        t(
          "Drag a force out of a point. Click a point for a moment, again for the other sense, again to take it away. Or choose:",
        ),
      ),
      h("div", { class: "settings" }, body.root, place.root, what.root, this.add),
      this.list,
    );
    this.offerPlaces();
    this.paint();
  }

  draft(): string[] {
    return this.arrows.map((arrow) => JSON.stringify(arrow));
  }

  /** Points and their names, as large as the screen needs them. */
  private placeSpots(): void {
    const shown = this.overlay.getBoundingClientRect().width;
    const scale = Math.max(1, (this.diagram.size[0] ?? 1) / Math.max(shown, 1));
    this.root.style.setProperty("--cut-name", `${(NAME * scale).toFixed(1)}px`);
    this.spots.replaceChildren(...this.diagram.bodies.flatMap((body) => this.points(body, scale)));
  }

  /** A hinge and its motor stand at one point: there a force is the hinge's, a moment the motor's. */
  private points(body: Diagram["bodies"][number], scale: number): SVGElement[] {
    const spots = new Map<string, typeof body.places>();
    for (const place of body.places) spots.set(`${place.at}`, [...(spots.get(`${place.at}`) ?? []), place]);
    const rows = new LabelRows(NAME * scale);
    const all = [...spots.values()].map((places) => (places[0]?.at ?? [0, 0]) as [number, number]);
    return [...spots.values()].map((places, index) => {
      const [x, y] = all[index] ?? [0, 0];
      // For a finger on a small screen as much as the next point leaves.
      const others = all.filter((_, at) => at !== index).map(([a, b]) => Math.hypot(a - x, b - y) / 2);
      const reach = Math.max(REACH, Math.min(REACH * scale, ...others));
      const point = svg("circle", { cx: x, cy: y, r: reach, class: "cut-point" });
      const words = places.map((place) => place.label).join(", ");
      const [left, row] = rows.take(x + 8, this.diagram.size[0] ?? 0, words);
      const below = 12 + NAME * scale * LINE * (1 + row);
      const name = svg("text", { x: left, y: y + below, class: "cut-name" }, words);
      const ids = places.map((place) => place.id);
      point.addEventListener("pointerdown", (event) => this.drag(event, body.name, ids, [x, y]));
      return svg("g", {}, point, name);
    });
  }

  /** Follows the pointer from a point of the body to where it is let go. */
  private drag(start: PointerEvent, on: string, places: string[], [x, y]: [number, number]): void {
    start.preventDefault();
    const inPicture = (event: PointerEvent): [number, number] => {
      const box = this.overlay.getBoundingClientRect();
      const scale = (this.diagram.size[0] ?? 1) / Math.max(box.width, 1);
      return [(event.clientX - box.left) * scale - x, (event.clientY - box.top) * scale - y];
    };
    const target = start.currentTarget as SVGElement;
    target.setPointerCapture(start.pointerId);
    const move = (event: PointerEvent): void => {
      const [dx, dy] = inPicture(event);
      this.trail.setAttribute("d", `M${x} ${y}l${dx} ${dy}`);
    };
    const stop = (): void => {
      this.trail.setAttribute("d", "");
      target.removeEventListener("pointermove", move);
      target.removeEventListener("pointerup", up);
      target.removeEventListener("pointercancel", stop);
    };
    const up = (event: PointerEvent): void => {
      stop();
      const along = dragged(this.diagram, ...inPicture(event));
      if (along) this.put({ kind: "force", at: forceAt(this.arrows, places, on, along), on, along });
      else this.turnMoment(on, places.at(-1) ?? "");
    };
    target.addEventListener("pointermove", move);
    target.addEventListener("pointerup", up);
    target.addEventListener("pointercancel", stop);
  }

  /** None, anticlockwise, clockwise, none. */
  private turnMoment(on: string, at: string): void {
    const [anticlockwise, clockwise] = choicesOf(this.diagram).filter((one) => one.kind === "moment");
    if (!anticlockwise || !clockwise) return;
    const there = this.arrows.find((arrow) => arrow.kind === "moment" && arrow.on === on && arrow.at === at);
    if (!there) this.put({ kind: "moment", at, on, along: anticlockwise.along });
    else if (there.along === anticlockwise.along) this.put({ ...there, along: clockwise.along });
    else this.remove(there);
  }

  private addChosen(): void {
    const choice = choicesOf(this.diagram)[Number(this.what.value)];
    if (choice)
      this.put({ kind: choice.kind, at: this.place.value, on: this.body.value, along: choice.along });
  }

  private put(arrow: Arrow): void {
    this.arrows = [...this.arrows.filter((other) => !sameLine(other, arrow)), arrow];
    this.changed(t("Added: {arrow}", { arrow: inWords(this.diagram, arrow) }));
  }

  private remove(arrow: Arrow): void {
    this.arrows = this.arrows.filter((other) => other !== arrow);
    this.changed(t("Removed: {arrow}", { arrow: inWords(this.diagram, arrow) }));
  }

  /** The list is painted anew: the focus goes on to the next arrow's button, so that the keyboard keeps its place. */
  private removeListed(arrow: Arrow): void {
    const at = this.arrows.indexOf(arrow);
    this.remove(arrow);
    const buttons = this.list.querySelectorAll("button");
    (buttons[Math.min(at, buttons.length - 1)] ?? this.add).focus();
  }

  private changed(said: string): void {
    this.paint();
    announce(said);
    this.root.dispatchEvent(new Event("input", { bubbles: true }));
  }

  /** A list of what stands at an arrow's point, to say to which of it the arrow belongs. */
  private elsewhere(arrow: Arrow, words: string): HTMLElement | string {
    const places = placesThere(this.diagram, arrow);
    if (places.length < 2) return "";
    const options = places.map((place) =>
      h("option", { value: place.id, selected: place.id === arrow.at }, place.label),
    );
    const list = h("select", { class: "field", "aria-label": t("Point of {words}", { words }) }, ...options);
    list.addEventListener("change", () => {
      this.arrows = this.arrows.filter((other) => other !== arrow);
      this.put({ ...arrow, at: list.value });
    });
    return list;
  }

  private offerPlaces(): void {
    const places = this.diagram.bodies.find((body) => body.name === this.body.value)?.places ?? [];
    this.place.replaceChildren(...places.map((place) => h("option", { value: place.id }, place.label)));
  }

  private paint(): void {
    const shapes = this.arrows.map((arrow) => drawn(this.diagram, arrow));
    this.layer.replaceChildren(...shapes.filter((shape) => shape !== undefined));
    this.list.replaceChildren(
      ...this.arrows.map((arrow) => {
        const words = inWords(this.diagram, arrow);
        const remove = h(
          "button",
          {
            type: "button",
            class: "button quiet small",
            "aria-label": t("Remove {words}", { words }),
            onclick: () => this.removeListed(arrow),
          },
          t("Remove"),
        );
        return h("li", null, words, " ", this.elsewhere(arrow, words), remove);
      }),
    );
  }
}
