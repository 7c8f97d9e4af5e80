// A piece of a track, for unit tests.

/** A block of one body and one joint, as the server packs it. */
export function block(frames: { time: number; x: number; force: number }[]): Uint8Array {
  const size = 21 + 9;
  const bytes = new ArrayBuffer(16 + frames.length * (8 + 4 * size));
  const view = new DataView(bytes);
  for (const [at, count] of [1, 1, frames.length, 0].entries()) view.setUint32(4 * at, count, true);
  for (const [k, { time, x, force }] of frames.entries()) {
    view.setFloat64(16 + 8 * k, time, true);
    const numbers = [
      x,
      0,
      0,
      1,
      0,
      0,
      0,
      1,
      0,
      0,
      0,
      1,
      ...[2 * x, 0, 0, 0, 0, 3 * x, 4 * x, 0, 0],
      Number.isNaN(force) ? force : x,
      0,
      0,
      force,
      0,
      0,
      0,
      0,
      force,
    ];
    const from = 16 + 8 * frames.length + 4 * size * k;
    for (const [j, number] of numbers.entries()) view.setFloat32(from + 4 * j, number, true);
  }
  return new Uint8Array(bytes);
}
