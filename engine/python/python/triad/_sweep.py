"""Many runs of one scene with varied numbers."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from numbers import Real
from typing import TYPE_CHECKING, Any, Literal, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._columns import Columns
from ._errors import place, refusal
from ._options import checked, text
from ._scene import Scene, named

if TYPE_CHECKING:
    import pandas

Values = Union[tuple[Literal["grid"], float, float, int], tuple[Literal["uniform", "normal"], float, float]]


def grid(start: float, stop: float, count: int) -> Values:
    """Equally spaced values, both ends included. Grids of several numbers are crossed."""
    return ("grid", start, stop, count)


def uniform(low: float, high: float) -> Values:
    """Values drawn between two numbers."""
    return ("uniform", low, high)


def normal(mean: float, deviation: float) -> Values:
    """Values drawn from a normal distribution."""
    return ("normal", mean, deviation)


class Sweep(Columns):
    """The runs of a sweep, in the order of its plan: what each gave at its end. ``s["energy"]`` is a column, ``list(s)`` are their names.

    Sweeps are copied and pickled with their numbers; a pickled one has no pictures.
    """

    def __init__(self, found: _native.Sweep) -> None:
        self._found: Optional[_native.Sweep] = found
        about = json.loads(found.about())
        self.varied: list[str] = about["varied"]
        self.columns: list[str] = [name for name, _ in about["columns"]]
        self.units: dict[str, str] = dict(about["columns"])
        self.stopped: list[dict[str, Any]] = about["stopped"]
        """Runs that could not start or go on, each with its number, what was wrong and a hint."""
        self.values: NDArray[np.float64] = found.values()
        """The varied numbers: (runs, varied)."""
        self.outputs: NDArray[np.float64] = found.outputs()
        """The outputs at the end of each run: (runs, columns); nan where a run stopped."""
        self.times: NDArray[np.float64] = found.times()
        """When each run ended, s."""
        self.doubts: NDArray[np.int64] = np.array(found.doubts())
        """How many things speak against each result."""

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_found": None}

    def keys(self) -> list[str]:
        """The names of the columns: the varied numbers, then the outputs."""
        return [*self.varied, *self.columns]

    def __getitem__(self, column: str) -> NDArray[np.float64]:
        if column in self.varied:
            return self.values[:, self.varied.index(column)]
        return self.outputs[:, place("column", column, self.columns)]

    def __len__(self) -> int:
        return len(self.values)

    def to_pandas(self) -> pandas.DataFrame:
        """Varied numbers and outputs, one row for each run. Needs pandas: ``pip install pandas``."""
        import pandas

        return pandas.DataFrame(np.hstack([self.values, self.outputs]), columns=self.keys())

    def svg(self, column: Optional[str] = None) -> str:
        """An output over the first varied number, as SVG."""
        which = 0 if column is None else place("column", column, self.columns)
        if self._found is None:
            what = "this sweep was pickled: it has its numbers, and no pictures"
            raise refusal("sweep-without-engine", what, "take s.svg(...) before it is pickled, or draw s.to_pandas()")
        picture = self._found.svg(which)
        if picture is None:
            raise refusal("nothing-to-draw", "no run of this sweep came to a number that could be drawn", "s.stopped says why runs stopped")
        return picture

    def _repr_svg_(self) -> Optional[str]:
        return self._found.svg(0) if self._found else None

    def __repr__(self) -> str:
        failed = f", {len(self.stopped)} of them stopped" if self.stopped else ""
        return f"<triad.Sweep over {', '.join(self.varied)}: {len(self)} runs{failed}>"


def sweep(
    scene: Scene,
    vary: Mapping[str, Union[Values, Sequence[Any], NDArray[Any]]],
    *,
    samples: int = 1,
    seed: int = 1,
    threads: int = 0,
    until: Optional[float] = None,
    tolerance: Optional[float] = None,
    integrator: Optional[str] = None,
    estimate: Optional[bool] = None,
    outputs: Optional[Union[str, Iterable[str]]] = None,
    progress: Optional[Callable[[float, float], object]] = None,
) -> Sweep:
    """Runs a scene with varied numbers, on all cores. The results do not depend on the number of threads.

    vary      names of parameters of the scene, or JSON pointers such as "/bodies/0/mass", each with ``grid(1, 2, 11)``,
              ``uniform(1, 2)`` or ``normal(1, 0.1)``, or a list or array of values at equal distances. All places of a parameter
              follow its name, a pointer changes its place alone, and the ranges of parameters, which are for the page, bind no run
    samples   runs with drawn numbers at each point of the grids
    seed      where drawn numbers come from: the same seed gives the same runs
    threads   0 takes one for each core
    progress  called with (runs done, runs) some twenty times a second

    The other options are those of ``run``; estimated errors stand beside the outputs, unless ``estimate=False`` leaves them out. Ctrl-C
    ends the sweep.
    """
    options = {
        "until": until,
        "tolerance": tolerance,
        "integrator": integrator,
        "estimate": estimate,
        "outputs": outputs,
        "samples": samples,
        "seed": seed,
        "threads": threads,
        "progress": progress,
    }
    given = checked(options)
    plan = [given.pop(name, usual) for name, usual in (("samples", 1), ("seed", 1), ("threads", 0), ("progress", None))]
    return Sweep(_native.sweep(*named(scene), json.dumps(given), json.dumps(_varied(vary)), *plan))


def _varied(vary: Mapping[str, Union[Values, Sequence[Any], NDArray[Any]]]) -> list[tuple[str, dict[str, Any]]]:
    """How numbers vary, as the native part is told."""
    if not isinstance(vary, Mapping):
        hint = 'give a dict such as {"mass": triad.grid(1, 2, 11)}'
        raise refusal("vary", f"vary is {vary!r}, of type {type(vary).__name__}", hint)
    return [(text(f"the name {name!r} in vary", name), _values(name, values)) for name, values in vary.items()]


def _values(name: str, values: Union[Values, Sequence[Any], NDArray[Any]]) -> dict[str, Any]:
    if isinstance(values, (list, np.ndarray)):
        return _equally_spaced(name, values)
    parts = list(values) if isinstance(values, tuple) else []
    kind, numbers = parts[:1], parts[1:]
    known = all(isinstance(x, Real) and math.isfinite(x) for x in numbers)
    if known and len(numbers) == 2 and (kind == ["uniform"] or (kind == ["normal"] and numbers[1] >= 0)):
        return {kind[0]: [float(x) for x in numbers]}
    if known and len(numbers) == 3 and kind == ["grid"] and int(numbers[2]) == numbers[2] > 0:
        return {"grid": [float(numbers[0]), float(numbers[1]), int(numbers[2])]}
    raise refusal("vary", f"{name} cannot vary over {values!r}", "give grid(1, 2, 11), uniform(1, 2), normal(1, 0.1) or a list")


def _equally_spaced(name: str, values: Union[list[Any], NDArray[Any]]) -> dict[str, Any]:
    """The grid of a list or an array, such as ``np.linspace(1, 2, 11)``."""
    try:
        given = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        given = np.empty((0, 0))
    count = given.size
    if given.ndim != 1 or count == 0 or not np.allclose(given, np.linspace(given[0], given[-1], count), rtol=1e-12, atol=0.0):
        raise refusal("vary", f"{name} cannot vary over {values!r}", "give numbers at equal distances, or grid(1, 2, 11)")
    return {"grid": [float(given[0]), float(given[-1]), count]}
