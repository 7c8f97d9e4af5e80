"""Drake: `MultibodyPlant`; trees in continuous time with its error-controlled integrators.

Loops exist for it in two ways: ball constraints in discrete time (of first order), and stiff bushings in continuous time.
"""

import time

import numpy as np
from problems import (
    ACROSS,
    AXIAL,
    GRAVITY,
    TOP_ACROSS,
    TOP_AXIAL,
    TOP_HEIGHT,
    TOP_RADIUS,
    TOP_SPIN,
    TOP_TILT,
    relative_rates,
)
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix
from pydrake.multibody.plant import DiscreteContactApproximation, MultibodyPlant
from pydrake.multibody.tree import (
    BallRpyJoint,
    FixedOffsetFrame,
    LinearBushingRollPitchYaw,
    RevoluteJoint,
    SpatialInertia,
    UnitInertia,
)
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator


def inertia(centre, moments):
    """1 kg with principal moments about the centre of mass along the body's axes."""
    about_centre = UnitInertia(*moments)
    return SpatialInertia(1.0, centre, about_centre.ShiftFromCenterOfMass(centre))


def pendulum(plant, _, __):
    """A01."""
    bob = plant.AddRigidBody("bob", inertia([-1, 0, 0], [0, 0, 0]))
    plant.AddJoint(RevoluteJoint("pin", plant.world_frame(), bob.body_frame(), [0, 0, 1]))
    return [(bob, [-1, 0, 0])], [0.0], [0.0]


def four_bar(plant, windows, setting):
    """A02: each coupler hangs on the upright at its left; its right end is held at the tip of the next."""
    rod = [1 / 12] * 3
    rates, uprights, couplers = [], [], []
    for i in range(windows + 1):
        upright = plant.AddRigidBody(f"upright{i}", inertia([0, 0.5, 0], rod))
        place = RigidTransform([float(i), 0, 0])
        revolute(plant, f"A{i}", plant.world_body(), place, upright)
        uprights.append(upright)
        rates.append(-1.0)
        if i < windows:
            coupler = plant.AddRigidBody(f"coupler{i}", inertia([0.5, 0, 0], rod))
            revolute(plant, f"B{i}", upright, RigidTransform([0, 1, 0]), coupler)
            couplers.append(coupler)
            rates.append(1.0)
    for coupler, upright in zip(couplers, uprights[1:], strict=True):
        if plant.time_step() > 0:
            plant.AddBallConstraint(coupler, [1, 0, 0], upright, [0, 1, 0])
        else:
            ends = ((coupler, [1, 0, 0]), (upright, [0, 1, 0]))
            frames = [placed(plant, body, RigidTransform(place)) for body, place in ends]
            k = float(setting["stiffness"])
            d = 2 * np.sqrt(k)
            plant.AddForceElement(LinearBushingRollPitchYaw(*frames, np.zeros(3), np.zeros(3), [k] * 3, [d] * 3))
    return [(uprights[0], [0, 1, 0])], [0.0] * len(rates), rates


def placed(plant, body, place):
    """A frame fixed in a body."""
    return plant.AddFrame(FixedOffsetFrame(f"frame{plant.num_frames()}", body.body_frame(), place))


def revolute(plant, name, parent, place, child):
    """A hinge about z."""
    return plant.AddJoint(RevoluteJoint(name, placed(plant, parent, place), child.body_frame(), [0, 0, 1]))


def chain(plant, rods, _):
    """Ball joints with roll, pitch and yaw."""
    parent, points = plant.world_body(), []
    for i in range(rods):
        rod = plant.AddRigidBody(f"rod{i}", inertia([0.5, 0, 0], [AXIAL, ACROSS, ACROSS]))
        start = placed(plant, parent, RigidTransform([float(i > 0), 0, 0]))
        plant.AddJoint(BallRpyJoint(f"ball{i}", start, rod.body_frame()))
        points.append((rod, [1, 0, 0]))
        parent = rod
    return points, [0.0] * (3 * rods), [w for rates in relative_rates(rods) for w in rates]


def top(plant, _, __):
    """A ball joint whose roll is the spin: its x is the axis of the top, so that its pitch stays far from a right angle."""
    body = plant.AddRigidBody("top", inertia([0, 0, TOP_HEIGHT], [TOP_ACROSS, TOP_ACROSS, TOP_AXIAL]))
    # The joint's x, y, z are the body's z, x, y.
    axes = RotationMatrix(np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]], dtype=float))
    plant.AddJoint(BallRpyJoint("ball", plant.world_frame(), placed(plant, body, RigidTransform(axes))))
    turned = RotationMatrix.MakeXRotation(TOP_TILT)
    angles = RollPitchYaw(turned @ axes).vector()
    rates = turned.matrix() @ np.array([0, 0, TOP_SPIN])
    return [(body, [0, 0, TOP_HEIGHT]), (body, [TOP_RADIUS, 0, TOP_HEIGHT])], angles, rates


KINDS = {"pendulum": pendulum, "four-bar": four_bar, "chain": chain, "top": top}


class Run:
    """A plant with its settings.

    Continuous time: `integrator`, `accuracy`, and for loops `stiffness` in N/m. Discrete time: `rate` (steps a second).
    """

    def __init__(self, problem, setting):
        self.problem, self.setting = problem, setting
        self.discrete = "rate" in setting
        plant = MultibodyPlant(1 / int(setting["rate"]) if self.discrete else 0.0)
        if self.discrete:
            plant.set_discrete_contact_approximation(DiscreteContactApproximation.kSap)
        flat = problem.kind in ("pendulum", "four-bar")
        plant.mutable_gravity_field().set_gravity_vector([0, -GRAVITY, 0] if flat else [0, 0, -GRAVITY])
        self.compared, self.positions, self.rates = KINDS[problem.kind](plant, problem.size, setting)
        plant.Finalize()
        self.plant = plant

    def simulator(self):
        """A simulator at the start."""
        simulator = Simulator(self.plant)
        context = simulator.get_mutable_context()
        self.plant.SetPositions(context, self.positions)
        self.plant.SetVelocities(context, self.rates)
        if not self.discrete:
            integrator = ResetIntegratorFromFlags(simulator, self.setting["integrator"], 0.1)
            integrator.set_target_accuracy(float(self.setting["accuracy"]))
            integrator.set_requested_minimum_step_size(1e-9)
        simulator.Initialize()
        return simulator

    def timed(self):
        """Processor seconds for the whole run."""
        simulator = self.simulator()
        begin = time.process_time()
        simulator.AdvanceTo(self.problem.duration)
        return time.process_time() - begin

    def sampled(self):
        """Times and points, at Drake's own steps."""
        simulator = self.simulator()
        times, points = [], []

        def record(context):
            now = context.get_time()
            if not times or now > times[-1]:
                times.append(now)
                points.append(self.points(context))

        simulator.set_monitor(record)
        simulator.AdvanceTo(self.problem.duration)
        record(simulator.get_context())
        return times, points

    def points(self, context):
        """The compared points of a context."""
        plant = self.plant
        poses = [(plant.EvalBodyPoseInWorld(context, body), place) for body, place in self.compared]
        return [pose.multiply(place) for pose, place in poses]


prepare = Run
