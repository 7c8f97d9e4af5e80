// What a picture is drawn with: on a canvas while it moves, into an SVG file for a paper.

/** A point of the picture: CSS pixels to the right and down. */
export type Point = [number, number];

export interface Ink {
  fill?: string;
  stroke?: string;
  /** Width of the stroke, CSS pixels. */
  width?: number;
  /** Lengths of dashes and gaps. */
  dash?: number[];
  /** From 0, invisible, to 1. */
  alpha?: number;
  /** Ends of lines are cut straight, not round. */
  butt?: boolean;
}

export interface Words {
  fill: string;
  /** Height of the letters, CSS pixels. */
  size: number;
  /** Which end of the words stands at the point. */
  anchor?: "start" | "middle" | "end";
  /** Colour of the edge that keeps them readable over lines. */
  halo?: string;
  bold?: boolean;
}

export interface Pen {
  path(points: readonly Point[], ink: Ink, closed?: boolean): void;
  disc(center: Point, radius: number, ink: Ink): void;
  text(at: Point, words: string, how: Words): void;
}

/** Width of the edge around words, by the height of their letters. */
const HALO = 0.28;
const FONT = '-apple-system, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", Arial, sans-serif';
const weight = (how: Words): number => (how.bold === false ? 400 : 600);

export class CanvasPen implements Pen {
  constructor(private readonly to: CanvasRenderingContext2D) {}

  path(points: readonly Point[], ink: Ink, closed = false): void {
    const { to } = this;
    const [first, ...rest] = points;
    if (!first) return;
    to.beginPath();
    to.moveTo(first[0], first[1]);
    for (const [x, y] of rest) to.lineTo(x, y);
    if (closed) to.closePath();
    this.finish(ink);
  }

  disc([x, y]: Point, radius: number, ink: Ink): void {
    this.to.beginPath();
    this.to.arc(x, y, Math.max(0, radius), 0, 2 * Math.PI);
    this.finish(ink);
  }

  text([x, y]: Point, words: string, how: Words): void {
    const { to } = this;
    to.font = `${weight(how)} ${how.size}px ${FONT}`;
    to.textAlign = how.anchor === "middle" ? "center" : (how.anchor ?? "start");
    if (how.halo) {
      to.lineJoin = "round";
      to.lineWidth = HALO * how.size;
      to.strokeStyle = how.halo;
      to.strokeText(words, x, y);
    }
    to.fillStyle = how.fill;
    to.fillText(words, x, y);
  }

  private finish(ink: Ink): void {
    const { to } = this;
    to.globalAlpha = ink.alpha ?? 1;
    if (ink.fill) {
      to.fillStyle = ink.fill;
      to.fill();
    }
    if (ink.stroke) {
      to.strokeStyle = ink.stroke;
      to.lineWidth = ink.width ?? 1;
      to.lineCap = ink.butt ? "butt" : "round";
      to.lineJoin = "round";
      to.setLineDash(ink.dash ?? []);
      to.stroke();
    }
    to.globalAlpha = 1;
  }
}

/** Collects the elements of an SVG file. */
export class SvgPen implements Pen {
  private readonly elements: string[] = [];

  path(points: readonly Point[], ink: Ink, closed = false): void {
    if (points.length === 0) return;
    const d = `M${points.map((point) => point.map(short).join(" ")).join("L")}${closed ? "Z" : ""}`;
    this.elements.push(`<path d="${d}"${style(ink)}/>`);
  }

  disc([x, y]: Point, radius: number, ink: Ink): void {
    const r = short(Math.max(0, radius));
    this.elements.push(`<circle cx="${short(x)}" cy="${short(y)}" r="${r}"${style(ink)}/>`);
  }

  text([x, y]: Point, words: string, how: Words): void {
    const halo = how.halo
      ? ` paint-order="stroke" stroke="${how.halo}" stroke-width="${short(HALO * how.size)}" stroke-linejoin="round"`
      : "";
    this.elements.push(
      `<text x="${short(x)}" y="${short(y)}" font-family="${FONT.replaceAll('"', "'")}" font-size="${how.size}" ` +
        `font-weight="${weight(how)}" text-anchor="${how.anchor ?? "start"}" fill="${how.fill}"${halo}>${escaped(words)}</text>`,
    );
  }

  /** The file, of a picture of this size. */
  file(width: number, height: number, title: string): string {
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">` +
      `<title>${escaped(title)}</title>${this.elements.join("")}</svg>\n`
    );
  }
}

function style(ink: Ink): string {
  const stroke = ink.stroke
    ? ` stroke="${ink.stroke}" stroke-width="${short(ink.width ?? 1)}" stroke-linejoin="round"` +
      ` stroke-linecap="${ink.butt ? "butt" : "round"}"${ink.dash ? ` stroke-dasharray="${ink.dash.join(" ")}"` : ""}`
    : "";
  return ` fill="${ink.fill ?? "none"}"${stroke}${ink.alpha === undefined ? "" : ` opacity="${ink.alpha}"`}`;
}

const short = (x: number): string => x.toFixed(2).replace(/\.?0+$/, "");
const escaped = (text: string): string =>
  text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
