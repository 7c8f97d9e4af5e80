// The page's own picture of a run: always that of the moment which it is given, on every machine.

import type { Camera, Scene, SessionState, Vec3 } from "../api/types";
import { h } from "../core/dom";
import { type Arrow, arrows } from "../mechanics/forces";
import { add, dot, norm, scale, unit } from "../mechanics/vec";
import type { Watched } from "../session/watched";
import { Beside } from "./beside";
import { circle, outline, pointsOf, soon } from "./extent";
import { type Box, boxOf, Eye } from "./eye";
import { drawForces } from "./forces-picture";
import { type Place, placeOf } from "./labels";
import { axesCorner, distanceTo, drawMechanism, drawWorldAxes } from "./mechanism";
import { type Palette, palette } from "./palette";
import { CanvasPen, type Pen, type Point, SvgPen } from "./pen";
import { drawPull } from "./pull-picture";
import type { Shown } from "./shown";
import { inWorld, middleOf, type Parts, partsOf, planeOf } from "./solids";
import { inWords } from "./words";

/** Where one reaches for a joint or a body, CSS pixels about it; fingers are thicker than this. */
const REACH = 14;
/** A run that has been seen for this long, s, has shown where it goes: the picture is fitted to that. */
const SWEEP = 2;
/** The picture is fitted anew where it would become this many times as large. */
const WORTH_FITTING = 1.15;
/** What flies out of the picture is followed to where it will be in so many seconds of the run. */
const AHEAD = 0.8;
/** How long the picture takes to a new fit, ms. */
const EASE_MS = 450;
/** Moments of a run at which it is asked where its parts are. */
const SWEEP_MOMENTS = 60;
/** The floor is below the lowest point by this part of the height of the picture. */
const FLOOR_BELOW = 0.06;
/** Room for words and bars above and below what is fitted, CSS pixels. */
const ABOVE = 26;
const BELOW = 40;
/** The drawing tells its state to screen readers at most this often, ms. */
const TELL_MS = 1500;

/** What was grabbed: a body, and where in the world. */
export interface Grip {
  body: string;
  at: Vec3;
}

export class Drawing {
  readonly root = h("canvas", { class: "drawing", tabindex: "0", role: "img" });
  private readonly context = this.root.getContext("2d");
  private readonly eye: Eye;
  private colours: Palette | undefined;
  private parts: Parts | undefined;
  private state: SessionState | undefined;
  private floor: number | undefined;
  /** The reader has turned or moved the picture: it is not fitted by itself any more. */
  private byHand = false;
  /** The whole sweep of the run has been fitted. */
  private swept = false;
  private easing: { from: [number, Point]; to: [number, Point]; since: number } | undefined;
  private toldAt = 0;
  /** Where buttons lie over the picture. */
  private covered: Place[] = [];
  private readonly beside = new Beside();
  private readonly watch: ResizeObserver;

  constructor(
    private scene: Scene | undefined,
    private readonly session: Watched,
    private readonly still: () => boolean,
    /** Without axes and names. */
    private readonly plain = false,
    /** What lies over it. */
    private readonly over: () => HTMLElement[] = () => [],
  ) {
    this.eye = Eye.under(scene?.gravity);
    this.watch = new ResizeObserver(() => this.resize());
    this.watch.observe(this.root);
  }

  dispose(): void {
    this.watch.disconnect();
  }

  /** Shows a moment. */
  update(state: SessionState): void {
    this.state = state;
    if (!this.parts) {
      this.parts = partsOf(this.scene, state);
      this.face(state);
    }
    if (!this.byHand) this.keepInSight(state);
    this.paint();
    this.tell(state);
  }

  /** Draws a changed scene, of which `first` is the first state. */
  rebuild(scene: Scene, first: SessionState): void {
    if (!this.scene) this.eye.standUnder(scene.gravity);
    this.scene = scene;
    this.parts = partsOf(scene, first);
    this.swept = false;
    this.state ??= first;
    if (!this.byHand) this.face(first);
    this.paint();
  }

