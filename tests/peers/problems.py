"""What is computed: six mechanisms, by the same numbers for every program."""

import math
from dataclasses import dataclass

import reference

GRAVITY = 9.81
RADIUS = 0.05
"""Radius of the chain's rods, m."""
AXIAL = RADIUS**2 / 2
ACROSS = (3 * RADIUS**2 + 1) / 12
"""Moments of the chain's rods about their centre, kg m²."""

TOP_HEIGHT, TOP_RADIUS, TOP_SPIN, TOP_TILT = 0.2, 0.15, 60.0, math.pi / 3
TOP_AXIAL, TOP_ACROSS = TOP_RADIUS**2 / 2, TOP_RADIUS**2 / 4
"""The heavy top of 1 kg; moments about its centre, kg m²."""


@dataclass(frozen=True)
class Problem:
    """A mechanism, how long it runs, and what is compared."""

    name: str
    scene: str
    kind: str
    size: int
    duration: int
    compared: str

    def reference(self):
        """Points at multiples of `reference.GRID`, and their largest difference from steps twice as long."""
        match self.kind:
            case "pendulum":
                return reference.pendulum(self.duration)
            case "four-bar":
                return reference.four_bar(self.size, self.duration)
            case "chain":
                return reference.chain(self.size, self.duration)
            case _:
                return reference.Top().reference(self.duration)


PROBLEMS = {
    problem.name: problem
    for problem in [
        Problem("pendulum", "simple-pendulum", "pendulum", 1, 10, "the bob"),
        Problem("four-bar-2", "n-four-bar:2", "four-bar", 2, 10, "the tip B0"),
        Problem("four-bar-10", "n-four-bar:10", "four-bar", 10, 10, "the tip B0"),
        Problem("four-bar-40", "n-four-bar:40", "four-bar", 40, 10, "the tip B0"),
        Problem("chain-10", "spatial-chain:10", "chain", 10, 2, "the far ends of all rods"),
        Problem("chain-100", "spatial-chain:100", "chain", 100, 2, "the far ends of all rods"),
        Problem("top", "heavy-top", "top", 1, 5, "the centre of the disc and a point of its rim"),
    ]
}


def chain_start(rods):
    """Directions of the chain's rods of 1 m and 1 kg at the start, their rates, and the spin about them, rad/s."""
    import numpy as np

    phase = np.arange(1, rods + 1)
    rates = np.stack([0 * phase, 0.8 * np.sin(phase), -0.4 * np.cos(phase)], axis=1)
    return np.tile([1.0, 0.0, 0.0], (rods, 1)), rates, 1.0


def relative_rates(rods):
    """Angular velocities at the start of each rod of the chain against the one before, rad/s."""
    absolute = [(0.0, 0.0, 0.0)] + [(1.0, 0.4 * math.cos(i), 0.8 * math.sin(i)) for i in range(1, rods + 1)]
    return [tuple(b - a for a, b in zip(*pair, strict=True)) for pair in zip(absolute, absolute[1:])]
