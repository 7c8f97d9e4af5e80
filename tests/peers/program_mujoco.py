"""MuJoCo: minimal coordinates; loops closed by its soft `connect` constraints; all steps in one call of `mj_step`."""

import time

import mujoco
import numpy as np
from problems import ACROSS, AXIAL, GRAVITY, TOP_ACROSS, TOP_AXIAL, TOP_HEIGHT, TOP_RADIUS, TOP_SPIN, relative_rates


def pendulum(_):
    """A01. A point mass must have some inertia here: 1e-12 kg m²."""
    bodies = """<body><joint type="hinge" axis="0 0 1"/>
      <inertial pos="-1 0 0" mass="1" diaginertia="1e-12 1e-12 1e-12"/><site pos="-1 0 0"/></body>"""
    return bodies, "", [0.0]


def four_bar(windows):
    """A02: each coupler hangs on the upright at its left and is connected to the one at its right."""
    rod = 'mass="1" diaginertia="0.08333333333333333 0.08333333333333333 0.08333333333333333"'
    bodies, loops, rates = [], [], []
    for i in range(windows + 1):
        site = '<site pos="0 1 0"/>' if i == 0 else ""
        coupler = ""
        if i < windows:
            coupler = f"""<body name="coupler{i}" pos="0 1 0"><joint type="hinge" axis="0 0 1"/>
                <inertial pos="0.5 0 0" {rod}/></body>"""
            loops.append(f'<connect body1="coupler{i}" body2="upright{i + 1}" anchor="1 0 0"/>')
        bodies.append(f"""<body name="upright{i}" pos="{i} 0 0"><joint type="hinge" axis="0 0 1"/>
            <inertial pos="0 0.5 0" {rod}/>{site}{coupler}</body>""")
        rates += [-1.0] + [1.0] * (i < windows)
    return "".join(bodies), "".join(loops), rates


def chain(rods):
    """Ball joints, body in body."""
    bodies = ""
    for i in reversed(range(rods)):
        bodies = f"""<body pos="{int(i > 0)} 0 0"><joint type="ball"/>
            <inertial pos="0.5 0 0" mass="1" diaginertia="{AXIAL!r} {ACROSS!r} {ACROSS!r}"/>
            <site pos="1 0 0"/>{bodies}</body>"""
    return bodies, "", [w for rates in relative_rates(rods) for w in rates]


def top(_):
    """A ball joint; MuJoCo's rates are in the body's frame, whose z is the axis."""
    bodies = f"""<body quat="0.8660254037844387 0.5 0 0"><joint type="ball"/>
        <inertial pos="0 0 {TOP_HEIGHT}" mass="1" diaginertia="{TOP_ACROSS!r} {TOP_ACROSS!r} {TOP_AXIAL!r}"/>
        <site pos="0 0 {TOP_HEIGHT}"/><site pos="{TOP_RADIUS} 0 {TOP_HEIGHT}"/></body>"""
    return bodies, "", [0.0, 0.0, TOP_SPIN]


KINDS = {"pendulum": pendulum, "four-bar": four_bar, "chain": chain, "top": top}


class Run:
    """A model with its settings: `integrator`, `rate` (steps a second); for loops `impedance` and `constant`.

    `constant` is the time constant of a loop's constraint in steps.
    """

    def __init__(self, problem, setting):
        bodies, loops, self.rates = KINDS[problem.kind](problem.size)
        rate = int(setting["rate"])
        gravity = f"0 -{GRAVITY} 0" if problem.kind in ("pendulum", "four-bar") else f"0 0 -{GRAVITY}"
        softness = ""
        if loops:
            d, constant = setting["impedance"], float(setting["constant"]) / rate
            softness = f'<default><equality solref="{constant!r} 1" solimp="{d} {d} 0.001 0.5 2"/></default>'
        flags = '<flag contact="disable"/>' if loops else '<flag constraint="disable"/>'
        self.model = mujoco.MjModel.from_xml_string(f"""<mujoco><compiler angle="radian"/>
            <option timestep="{1 / rate!r}" integrator="{setting["integrator"]}" gravity="{gravity}"
              solver="Newton" iterations="50" tolerance="1e-8">{flags}</option>{softness}
            <worldbody>{bodies}</worldbody><equality>{loops}</equality></mujoco>""")
        self.data = mujoco.MjData(self.model)
        self.steps, self.rate = problem.duration * rate, rate

    def start(self):
        """Back to the start."""
        mujoco.mj_resetData(self.model, self.data)
        self.data.qvel[:] = self.rates

    def timed(self):
        """Processor seconds for the whole run."""
        self.start()
        begin = time.process_time()
        mujoco.mj_step(self.model, self.data, nstep=self.steps)
        return time.process_time() - begin

    def sampled(self):
        """Times and points."""
        self.start()
        every = max(1, self.rate // 100)
        times, points = [0.0], [self.points()]
        for step in range(every, self.steps + 1, every):
            mujoco.mj_step(self.model, self.data, nstep=every)
            times.append(step / self.rate)
            points.append(self.points())
        return times, points

    def points(self):
        """The compared points now."""
        mujoco.mj_kinematics(self.model, self.data)
        return np.array(self.data.site_xpos)


prepare = Run
