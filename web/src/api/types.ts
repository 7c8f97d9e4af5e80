// Shapes of what /api/v1 sends and takes. Numbers are SI unless a `unit` says otherwise.

export type Vec3 = [number, number, number];

export interface LessonSummary {
  slug: string;
  number: number;
  title: string;
  summary: string;
  minutes: number;
  objectives: string[];
}

export interface Option {
  id: string;
  html: string;
}

export interface Question {
  id: string;
  kind:
    | "number"
    | "vector"
    | "matrix"
    | "choice"
    | "formula"
    | "implement"
    | "trajectory"
    | "model"
    | "tuning";
  prompt_html: string;
  /** The unit that the answer is read in. */
  unit?: string | null;
  /** Whether the student has to write the unit. */
  asks_unit?: boolean;
  /** Rows and columns of a vector's answer. */
  size?: [number, number];
  /** The sentence that states the tolerance, written from the rule that grades. */
  rule: string;
  points: number;
  options?: Option[];
  /** What a program returns for each state (implement). */
  asks?: string[];
  /** Columns of the table besides t (trajectory). */
  columns?: { name: string; what: string }[];
  /** What may be chosen (tuning). */
  tuning?: { integrators: string[]; baumgarte: boolean; budget: number; error: number };
  /** Earlier questions whose answer is carried through. */
  follows?: string[];
  hints_available: number;
}

export interface Lesson {
  slug: string;
  number: number;
  title: string;
  minutes: number;
  objectives: string[];
  prerequisites: string[];
  html: string;
  scene: Scene | string;
  /** Whether each student gets numbers, or states, of their own. */
  has_variants: boolean;
  /** Whose numbers these are; empty for those that everybody sees. */
  seed: string;
  /** What to do with the mechanism, in order. */
  steps?: { kind: "predict" | "run" | "check" | "explain"; html: string }[];
  exercise: { questions: Question[]; pass_mark?: number };
}

export interface Scene {
  name: string;
  title?: string;
  description?: string;
  gravity?: Vec3;
  bodies?: SceneBody[];
  joints?: SceneJoint[];
  simulation?: { duration?: number };
}

export interface SceneJoint {
  name: string;
  type?: string;
  body_i?: string;
  body_j?: string;
  /** In the world, at the start. */
  point?: Vec3;
  /** In the frames of the two bodies; the ground's is the world. */
  point_i?: Vec3;
  point_j?: Vec3;
}

export interface SceneBody {
  name: string;
  position?: Vec3;
  orientation?: Orientation;
  shape?: Shape[];
}

export interface Orientation {
  u?: Vec3;
  v?: Vec3;
  quaternion?: [number, number, number, number];
  axis?: Vec3;
  angle?: number;
}

export type Shape =
  | { kind: "rod"; from: Vec3; to: Vec3; radius: number }
  | { kind: "sphere"; center: Vec3; radius: number }
  | { kind: "box"; center: Vec3; size: Vec3 };

export interface SceneSummary {
  name: string;
  title?: string;
  summary: string;
}

export interface BodyFrame {
  name: string;
  /** Of the centre of mass, in the world frame, m. */
  position: Vec3;
  u: Vec3;
  v: Vec3;
  w: Vec3;
  velocity: Vec3;
  angular_velocity: Vec3;
  /** Of the centre of mass, m/s². */
  acceleration: Vec3;
  mass: number;
}

/** What a joint or driver does to a body, in the world; the other body feels both reversed. */
export interface JointForce {
  joint: string;
  on: string;
  by: string;
  at: Vec3;
  force: Vec3;
  moment: Vec3;
}

export interface SessionState {
  id: string;
  title: string;
  time: number;
  duration: number;
  playing: boolean;
  speed: number;
  q: number[];
  q_dot: number[];
  energy: number;
  energy_drift: number;
  position_violation: number;
  velocity_violation: number;
  steps: number;
  rejected: number;
  evaluations: number;
  factorizations: number;
  finished: boolean;
  /** How often the scene was changed since the session began. */
  changes: number;
  /** How forces are drawn in every picture. */
  drawing: Drawing;
  /** The hand's spring, while a body is pulled. */
  pull?: Pull | null;
  error?: Problem | null;
  /** What the engine found or corrected in the scene. */
  notes?: string[];
  bodies: BodyFrame[];
  /** Empty for scenes of many joints. */
  forces: JointForce[];
  gravity: Vec3;
  /** Where to ask for more; `self` is the address of what is seen, a session or a lecture room. */
  links: { self: string; stream: string };
}

