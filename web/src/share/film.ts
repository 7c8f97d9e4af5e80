// A short film of the drawing: the motion is played once on a canvas of its own, and the browser records it.

import type { Motion } from "../api/types";
import { h } from "../core/dom";
import { t } from "../core/texts";
import { Recorded } from "../session/recorded";
import type { Session } from "../session/session";
import { Drawing } from "../stage/drawing";

/** Pixels of the film. */
const WIDTH = 1280;
const HEIGHT = 720;
/** Frames a second. */
const RATE = 30;
/** Bits a second: thin lines stay sharp. */
const BITS = 4e6;
/** A longer run is played faster, s. */
const LONGEST = 30;
/** The last picture stands this long, ms. */
const END_MS = 400;
/** What is tried, in this order. */
const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

/** The kind of film that this browser records; undefined where it records none. */
export function kindOfFilm(): string | undefined {
  if (typeof MediaRecorder === "undefined" || !("captureStream" in HTMLCanvasElement.prototype))
    return undefined;
  return KINDS.find((kind) => MediaRecorder.isTypeSupported(kind));
}

/** How long the film of a motion takes to record, s. */
export const lengthOf = (motion: Motion): number => Math.min(LONGEST, motion.until / motion.speed);

/** Records the motion as the stage shows it. `progress` is told the part that is done. */
export async function film(
  motion: Motion,
  session: Session,
  like: Drawing,
  progress: (part: number) => void,
  signal: AbortSignal,
): Promise<Blob> {
  const kind = kindOfFilm();
  if (kind === undefined) throw new Error(t("this browser records no films"));
  const canvas = h("canvas", { width: WIDTH, height: HEIGHT });
  const run = new Recorded(motion, session.drawn, session.camera, session.convention);
  const drawing = new Drawing(run.scene, run, () => true);
  const paint = drawing.film(canvas, like);
  paint(run.moment(0));
  const recorder = new MediaRecorder(canvas.captureStream(RATE), {
    mimeType: kind,
    videoBitsPerSecond: BITS,
  });
  const parts: Blob[] = [];
  recorder.ondataavailable = (event) => parts.push(event.data);
  const stopped = new Promise<void>((done) => {
    recorder.onstop = () => done();
  });
  recorder.start();
  try {
    await play(
      lengthOf(motion),
      (part) => {
        paint(run.moment(part * motion.until));
        progress(part);
      },
      signal,
    );
    await new Promise((done) => setTimeout(done, END_MS));
  } finally {
    recorder.stop();
    drawing.dispose();
  }
  await stopped;
  signal.throwIfAborted();
  return new Blob(parts, { type: kind.split(";")[0] ?? kind });
}

/** Calls with the part of `seconds` that has passed, picture by picture, until it is over or given up. */
function play(seconds: number, show: (part: number) => void, signal: AbortSignal): Promise<void> {
  const began = performance.now();
  return new Promise((done) => {
    const next = (now: number): void => {
      const part = Math.min(1, (now - began) / (1000 * seconds || 1));
      show(Math.max(0, part));
      if (part >= 1 || signal.aborted) done();
      else requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
  });
}
