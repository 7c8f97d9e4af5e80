// A joint's force and moment, told for either body, about either point, in either frame.
import type { BodyFrame, JointMultipliers, Vec3 } from "../core/types";
import { add, along, cross, scale, sub } from "./vec";

export type Side = "j" | "i";
export type Frame = "world" | "body";
export type About = "joint" | "centre";

/** Force and moment as asked for: the other body feels both reversed; a new point adds its arm. */
export function wrench(joint: JointMultipliers, body: BodyFrame | undefined, side: Side, about: About, frame: Frame): { force: Vec3; moment: Vec3 } {
  const sign = side === "j" ? 1 : -1;
  let force = scale(joint.force_on_j, sign);
  let moment = scale(joint.moment_on_j, sign);
  if (body && about === "centre") moment = add(moment, cross(sub(joint.at, body.position), force));
  if (body && frame === "body") {
    force = along([body.u, body.v, body.w], force);
    moment = along([body.u, body.v, body.w], moment);
  }
  return { force, moment };
}
