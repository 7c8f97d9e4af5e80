// A run that was recorded, watched as a live one is.
import type { Camera, Motion, Scene, SessionState, Vec3 } from "../api/types";
import type { Drawn, ReactionConvention } from "./events";
import { fromBase64 } from "./packed";
import { Track } from "./track";
import type { Watched } from "./watched";

const NOWHERE: Vec3 = [0, 0, 0];

export class Recorded implements Watched {
  joint: string | null = null;
  readonly pose = undefined;
  readonly past: { all: SessionState[] };
  readonly scene: Scene;
  moving = false;
  private readonly track = new Track();
  /** Names and scales; bodies and forces come from the track. */
  private readonly frame: SessionState;

  constructor(
    readonly motion: Motion,
    public drawn: Drawn = { what: "none" },
    public camera: Camera = "corner",
    readonly convention: ReactionConvention = { on: "j", about: "joint", in: "world" },
  ) {
    this.scene = motion.scene;
    this.track.add(fromBase64(motion.track));
    this.frame = frameOf(motion, camera);
    this.past = { all: [this.moment(0)] };
  }

  get latest(): SessionState {
    return this.frame;
  }

  moment(time: number): SessionState {
    const within = Math.max(0, Math.min(this.motion.until, time));
    return this.track.at(within, this.frame) ?? this.frame;
  }
}

/** What a motion states once, as a state at its end whose bodies stand nowhere. */
function frameOf(motion: Motion, camera: Camera): SessionState {
  const { title, until, scene, force_scale, moment_scale, longest } = motion;
  return {
    id: "",
    title,
    source: { builtin: "" },
    links: { self: "", stream: "", scene: "", jacobian: "", multipliers: "" },
    time: until,
    duration: until,
    playing: false,
    finished: true,
    speed: motion.speed,
    q: [],
    q_dot: [],
    energy: 0,
    energy_drift: 0,
    position_violation: 0,
    velocity_violation: 0,
    steps: 0,
    rejected: 0,
    evaluations: 0,
    factorizations: 0,
    projections: 0,
    frames: 0,
    frames_encoded: 0,
    watchers: 0,
    changes: 0,
    pull: null,
    events: [],
    earlier_events: 0,
    passages: [],
    earlier_passages: 0,
    notes: [],
    gravity: (scene.gravity ?? NOWHERE) as Vec3,
    drawing: {
      on: "j",
      about: "joint",
      drawn: "all",
      marked: null,
      force_scale,
      moment_scale,
      longest,
      camera,
    },
    bodies: motion.bodies.map((name) => ({
      name,
      position: NOWHERE,
      u: [1, 0, 0],
      v: [0, 1, 0],
      w: [0, 0, 1],
      velocity: NOWHERE,
      angular_velocity: NOWHERE,
      acceleration: NOWHERE,
      mass: 0,
    })),
    forces: motion.joints.map((joint) => ({ ...joint, at: NOWHERE, force: NOWHERE, moment: NOWHERE })),
  };
}
