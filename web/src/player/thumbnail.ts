// A small picture of a mechanism at its start, drawn as the stage draws it.
import type { Motion } from "../api/types";
import { Recorded } from "../session/recorded";
import { outline } from "../stage/extent";
import { boxOf, Eye } from "../stage/eye";
import { drawMechanism } from "../stage/mechanism";
import { type Palette, palette } from "../stage/palette";
import { SvgPen } from "../stage/pen";
import { partsOf, planeOf } from "../stage/solids";

/** In this size it is drawn: lines and joints keep their thickness, whatever the list makes of it. CSS pixels. */
export const WIDTH = 240;
export const HEIGHT = 150;

/** The picture as an SVG element's text. */
export function thumbnail(motion: Motion, colours: Palette = palette()): string {
  const run = new Recorded(motion);
  const state = run.moment(0);
  const parts = partsOf(run.scene, state);
  const eye = Eye.under(run.scene.gravity);
  [eye.width, eye.height] = [WIDTH, HEIGHT];
  const normal = planeOf(parts, state);
  if (normal) eye.faceOn(normal);
  const box = boxOf(outline(parts, state, eye));
  if (box) eye.fit(box, 6, 10);
  const pen = new SvgPen();
  drawMechanism(pen, {
    eye,
    state,
    parts,
    colours: { ...colours, size: 1 },
    joint: null,
    floor: undefined,
    plain: true,
  });
  return pen.file(WIDTH, HEIGHT, motion.title);
}
