// What this page has seen of a run, as one document that plays anywhere.
import type { Motion, Scene } from "../api/types";
import { toBase64 } from "../session/packed";
import type { Session } from "../session/session";

/** Bytes of numbers: with the player and its text a file stays below 300 kB. */
const MOST_BYTES = 150_000;
/** A run that is over sooner than this is watched in slow motion, s. */
const SHORTEST = 2;
/** How long such a run is watched, s. */
const SLOW = 4;

/** The motion so far; undefined while nothing of it is known, as where the 3-D viewer is open. */
export function motionOf(session: Session, scene: Scene | undefined): Motion | undefined {
  const { latest, track, view } = session;
  const block = track.pack(MOST_BYTES);
  const written = (view?.scene ?? scene) as Scene | undefined;
  if (!latest || !block || !written) return undefined;
  // A run that has just been taken back to its start is known as far as its frames.
  const until = Math.max(latest.time, track.end ?? 0);
  const { bodies, joints, markers, gravity, name } = written;
  const { force_scale, moment_scale, longest } = latest.drawing;
  return {
    title: latest.title,
    scene: { name, gravity, bodies, joints, markers } as Scene,
    until,
    speed: until > 0 && until < SHORTEST ? until / SLOW : 1,
    bodies: latest.bodies.map((body) => body.name),
    joints: latest.forces.map(({ joint, on, by }) => ({ joint, on, by })),
    force_scale,
    moment_scale,
    longest,
    track: toBase64(block),
  };
}