  /** Another theme, or larger type. */
  recolour(): void {
    this.colours = undefined;
    this.paint();
  }

  lookFrom(side: Camera): void {
    this.eye.lookFrom(side);
    this.byHand = false;
    this.swept = false;
    this.fit(false);
    this.paint();
  }

  /** Shows all of it, as large as it fits. */
  fit(slowly = true): void {
    this.byHand = false;
    const box = this.sweep();
    if (box) this.frame(box, slowly);
  }

  private frame(box: Box, slowly: boolean, leaving = false): void {
    const before: [number, Point] = [this.eye.perMetre, [...this.eye.middle]];
    this.eye.fit(box, ABOVE, BELOW);
    this.floor = this.floorUnder(leaving);
    if (!slowly || this.still()) {
      this.easing = undefined;
      return;
    }
    this.easing = { from: before, to: [this.eye.perMetre, [...this.eye.middle]], since: performance.now() };
    [this.eye.perMetre, this.eye.middle] = before;
    requestAnimationFrame(() => this.ease());
  }

  turn(turn: number, tilt: number): void {
    this.byHand = true;
    this.eye.orbit(turn, tilt, this.center());
    this.paint();
  }

  zoom(by: number, about: Point = [this.eye.width / 2, this.eye.height / 2]): void {
    this.byHand = true;
    this.eye.zoom(by, about);
    this.paint();
  }

  /** The joint at a point of the picture. */
  jointAt([x, y]: Point): string | undefined {
    const { parts, state } = this;
    if (!parts || !state) return undefined;
    const far = parts.joints.map((joint) => {
      const [jx, jy] = this.eye.project(inWorld(state, joint.body, joint.point));
      return { name: joint.name, off: Math.hypot(x - jx, y - jy) };
    });
    far.sort((a, b) => a.off - b.off);
    return far[0] && far[0].off < REACH ? far[0].name : undefined;
  }

  /** The body at a point of the picture, and the point of it that is grabbed. */
  grip(point: Point): Grip | undefined {
    const shown = this.shown();
    if (!shown) return undefined;
    const near = shown.parts.solids
      .filter((solid) => distanceTo(shown, solid, point) < REACH / 2)
      .map((solid) => ({ solid, middle: middleOf(shown.state, solid) }))
      .sort((a, b) => this.eye.nearness(b.middle) - this.eye.nearness(a.middle))[0];
    const body = near && shown.state.bodies[near.solid.body];
    if (!near || !body) return undefined;
    // The point under the hand, in the plane of the picture through the middle of the part.
    const [mx, my] = this.eye.project(near.middle);
    const off = this.move(point[0] - mx, point[1] - my);
    const at = near.middle.map((value, k) => value + (off[k] ?? 0)) as Vec3;
    return { body: body.name, at };
  }

  /** The shift in the world that a shift on the picture means. */
  move(dx: number, dy: number): Vec3 {
    return this.eye.shift(dx, dy);
  }

  /** The picture as an SVG file. */
  svg(title: string): string {
    const pen = new SvgPen();
    this.draw(pen);
    return pen.file(this.eye.width, this.eye.height, title);
  }

