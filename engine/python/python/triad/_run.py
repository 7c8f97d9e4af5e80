"""Running a scene, and what a run gives."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._columns import Columns
from ._conventions import Frame, Point, Side, convention
from ._errors import place, refusal
from ._options import checked, text
from ._scene import Scene, named

if TYPE_CHECKING:
    import pandas

Floats = NDArray[np.float64]
Truths = NDArray[np.bool_]
Progress = Callable[[float, float], object]


def run(
    scene: Scene,
    *,
    until: Optional[float] = None,
    every: Optional[float] = None,
    tolerance: Optional[float] = None,
    integrator: Optional[str] = None,
    treatment: Optional[str] = None,
    step: Optional[float] = None,
    coordinates: Optional[str] = None,
    outputs: Optional[Union[str, Iterable[str]]] = None,
    no_skip: Union[str, Iterable[str]] = (),
    estimate: Optional[bool] = None,
    verify: bool = False,
    most_steps: Optional[int] = None,
    most_seconds: Optional[float] = None,
    progress: Optional[Progress] = None,
) -> Run:
    """Runs a scene from t = 0 to its end. Options that are left out are the scene's own; they are those of ``triad run``.

    until         end of the run, s
    every         time between outputs, s
    tolerance     of the integrator, relative and absolute
    integrator    auto, taylor, dop853, dopri5, ode45, radau, rattle
    treatment     what keeps the constraints: projection, baumgarte, partitioning, penalty, augmented-lagrangian
    step          size of the steps, s: fixed, instead of by the tolerance
    coordinates   of the bodies: full (12 each), reduced (9) or shared
    outputs       columns of the table, such as ["joints", "reactions:pin"]; see ``triad run --help``
    no_skip       what is computed although nothing depends on it; ["all"] for everything
    estimate      whether an estimate of the error is carried along
    verify        compare with a second solution: see ``Run.verified``
    most_steps    stop after so many steps of the integrator
    most_seconds  stop after so many seconds of computing
    progress      called with (t, end) some twenty times a second

    Ctrl-C ends the run. What was reached before it, and before an error, is the ``partial`` of the exception.
    """
    options = {
        "until": until,
        "every": every,
        "tolerance": tolerance,
        "integrator": integrator,
        "treatment": treatment,
        "step": step,
        "coordinates": coordinates,
        "outputs": outputs,
        "no_skip": no_skip,
        "estimate": estimate,
        "verify": verify,
        "most_steps": most_steps,
        "most_seconds": most_seconds,
        "progress": progress,
    }
    given = checked(options)
    compared, told = given.pop("verify", False), given.pop("progress", None)
    motion, stopped = _native.run(*named(scene), json.dumps(given), compared, told)
    found = Run(motion, whole=stopped is None)
    if stopped is not None:
        stopped.partial = found  # type: ignore[attr-defined]
        raise stopped
    return found


@dataclass(frozen=True, repr=False)
class BodyMotion:
    """One body over time: views of the run's arrays, in the world."""

    name: str
    position: Floats
    """Centre of mass, m: (n, 3)."""
    directors: Floats
    """Principal axes u, v, w: (n, 3, 3), one in each row."""
    velocity: Floats
    """Of the centre of mass, m/s: (n, 3)."""
    angular_velocity: Floats
    """Components in the world, rad/s: (n, 3)."""

    def point(self, u: float, v: float, w: float) -> Floats:
        """Where a point of the body is, given along its principal axes from the centre of mass, m: (n, 3)."""
        arm: Floats = np.einsum("k,nkx->nx", np.array([u, v, w]), self.directors)
        return self.position + arm

    def __repr__(self) -> str:
        return f"<triad.BodyMotion of {self.name}: position, directors, velocity, angular_velocity at {len(self.position)} times>"


@dataclass(frozen=True, repr=False)
class Errors:
    """Estimated errors, each the largest over all bodies; nan where they are not known."""

    position: Floats
    """Of centres of mass, m."""
    turn: Floats
    """Of directors, rad."""
    velocity: Floats
    """Of velocities of centres of mass, m/s."""
    angular_velocity: Floats
    """rad/s."""
    energy: Floats
    """J."""

    def __repr__(self) -> str:
        if np.isnan(self.position).all():
            return "<triad.Errors: not known>"
        return f"<triad.Errors: at most {np.nanmax(self.position):.1e} m, {np.nanmax(self.velocity):.1e} m/s>"


