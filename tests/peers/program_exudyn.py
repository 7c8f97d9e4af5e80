"""Exudyn: kinematic trees in minimal coordinates with its explicit solvers; loops of planar bodies with its implicit ones.

The steps are taken by its compiled solvers; `SolveSteps` alone is timed.
"""

import time

import exudyn as exu
import numpy as np
from exudyn import itemInterface as item
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

EXPLICIT = {"RK44", "RK67", "DOPRI5", "DVERK6", "ODE23"}


def tree(mbs, gravity, links, reference, rates):
    """A kinematic tree of single joints in a row; links are (joint, offset, mass, centre, inertia about the joint)."""
    node = mbs.AddNode(
        item.NodeGenericODE2(
            numberOfODE2Coordinates=len(links),
            referenceCoordinates=reference,
            initialCoordinates=[0.0] * len(links),
            initialCoordinates_t=rates,
        )
    )
    kinds = {"x": exu.JointType.RevoluteX, "y": exu.JointType.RevoluteY, "z": exu.JointType.RevoluteZ}
    turns, offsets, inertias, centres = exu.Matrix3DList(), exu.Vector3DList(), exu.Matrix3DList(), exu.Vector3DList()
    for _, offset, _, centre, inertia in links:
        turns.Append(np.eye(3))
        offsets.Append(offset)
        inertias.Append(np.array(inertia, dtype=float))
        centres.Append(centre)
    return mbs.AddObject(
        item.ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=[kinds[link[0]] for link in links],
            linkParents=[k - 1 for k in range(len(links))],
            jointTransformations=turns,
            jointOffsets=offsets,
            linkInertiasCOM=inertias,
            linkCOMs=centres,
            linkMasses=[link[2] for link in links],
            gravity=gravity,
        )
    )


def pendulum(mbs, _):
    """A01: one revolute joint."""
    link = ("z", [0, 0, 0], 1.0, [-1, 0, 0], np.zeros((3, 3)))
    body = tree(mbs, [0, -GRAVITY, 0], [link], [0.0], [0.0])
    return [(body, 0, [-1, 0, 0])]


def top(mbs, _):
    """Euler's angles z-x-z, which stay regular here."""
    none = (0.0, [0, 0, 0], np.zeros((3, 3)))
    disc = (1.0, [0, 0, TOP_HEIGHT], np.diag([TOP_ACROSS, TOP_ACROSS, TOP_AXIAL]))
    links = [("z", [0, 0, 0], *none), ("x", [0, 0, 0], *none), ("z", [0, 0, 0], *disc)]
    body = tree(mbs, [0, 0, -GRAVITY], links, [0.0, TOP_TILT, 0.0], [0.0, 0.0, TOP_SPIN])
    return [(body, 2, [0, 0, TOP_HEIGHT]), (body, 2, [TOP_RADIUS, 0, TOP_HEIGHT])]


def chain(mbs, rods):
    """Three revolute joints for each ball, z-y-x."""
    none = (0.0, [0, 0, 0], np.zeros((3, 3)))
    links, rates = [], []
    for i, (x, y, z) in enumerate(relative_rates(rods)):
        links += [("z", [float(i > 0), 0, 0], *none), ("y", [0, 0, 0], *none)]
        links.append(("x", [0, 0, 0], 1.0, [0.5, 0, 0], np.diag([AXIAL, ACROSS, ACROSS])))
        rates += [z, y, x]
    body = tree(mbs, [0, 0, -GRAVITY], links, [0.0] * len(links), rates)
    return [(body, 3 * i + 2, [1, 0, 0]) for i in range(rods)]


def four_bar(mbs, windows):
    """A02 with planar bodies and planar revolute joints: nothing is redundant."""
    ground = mbs.AddObject(item.ObjectGround())

    def rod(x, y, turn, rate, velocity):
        node = mbs.AddNode(
            item.NodeRigidBody2D(
                referenceCoordinates=[x, y, turn], initialCoordinates=[0, 0, 0], initialVelocities=[velocity, 0, rate]
            )
        )
        body = mbs.AddObject(item.ObjectRigidBody2D(nodeNumber=node, physicsMass=1.0, physicsInertia=1 / 12))
        mass = mbs.AddMarker(item.MarkerBodyMass(bodyNumber=body))
        mbs.AddLoad(item.LoadMassProportional(markerNumber=mass, loadVector=[0, -GRAVITY, 0]))
        return body

    def pin(a, place_a, b, place_b):
        markers = [
            mbs.AddMarker(item.MarkerBodyPosition(bodyNumber=body, localPosition=place))
            for body, place in ((a, place_a), (b, place_b))
        ]
        mbs.AddObject(item.ObjectJointRevolute2D(markerNumbers=markers))

    low, high = [-0.5, 0, 0], [0.5, 0, 0]
    uprights = [rod(i, 0.5, np.pi / 2, -1.0, 0.5) for i in range(windows + 1)]
    for i, upright in enumerate(uprights):
        pin(ground, [i, 0, 0], upright, low)
    for i in range(windows):
        coupler = rod(i + 0.5, 1.0, 0.0, 0.0, 1.0)
        pin(uprights[i], high, coupler, low)
        pin(coupler, high, uprights[i + 1], high)
    return [(uprights[0], None, high)]