  /** The picture as it stands, on paper, with so many pixels for each of the page's. */
  canvas(ratio: number): HTMLCanvasElement {
    const { width, height } = this.eye;
    const canvas = h("canvas", { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    const context = canvas.getContext("2d");
    if (context) {
      context.setTransform(ratio, 0, 0, ratio, 0, 0);
      this.onPaper(context);
    }
    return canvas;
  }

  /** Paints a moment on a canvas of another size, on paper, from the side from which this one is looked at. */
  film(canvas: HTMLCanvasElement, like: Drawing): (state: SessionState) => void {
    const context = canvas.getContext("2d");
    [this.eye.width, this.eye.height] = [canvas.width, canvas.height];
    return (state) => {
      const first = this.state === undefined;
      this.state = state;
      this.parts ??= partsOf(this.scene, state);
      if (first) {
        this.eye.like(like.eye);
        this.fit(false);
      }
      if (context) this.onPaper(context);
    };
  }

  private onPaper(context: CanvasRenderingContext2D): void {
    this.colours ??= palette();
    context.fillStyle = this.colours.paper;
    context.fillRect(0, 0, this.eye.width, this.eye.height);
    this.draw(new CanvasPen(context));
  }

  /** Turns the picture so that a plane mechanism is seen from the front. */
  private face(state: SessionState): void {
    const normal = this.parts && planeOf(this.parts, state);
    if (normal) this.eye.faceOn(normal);
    this.eye.lookFrom(this.session.camera);
    this.fit(false);
  }

  private shown(): Shown | undefined {
    const { state, parts, eye, floor, plain } = this;
    if (!state || !parts) return undefined;
    this.colours ??= palette();
    return { eye, state, parts, colours: this.colours, joint: this.session.joint, floor, plain };
  }

  private paint(): void {
    const { context, root } = this;
    if (!context || root.width === 0) return;
    const ratio = root.width / Math.max(1, this.eye.width);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.eye.width, this.eye.height);
    this.draw(new CanvasPen(context));
    // The moment that is to be seen.
    if (this.state) root.dataset.time = this.state.time.toFixed(3);
  }

  private draw(pen: Pen): void {
    const shown = this.shown();
    if (!shown) return;
    const { eye, colours, state } = shown;
    drawMechanism(pen, shown, () => {
      const { ghost, traced } = this.beside.draw(pen, shown, this.session);
      Object.assign(this.root.dataset, { ghost: String(ghost), traced: String(traced) });
    });
    drawPull(pen, this.session, state, eye, colours);
    const covered = this.plain ? [] : [axesCorner(eye, colours), ...this.covered];
    drawForces(pen, this.session, state, eye, colours, covered);
    if (!this.plain) drawWorldAxes(pen, eye, colours);
  }

  private resize(): void {
    const { root, eye } = this;
    const [width, height] = [root.clientWidth, root.clientHeight];
    if (width === 0 || height === 0) return;
    const ratio = Math.min(2, devicePixelRatio || 1);
    [root.width, root.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    [eye.width, eye.height] = [width, height];
    this.covered = this.over().map(placeOf);
    if (!this.byHand) this.fit(false);
    this.paint();
  }

  private ease(): void {
    const { easing, eye } = this;
    if (!easing || this.byHand) return;
    const part = Math.min(1, (performance.now() - easing.since) / EASE_MS);
    const smooth = part * part * (3 - 2 * part);
    const between = (a: number, b: number): number => a + smooth * (b - a);
    eye.perMetre = between(easing.from[0], easing.to[0]);
    eye.middle = [between(easing.from[1][0], easing.to[1][0]), between(easing.from[1][1], easing.to[1][1])];
    this.paint();
    if (part < 1) requestAnimationFrame(() => this.ease());
    else {
      this.easing = undefined;
      // It may have gone on meanwhile.
      if (this.state) this.keepInSight(this.state);
    }
  }

  /** Fits the picture when the run has shown where it goes, and again where a part leaves it. */
  private keepInSight(state: SessionState): void {
    const { eye, parts } = this;
    if (this.easing || !parts) return;
    const out = pointsOf(parts, state).some((part) => {
      const [x, y] = eye.project(part);
      return Number.isFinite(x + y) && (x < 0 || y < 0 || x > eye.width || y > eye.height);
    });
    if (!out && (this.swept || !this.known)) return;
    const box = this.sweep(out);
    if (!box) return;
    this.swept ||= this.known;
    if (out || eye.scaleOf(box, ABOVE, BELOW) > WORTH_FITTING * eye.perMetre) this.frame(box, true, out);
  }

  /** The run has been seen for long enough to know where it goes. */
  private get known(): boolean {
    const { latest } = this.session;
    return (latest?.time ?? 0) >= Math.min(SWEEP, latest?.duration ?? SWEEP);
  }

  /** Where joints stand on the ground. */
  private grounds(parts: Parts, state: SessionState): Vec3[] {
    return parts.joints
      .filter((joint) => joint.grounded)
      .map((joint) => inWorld(state, joint.body, joint.point));
  }

  /** What the motion has covered so far, in the plane of the picture. Before it is known: where it could swing to. */
  private sweep(leaving = false): Box | undefined {
    const { parts, state, eye, session, known } = this;
    if (!parts || !state) return undefined;
    const last = session.latest?.time ?? 0;
    const count = known || leaving ? SWEEP_MOMENTS : 1;
    const moments = Array.from({ length: count }, (_, k) =>
      count > 1 ? (session.moment((last * k) / (count - 1)) ?? state) : state,
    );
    const fixed = this.grounds(parts, state).map((p) => eye.flat(p));
    // What hangs on the ground turns back.
    const flies = leaving && session.moving && fixed.length === 0;
    const seen = flies ? [state, soon(state, AHEAD), ...moments] : [state, ...moments];
    const points = seen.flatMap((moment) => outline(parts, moment, eye));
    if (!known && fixed.length === 1 && !this.turnsUpright()) points.push(...circle(fixed, points));
    points.push(...this.tips(moments).map((p) => eye.flat(p)));
    return boxOf(points);
  }

  /** A mechanism on a vertical hinge stays beside it: it does not swing below. */
  private turnsUpright(): boolean {
    const hinge = this.parts?.joints.find((joint) => joint.grounded);
    return hinge?.kind === "revolute" && Math.abs(dot(hinge.axis ?? [0, 0, 0], this.eye.up)) > 0.9;
  }

  /** Where the arrows of these moments end; those above the median are counted as long as it. */
  private tips(moments: SessionState[]): Vec3[] {
    const { session } = this;
    if (session.pose) return [];
    const { drawing } = session.latest ?? {};
    if (!drawing) return [];
    const drawn = moments.flatMap((moment) =>
      arrows(moment, session.drawn, session.joint, session.convention),
    );
    const length = (arrow: Arrow): number =>
      Math.min(drawing.longest, norm(arrow.force) * drawing.force_scale);
    const median = drawn.map(length).sort((a, b) => a - b)[drawn.length >> 1] ?? 0;
    return drawn.map((arrow) => add(arrow.at, scale(unit(arrow.force), Math.min(median, length(arrow)))));
  }

  /** Height of the floor: below all that is seen, and below where what hangs may swing. */
  private floorUnder(leaving: boolean): number | undefined {
    const { parts, state, eye, session } = this;
    if (!parts || !state || !this.scene?.gravity?.some((g) => g !== 0)) return undefined;
    const seen = [state, ...session.past.all.slice(0, 1), ...(session.latest ? [session.latest] : [])];
    const fixed = this.grounds(parts, state);
    if (leaving && fixed.length === 0) seen.push(soon(state, AHEAD));
    const points = seen.flatMap((moment) => pointsOf(parts, moment));
    // A mechanism that hangs may swing as far below its joints as it reaches.
    const reach = fixed.flatMap((f) =>
      points.map((p) => dot(f, eye.up) - Math.hypot(...p.map((x, k) => x - (f[k] ?? 0)))),
    );
    const lowest = Math.min(
      ...points.map((p) => dot(p, eye.up)),
      ...(fixed.length === 1 && !this.turnsUpright() ? reach : []),
    );
    return Number.isFinite(lowest) ? lowest - (FLOOR_BELOW * eye.height) / eye.perMetre : undefined;
  }

  private center(): Vec3 {
    const bodies = this.state?.bodies ?? [];
    const sum = bodies.reduce((total, body) => total.map((x, k) => x + (body.position[k] ?? 0)), [0, 0, 0]);
    return sum.map((x) => x / Math.max(1, bodies.length)) as Vec3;
  }

  /** Says what is to be seen, for those who do not see it; seldom while it moves. */
  private tell(state: SessionState): void {
    const now = performance.now();
    const said = this.root.hasAttribute("aria-label");
    if (said && this.session.moving && now - this.toldAt < TELL_MS) return;
    this.toldAt = now;
    const label = inWords(state);
    if (this.root.getAttribute("aria-label") !== label) this.root.setAttribute("aria-label", label);
  }
}
