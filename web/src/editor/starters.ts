// Texts with which a scene of one's own may begin: as short as they can be, to be written on.

const gravity = [0, -9.81, 0];
const rod = (name: string, x: number): object => ({
  name,
  mass: 1,
  inertia: { principal: [0.001, 0.083, 0.083] },
  position: [x, 0, 0],
  shape: [{ kind: "rod", from: [-0.5, 0, 0], to: [0.5, 0, 0], radius: 0.03 }],
});
const hinge = (name: string, bodies: [string, string], i: number[], j: number[]): object => ({
  type: "revolute",
  name,
  body_i: bodies[0],
  point_i: i,
  axis_i: [0, 0, 1],
  body_j: bodies[1],
  point_j: j,
  axis_j: [0, 0, 1],
});

/** One body, thrown up and turning: after a second it is back. */
export const ONE_BODY: object = {
  name: "one-body",
  gravity,
  bodies: [
    {
      name: "body",
      mass: 1,
      inertia: { principal: [0.01, 0.02, 0.03] },
      velocity: [0, 4.905, 0],
      angular_velocity: [1, 0, 2],
      shape: [{ kind: "box", center: [0, 0, 0], size: [0.4, 0.3, 0.1] }],
    },
  ],
  simulation: { duration: 1 },
};

/** Two rods on two hinges. */
export const TWO_BODIES: object = {
  name: "two-bodies",
  gravity,
  bodies: [rod("upper", 0.5), rod("lower", 1.5)],
  joints: [
    hinge("shoulder", ["ground", "upper"], [0, 0, 0], [-0.5, 0, 0]),
    hinge("elbow", ["upper", "lower"], [0.5, 0, 0], [-0.5, 0, 0]),
  ],
  simulation: { duration: 5 },
};