KINDS = {"pendulum": pendulum, "four-bar": four_bar, "chain": chain, "top": top}


class Run:
    """A system with its settings: `solver`, and `rate` (steps a second) or `tolerance`; for implicit ones `radius`."""

    def __init__(self, problem, setting):
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        points = KINDS[problem.kind](self.mbs, problem.size)
        self.sensors = [self.sensor(*point) for point in points]
        self.mbs.Assemble()
        self.problem, self.setting = problem, setting
        self.explicit = setting["solver"] in EXPLICIT

    def sensor(self, body, link, place):
        """Records a point in memory."""
        common = {"localPosition": place, "storeInternal": True, "writeToFile": False}
        kind = exu.OutputVariableType.Position
        if link is None:
            return self.mbs.AddSensor(item.SensorBody(bodyNumber=body, outputVariableType=kind, **common))
        sensor = item.SensorKinematicTree(objectNumber=body, linkNumber=link, outputVariableType=kind, **common)
        return self.mbs.AddSensor(sensor)

    def settings(self, record):
        """Exudyn's settings for this run."""
        s = exu.SimulationSettings()
        time_settings, duration = s.timeIntegration, self.problem.duration
        time_settings.endTime = duration
        time_settings.verboseMode = 0
        s.solutionSettings.writeSolutionToFile = False
        s.solutionSettings.solutionWritePeriod = duration
        s.solutionSettings.sensorsWritePeriod = 0.01 if record else duration
        s.solutionSettings.sensorsStoreAndWriteFiles = record
        s.parallel.numberOfThreads = 1
        if "tolerance" in self.setting:
            time_settings.automaticStepSize = True
            time_settings.numberOfSteps = 100 * duration
            time_settings.initialStepSize = 1e-3
            time_settings.absoluteTolerance = time_settings.relativeTolerance = float(self.setting["tolerance"])
            # The largest step is endTime/numberOfSteps.
            time_settings.numberOfSteps = 4 * duration
        else:
            time_settings.automaticStepSize = False
            time_settings.numberOfSteps = int(self.setting["rate"]) * duration
        if self.explicit:
            time_settings.explicitIntegration.dynamicSolverType = getattr(
                exu.DynamicSolverType, self.setting["solver"]
            )
            time_settings.explicitIntegration.computeEndOfStepAccelerations = False
        else:
            time_settings.generalizedAlpha.spectralRadius = float(self.setting["radius"])
            time_settings.generalizedAlpha.useIndex2Constraints = self.setting["solver"] == "index2"
            time_settings.generalizedAlpha.useNewmark = self.setting["solver"] == "index2"
            time_settings.newton.useModifiedNewton = True
            time_settings.newton.relativeTolerance = 1e-10
            time_settings.newton.absoluteTolerance = 1e-12
            s.linearSolverType = exu.LinearSolverType.EigenSparse if len(self.sensors) > 20 else exu.LinearSolverType.EXUdense
        return s

    def solve(self, record):
        """Solves from the start; returns the seconds of the steps alone."""
        solver = exu.MainSolverExplicit() if self.explicit else exu.MainSolverImplicitSecondOrder()
        settings = self.settings(record)
        if not solver.InitializeSolver(self.mbs, settings):
            raise RuntimeError("the solver could not start")
        begin = time.process_time()
        done = solver.SolveSteps(self.mbs, settings)
        elapsed = time.process_time() - begin
        solver.FinalizeSolver(self.mbs, settings)
        if not done:
            raise RuntimeError(f"the solver stopped at {solver.it.currentTime:.3f} s")
        return elapsed

    def timed(self):
        """Processor seconds for the whole run."""
        return self.solve(record=False)

    def sampled(self):
        """Times and points."""
        self.solve(record=True)
        data = [self.mbs.GetSensorStoredData(sensor) for sensor in self.sensors]
        return data[0][:, 0], np.stack([table[:, 1:4] for table in data], axis=1)


prepare = Run
