// A state of one body, for unit tests.
import type { BodyState, Drawing, SessionState, Vec3 } from "../api/types";

export const body: BodyState = {
  name: "bob",
  position: [1, 0, 0],
  u: [0, 1, 0],
  v: [-1, 0, 0],
  w: [0, 0, 1],
  velocity: [0, 0, 0],
  angular_velocity: [0, 0, 0],
  acceleration: [0, 0, 0],
  mass: 1,
};
const drawing: Drawing = {
  on: "j",
  about: "joint",
  drawn: "all",
  marked: null,
  force_scale: 0.1,
  moment_scale: 0.1,
  longest: 1,
  camera: "corner",
};

/** The body stands at x on the first axis. */
export const state = (time: number, x: number): SessionState => ({
  id: "a",
  title: "",
  source: { builtin: "" },
  pull: null,
  links: { self: "", stream: "", scene: "", jacobian: "", multipliers: "" },
  time,
  duration: 10,
  playing: false,
  speed: 1,
  q: [],
  q_dot: [],
  energy: 0,
  energy_drift: 0,
  position_violation: 0,
  velocity_violation: 0,
  steps: 0,
  projections: 0,
  frames: 0,
  frames_encoded: 0,
  watchers: 0,
  notes: [],
  rejected: 0,
  evaluations: 0,
  factorizations: 0,
  finished: false,
  changes: 0,
  drawing,
  forces: [],
  gravity: [0, 0, -9.81],
  bodies: [{ ...body, position: [x, 0, 0] as Vec3 }],
});
