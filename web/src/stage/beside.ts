// What is drawn beside the mechanism: the paths of its points, and another run of it as a ghost.

import { t } from "../core/texts";
import type { Ghost } from "../session/ghost";
import type { Watched } from "../session/watched";
import { drawMechanism } from "./mechanism";
import { mix, type Palette } from "./palette";
import type { Ink, Pen, Point, Words } from "./pen";
import type { Shown } from "./shown";
import { type Parts, partsOf } from "./solids";
import { Traces } from "./traces";

/** How much of the paper is mixed into the colours of a ghost. */
const PALE = 0.55;

/** A pen whose colours are nearly those of the paper. */
class PalePen implements Pen {
  constructor(
    private readonly pen: Pen,
    private readonly paper: string,
  ) {}

  path(points: readonly Point[], ink: Ink, closed?: boolean): void {
    this.pen.path(points, this.pale(ink), closed);
  }

  disc(center: Point, radius: number, ink: Ink): void {
    this.pen.disc(center, radius, this.pale(ink));
  }

  text(at: Point, words: string, how: Words): void {
    this.pen.text(at, words, how);
  }

  private pale(ink: Ink): Ink {
    const fade = (colour: string): string => mix(colour, this.paper, PALE);
    return {
      ...ink,
      ...(ink.fill ? { fill: fade(ink.fill) } : {}),
      ...(ink.stroke ? { stroke: fade(ink.stroke) } : {}),
    };
  }
}

export class Beside {
  private readonly traces = new Traces();
  private parts: { of: Ghost; parts: Parts } | undefined;

  /** Draws behind the mechanism. Tells for how long a ghost was seen, and of how many points the paths are. */
  draw(pen: Pen, shown: Shown, session: Watched): { ghost: boolean; traced: number } {
    return { ghost: this.drawGhost(pen, shown, session), traced: this.traces.draw(pen, shown, session) };
  }

  private drawGhost(pen: Pen, shown: Shown, { ghost, pose }: Watched): boolean {
    const state = pose ? undefined : ghost?.moment(shown.state.time);
    if (!ghost || !state) return false;
    if (this.parts?.of !== ghost) this.parts = { of: ghost, parts: partsOf(ghost.scene, ghost.start) };
    const { parts } = this.parts;
    drawMechanism(new PalePen(pen, shown.colours.paper), {
      ...shown,
      state,
      parts,
      joint: null,
      floor: undefined,
      plain: true,
    });
    name(pen, shown, t("Ghost: {name}", { name: ghost.name }), shown.colours);
    return true;
  }
}

function name(pen: Pen, { eye }: Shown, words: string, colours: Palette): void {
  const size = 13 * colours.size;
  pen.text([12, eye.height - 14 - 2 * size], words, {
    fill: colours.soft,
    size,
    halo: colours.paper,
    bold: false,
  });
}
