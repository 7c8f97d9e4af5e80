// Which forces are drawn, and how long: one scale for the whole scene, from the recording, never from one frame.

import type { JointForce, SessionState, Vec3 } from "../api/types";
import { t } from "../core/texts";
import { add, cross, norm, scale, sub } from "./vec";

/** Nothing, the selected joint, every joint, or one body cut free. */
export type Drawn = { what: "none" | "joint" | "all" } | { what: "body"; body: string };

export interface Arrow {
  label: string;
  kind: "reaction" | "weight" | "load";
  at: Vec3;
  /** N. */
  force: Vec3;
  /** N m; null where there is none to speak of. */
  moment: Vec3 | null;
}

/** Beside the largest force of its kind, less than this is rounding. */
const NOTHING = 1e-7;

/** The arrows of a state, as the server draws them too. */
export function arrows(
  state: SessionState,
  drawn: Drawn,
  joint: string | null,
  convention: { on: "i" | "j"; about: "joint" | "center" },
): Arrow[] {
  if (drawn.what === "none") return [];
  if (drawn.what === "body") return freeBody(state, drawn.body).arrows;
  const sign = convention.on === "j" ? 1 : -1;
  return state.forces
    .filter((entry) => drawn.what === "all" || entry.joint === joint)
    .map((entry) => {
      const arrow = reaction(entry, sign);
      const body =
        convention.about === "center"
          ? state.bodies.find((one) => one.name === (convention.on === "j" ? entry.on : entry.by))
          : undefined;
      return body ? moved(arrow, body.position) : arrow;
    });
}

/** The same force and moment about another point. */
function moved(arrow: Arrow, point: Vec3): Arrow {
  const moment = momentAbout(arrow, point);
  return {
    ...arrow,
    at: point,
    moment: norm(moment) > NOTHING * Math.max(1, norm(arrow.force)) ? moment : null,
  };
}

function reaction(entry: JointForce, sign: number): Arrow {
  const moment =
    norm(entry.moment) > NOTHING * Math.max(1, norm(entry.force)) ? scale(entry.moment, sign) : null;
  return { label: entry.joint, kind: "reaction", at: entry.at, force: scale(entry.force, sign), moment };
}

export interface FreeBody {
  arrows: Arrow[];
  /** All of them together, N. */
  sum: Vec3;
  /** Mass times acceleration of the centre of mass, N: equal to the sum. */
  inertia: Vec3;
}

/** Every force on one body. What neither weight nor joints account for is what loads and springs do. */
export function freeBody(state: SessionState, name: string): FreeBody {
  const body = state.bodies.find((entry) => entry.name === name);
  if (!body) return { arrows: [], sum: [0, 0, 0], inertia: [0, 0, 0] };
  const list: Arrow[] = [];
  const weight = scale(state.gravity, body.mass);
  if (norm(weight) > 0)
    list.push({ label: "weight", kind: "weight", at: body.position, force: weight, moment: null });
  for (const entry of state.forces) {
    if (entry.on === name) list.push(reaction(entry, 1));
    else if (entry.by === name) list.push(reaction(entry, -1));
  }
  const inertia = scale(body.acceleration, body.mass);
  const known = list.reduce<Vec3>((sum, arrow) => add(sum, arrow.force), [0, 0, 0]);
  const rest = sub(inertia, known);
  const largest = Math.max(norm(inertia), ...list.map((arrow) => norm(arrow.force)), 1e-12);
  if (norm(rest) > 1e-6 * largest)
    list.push({ label: t("loads together"), kind: "load", at: body.position, force: rest, moment: null });
  return { arrows: list, sum: list.reduce<Vec3>((sum, arrow) => add(sum, arrow.force), [0, 0, 0]), inertia };
}

/** Moment of an arrow about another point. */
export const momentAbout = (arrow: Arrow, point: Vec3): Vec3 =>
  add(arrow.moment ?? [0, 0, 0], cross(sub(arrow.at, point), arrow.force));

/** The nearest of 1, 2, 5, 10 … that is not larger. */
export function roundDown(value: number): number {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value) + 1e-12);
  const lead = value / power;
  return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
}
