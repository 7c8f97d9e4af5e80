"""Dynamics of spatial mechanisms in fully Cartesian coordinates.

>>> import triad
>>> r = triad.run("n-four-bar:2", until=1)
>>> r.t.shape, r.body("crank-1").position.shape
((101,), (101, 3))

Scenes: a built-in name (``triad.scenes()``), a file, JSON text or a dict (``triad.scene``).
Running: ``run`` gives a ``Run``; ``sweep`` many runs at once.
Equations: ``System`` has Φ, Φ_q, ν, γ, M and g at any state, to check one's own program against.
Analyses: ``check``, ``equilibrium``, ``modes``, ``kinematics``, ``assemble``.
Grading: ``lessons``, ``grade``.

SI units, radians, right-handed axes. Errors are ``TriadError``: its text says what, where and what to try.
"""

from ._analyses import assemble, check, equilibrium, kinematics, modes, scene, scene_schema, scenes
from ._grade import grade, lessons
from ._native import VERSION as __version__
from ._native import TriadError
from ._run import BodyMotion, Errors, Reactions, Run, run
from ._scene import Scene
from ._sweep import Sweep, grid, normal, sweep, uniform
from ._system import System

__all__ = [
    "BodyMotion",
    "Errors",
    "Reactions",
    "Run",
    "Scene",
    "Sweep",
    "System",
    "TriadError",
    "__version__",
    "assemble",
    "check",
    "equilibrium",
    "grade",
    "grid",
    "kinematics",
    "lessons",
    "modes",
    "normal",
    "run",
    "scene",
    "scene_schema",
    "scenes",
    "sweep",
    "uniform",
]