@dataclass(frozen=True, repr=False)
class Reactions:
    """What body ``by`` does to body ``on`` through a joint or driver, over time."""

    joint: str
    on: str
    by: str
    point: str
    """About which point moments are taken, in words."""
    frame: str
    """Along which axes the numbers are, in words."""
    t: Floats
    force: Floats
    """N: (n, 3)."""
    moment: Floats
    """N m: (n, 3)."""
    force_unique: Truths
    """Whether the equations of motion determine each number: (n, 3). Where they do not, it is that of the smallest multipliers."""
    moment_unique: Truths
    point_at: Floats
    """That point in the world, m: (n, 3)."""
    axes: Floats
    """The axes in the world: (n, 3, 3), one in each row."""
    force_error: Floats
    """Estimated error, N: the largest of all joints, with that of the axes; nan where it is not known, or reactions are not among the
    outputs."""
    moment_error: Floats
    """The same of moments, N m, with that of the point."""
    redundancies: list[dict[str, Any]]
    """Joints that share dependent rows, and what to relax, at the first output."""

    @property
    def unique(self) -> bool:
        """Whether all numbers are unique at all times."""
        return bool(self.force_unique.all() and self.moment_unique.all())

    def __repr__(self) -> str:
        largest = np.linalg.norm(self.force, axis=1).max(initial=0.0)
        unique = "unique" if self.unique else "not all unique"
        return f"<triad.Reactions of {self.joint}: {self.by} on {self.on}, at most {largest:.4g} N, {unique}>"