/** How forces are drawn: one scale for the whole scene. */
export interface Drawing {
  on: "i" | "j";
  about: "joint" | "center";
  drawn: ServerDrawn;
  /** The joint that is marked in the 3-D view. */
  marked: string | null;
  /** Length of a force's arrow, m/N. */
  force_scale: number;
  /** Radius of a moment's circle, m/(N m). */
  moment_scale: number;
  /** The longest arrow, m. */
  longest: number;
  camera: Camera;
}

export type ServerDrawn = "none" | "all" | { joint: string } | { body: string };
export type Camera = "corner" | "front" | "side" | "above";

/** What followers of a lecture are told beside the run. */
export interface Board {
  code: string;
  title: string | null;
  source: { lesson: string } | { builtin: string } | { scene: string } | null;
  view: unknown;
  question: RoomQuestion | null;
}

export interface RoomQuestion {
  number: number;
  text: string;
  choices: string[];
  result?: Tally;
}

export interface Tally {
  number: number;
  counts: number[];
  right: number | null;
  revealed: boolean;
}

/** A symmetric matrix: what stands on and below its diagonal. */
export interface Symmetric {
  time: number;
  names: string[];
  places: [number, number, number, "own" | "constant" | "changing" | "fill"][];
  fill: number;
}

/** Something of an imported robot that could not be carried over. */
export interface LeftOut {
  line: number;
  of: string;
  what: string;
}

export interface Jacobian {
  rows: string[];
  columns: string[];
  /** [row, column, value, constant] */
  entries: [number, number, number, boolean][];
  time: number;
  rank: number;
  /** Rows of which some say again what others say. */
  redundant: { rows: number[]; dependent: number }[];
}

export interface JointMultipliers {
  joint: string;
  rows: { label: string; value: number }[];
  force_on_j: Vec3;
  moment_on_j: Vec3;
  /** The point that the moment is taken about, world, m. */
  at: Vec3;
  /** The body that force and moment act on. */
  on: string;
  /** The body at the other side of the joint. */
  by: string;
  expressed_in: string;
}

/** A spring from a point of a body to a place in the world. */
export interface Pull {
  body: string;
  /** From the centre of mass along the principal axes, m. */
  point: Vec3;
  to: Vec3;
  stiffness?: number | null;
}

/** One component of a force or moment. */
export interface Component {
  value: number;
  /** Whether the equations of motion determine it. */
  unique: boolean;
}

export interface Reaction {
  joint: string;
  driver: boolean;
  on: string;
  by: string;
  /** The point that the moment is taken about, in words. */
  about: string;
  about_at: Vec3;
  expressed_in: string;
  /** Axes of the components, in the world. */
  axes: [Vec3, Vec3, Vec3];
  force: [Component, Component, Component];
  moment: [Component, Component, Component];
}

export interface Reactions {
  time: number;
  reactions: Reaction[];
  redundancies: {
    rows: number;
    joints: string[];
    remedies: { joint: string; becomes: string; gives_up: string }[];
  }[];
}

export interface CheckReport {
  bodies: number;
  coordinates: number;
  rows: number;
  rank: number;
  degrees_of_freedom: number;
  redundant: { joint: string; rows: string[] }[];
  notes: string[];
}

export type Answer =
  | { value: string; unit?: string }
  | { value: string | string[] | string[][]; unit?: string }
  | { file: string }
  | { settings: { integrator: string; tolerance: string; baumgarte?: [string, string] } }
  | { choice: string };

export type VerdictKind = "right" | "wrong" | "blank" | "invalid";

export interface QuestionVerdict {
  id: string;
  earned: number;
  possible: number;
  verdict: VerdictKind;
  message_html: string;
  /** A picture that the grader drew. */
  figure_svg?: string;
  /** The right answer and its source, where the author opens it. */
  reference_html?: string;
}

export interface Verdict {
  /** Null where nothing was graded, hence nothing stored. */
  id: string | null;
  lesson: string;
  student: string;
  submitted_at: string;
  earned: number;
  possible: number;
  passed: boolean;
  gradable: boolean;
  questions: QuestionVerdict[];
  provenance?: { engine?: string; lesson_hash?: string };
}

/** application/problem+json (RFC 9457) with the members that Triad adds. */
export interface Problem {
  type?: string;
  title: string;
  status?: number;
  detail?: string;
  code?: string;
  hint?: string;
  errors?: { pointer?: string; detail: string }[];
  trace_id?: string;
}