class Run(Columns):
    """A run: its numbers at all outputs, n of them, as NumPy arrays. ``r["pin.fx"]`` is a column of its table, ``list(r)`` their names.

    Runs are copied and pickled with their numbers. What was not asked for before (reactions, accelerations, pictures), a pickled
    one computes by running its scene again, as far as the run went to its end.
    """

    t: Floats
    """Times, s: (n,)."""
    q: Floats
    """Generalized coordinates: (n, coordinates); their names are in ``coordinates``."""
    v: Floats
    """Their rates."""
    position: Floats
    """Centres of mass, m: (n, bodies, 3)."""
    directors: Floats
    """Principal axes u, v, w in the world: (n, bodies, 3, 3), one in each row."""
    velocity: Floats
    """m/s: (n, bodies, 3)."""
    angular_velocity: Floats
    """rad/s, components in the world: (n, bodies, 3)."""
    marker_position: Floats
    """m: (n, markers, 3)."""
    marker_velocity: Floats
    """m/s: (n, markers, 3)."""
    table: Floats
    """The chosen outputs: (n, columns), the same numbers that ``triad run --out`` writes."""

    def __init__(self, motion: _native.Motion, *, whole: bool) -> None:
        self._engine: Optional[_native.Motion] = motion
        self._whole = whole
        about = json.loads(motion.about())
        self.scene: dict[str, Any] = about["scene"]
        self.bodies: list[str] = about["bodies"]
        self.joints: list[str] = about["joints"]
        self.drivers: list[str] = about["drivers"]
        self.markers: list[str] = about["markers"]
        self.coordinates: list[str] = about["coordinates"]
        self.columns: list[str] = [name for name, _ in about["columns"]]
        self.units: dict[str, str] = dict(about["columns"])
        self.conventions: list[str] = about["conventions"]
        self.rows: list[tuple[str, str]] = [(joint, label) for joint, label in about["multipliers"]]
        self.summary: dict[str, Any] = about["summary"]
        self.notes: list[str] = about["notes"]
        self.events: list[dict[str, Any]] = about["events"]
        self.verified: Optional[dict[str, Any]] = about["verified"]
        arrays: dict[str, Floats] = dict(motion.arrays() or ())
        errors = arrays.pop("errors")
        self.errors = Errors(*errors.T)
        self._reaction_errors = arrays.pop("reaction_errors")
        self.__dict__.update(arrays)

    @property
    def _motion(self) -> _native.Motion:
        """The engine's part, made again where the run came without it."""
        if self._engine is None:
            self._engine = self._again()
        return self._engine

    def _again(self) -> _native.Motion:
        """The same run, from its scene: to the same bits, or not at all."""
        if self._whole:
            motion, stopped = _native.run("json", json.dumps(self.scene), "{}", False, None)
            if isinstance(stopped, KeyboardInterrupt):
                raise stopped
            arrays = dict(motion.arrays() or ())
            if all(np.array_equal(arrays[name], getattr(self, name)) for name in ("t", "q", "v")):
                return motion
        raise refusal(
            "run-without-engine",
            "this run was pickled, and its scene does not give it again",
            "ask for reactions, accelerations and pictures before it is pickled, or run its scene again: triad.run(r.scene)",
        )

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_engine": None}

    def __copy__(self) -> Run:
        return self._with(self.__dict__)

    def __deepcopy__(self, memo: dict[int, Any]) -> Run:
        # The engine's part never changes: copies share it.
        memo[id(self._engine)] = self._engine
        return self._with(copy.deepcopy(self.__dict__, memo))

    def _with(self, parts: dict[str, Any]) -> Run:
        made = Run.__new__(Run)
        made.__dict__.update(parts)
        return made

    @property
    def energy(self) -> Floats:
        """Kinetic plus potential energy, J: (n,)."""
        return self["energy"]

    @property
    def doubts(self) -> list[str]:
        """What speaks against the result, in sentences; empty if nothing does."""
        found: list[str] = list(self.summary["doubts"])
        return found + (self.verified["doubts"] if self.verified else [])

    @cached_property
    def accelerations(self) -> Floats:
        """Second derivatives of the coordinates: (n, coordinates)."""
        return self._motion.accelerations()

    @cached_property
    def multipliers(self) -> Floats:
        """λ of the rows of joints and drivers, whose names are in ``rows``: (n, rows)."""
        return self._motion.multipliers()

    @cached_property
    def violations(self) -> Floats:
        """The largest |Φ|: (n,)."""
        return self._motion.violations()

    def body(self, name: str) -> BodyMotion:
        """One body: views, not copies."""
        k = place("body", name, self.bodies)
        at = (slice(None), k)
        return BodyMotion(name, self.position[at], self.directors[at], self.velocity[at], self.angular_velocity[at])

    def marker(self, name: str) -> Floats:
        """Positions of a marker, m: (n, 3)."""
        return self.marker_position[:, place("marker", name, self.markers)]

    def reactions(
        self, joint: str, *, side: Side = "j", point: Point = "joint-point", frame: Frame = "world"
    ) -> Reactions:
        """The reaction of a joint or driver: on body i or j of it, about a point, along the axes of a frame.

        side   "j" or "i": the body that it acts on
        point  "joint-point", "center-of-mass" of that body, "origin", or three numbers in the world, m
        frame  "world", "joint" (x along its axis), or "body" (the one that it acts on)
        """
        found = self._motion.reactions(text("joint", joint), convention(side, point, frame))
        force_error, moment_error = self._reaction_errors.T
        size = np.linalg.norm(found.force, axis=1)
        if not isinstance(point, str) or point != "joint-point":
            # What is off by how much where: the point by the bodies' errors, the force over the way from the joint to it.
            at_joint = self._motion.reactions(joint, convention(side, "joint-point", frame)).point_at
            away = np.linalg.norm(found.point_at - at_joint, axis=1)
            off = 2.0 * self.errors.position + away * self.errors.turn
            moment_error = moment_error + away * force_error + size * off
        if frame != "world":
            # The axes turn with the bodies.
            moment_error = moment_error + self.errors.turn * np.linalg.norm(found.moment, axis=1)
            force_error = force_error + self.errors.turn * size
        return Reactions(
            joint=joint,
            on=found.on,
            by=found.by,
            point=found.point,
            frame=found.frame,
            t=self.t,
            force=found.force,
            moment=found.moment,
            force_unique=found.force_unique,
            moment_unique=found.moment_unique,
            point_at=found.point_at,
            axes=found.axes,
            force_error=force_error,
            moment_error=moment_error,
            redundancies=json.loads(found.redundancies),
        )

    def to_pandas(self) -> pandas.DataFrame:
        """The table with the time as its index. Needs pandas: ``pip install pandas``."""
        import pandas

        return pandas.DataFrame(self.table, index=pandas.Index(self.t, name="t"), columns=self.columns)

    def svg(self, *, moving: bool = True) -> str:
        """The mechanism as an SVG that plays by itself, or as it is at the end."""
        return self._motion.svg(moving)

    def viewer(self, *, width: int = 800, height: int = 500) -> Any:
        """The motion in a notebook's viewer, to be turned by hand. Needs rerun: ``pip install 'rerun-sdk[notebook]==0.33.*'``."""
        from ._viewer import viewer

        return viewer(self, width, height)

    def keys(self) -> list[str]:
        """The names of the columns of the table."""
        return list(self.columns)

    def __getitem__(self, column: str) -> Floats:
        return self.table[:, place("column", column, self.columns)]

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        s = self.summary
        error = s.get("error")
        known = f", position within {error['position']:.1e} m" if error else ""
        doubts = f", {len(self.doubts)} doubts" if self.doubts else ""
        return (
            f"<triad.Run of {self.scene['name']}: {len(self)} outputs to t = {s['time']:g} s by {s['integrator']}, "
            f"{s['steps']} steps{known}{doubts}>"
        )

    def _repr_svg_(self) -> str:
        return self.svg()
