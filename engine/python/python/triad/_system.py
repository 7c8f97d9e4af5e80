"""The equations of a mechanism at any state, as matrices."""

from __future__ import annotations

import json
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, Optional, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._errors import refusal
from ._options import number, text
from ._scene import Scene, named

if TYPE_CHECKING:
    from scipy.sparse import csr_array

Floats = NDArray[np.float64]


class System:
    """M(q) q̈ + Φ_qᵀ λ = g,  Φ_q q̈ = γ of a scene, in its generalized coordinates, rigid-body rows first.

    ``rows`` and ``columns`` name the rows of Φ and the coordinates. ``q0`` and ``v0`` are the start, assembled: moved onto
    the constraints if it had to be (``notes`` say so). States that satisfy no constraint are evaluated as well.
    """

    def __init__(self, scene: Scene, *, coordinates: Optional[Literal["full", "reduced", "shared"]] = None) -> None:
        kind, given = named(scene)
        # The text itself: a file may be another one by the time the system is pickled.
        self._scene = given if kind == "json" else _native.scene_json(kind, given)
        if coordinates is not None:
            text("coordinates", coordinates)
        self._coordinates = coordinates
        self._system = _native.System(kind, given, self._coordinates)
        about = json.loads(self._system.about())
        self.name: str = about["name"]
        self.columns: list[str] = about["columns"]
        self.rows: list[str] = about["rows"]
        self.bodies: list[str] = about["bodies"]
        self.rigid_rows: int = about["rigid_rows"]
        self.notes: list[str] = about["notes"]
        self.q0: Floats = self._system.q0()
        self.v0: Floats = self._system.v0()

    def phi(self, q: ArrayLike, t: float = 0.0) -> Floats:
        """Φ(q, t) of all rows. Whole turns of joint angles, which q does not tell, are those with which screws, drivers and gears
        hold best; where none tells them, those of the start."""
        return self._system.phi(_numbers("q", q), number("t", t))

    @overload
    def jacobian(self, q: ArrayLike, t: float = 0.0, *, sparse: Literal[False] = False) -> Floats: ...
    @overload
    def jacobian(self, q: ArrayLike, t: float = 0.0, *, sparse: Literal[True]) -> csr_array: ...
    def jacobian(self, q: ArrayLike, t: float = 0.0, *, sparse: bool = False) -> Union[Floats, csr_array]:
        """Φ_q(q, t): rows by coordinates; with ``sparse`` as a SciPy array, which keeps places that are zero by chance."""
        return _matrix(self._system.jacobian(_numbers("q", q), number("t", t)), sparse)

    def nu(self, q: ArrayLike, v: ArrayLike, t: float = 0.0) -> Floats:
        """ν, the rates that drivers prescribe: Φ_q q̇ = ν. Zero without drivers."""
        return self._system.nu(_numbers("q", q), _numbers("v", v), number("t", t))

    def gamma(self, q: ArrayLike, v: ArrayLike, t: float = 0.0) -> Floats:
        """γ, with Φ_q q̈ = γ."""
        return self._system.gamma(_numbers("q", q), _numbers("v", v), number("t", t))

    @overload
    def mass(self, q: Optional[ArrayLike] = None, *, sparse: Literal[False] = False) -> Floats: ...
    @overload
    def mass(self, q: Optional[ArrayLike] = None, *, sparse: Literal[True]) -> csr_array: ...
    def mass(self, q: Optional[ArrayLike] = None, *, sparse: bool = False) -> Union[Floats, csr_array]:
        """M(q): constant and diagonal for full bodies; of reduced ones it depends on q, that of the start if none is given."""
        return _matrix(self._system.mass(_numbers("q", self.q0 if q is None else q)), sparse)

    def force(self, q: ArrayLike, v: ArrayLike, t: float = 0.0) -> Floats:
        """g: gravity, springs and all other loads, and the velocity terms of reduced bodies. Without dry friction."""
        return self._system.force(_numbers("q", q), _numbers("v", v), number("t", t))

    def solve(self, q: ArrayLike, v: ArrayLike, t: float = 0.0) -> tuple[Floats, Floats]:
        """q̈ and λ of all rows, solved as one dense system; λ of least norm where rows are redundant."""
        return self._system.solve(_numbers("q", q), _numbers("v", v), number("t", t))

    def natural(self, q: ArrayLike) -> Floats:
        """r, u, v, w of each body: (bodies, 12), also where coordinates are reduced or shared."""
        return self._system.natural(_numbers("q", q))

    def __reduce__(self) -> tuple[Any, ...]:
        parts = {name: part for name, part in self.__dict__.items() if name != "_system"}
        return partial(System, coordinates=self._coordinates), (self._scene,), parts

    def __repr__(self) -> str:
        return f"<triad.System of {self.name}: {len(self.bodies)} bodies, {len(self.columns)} coordinates, {len(self.rows)} rows>"


def _numbers(name: str, given: ArrayLike) -> Floats:
    """Real numbers; how many they must be, and that they are finite, the native part knows."""
    try:
        found = np.asarray(given)
        if not np.iscomplexobj(found):
            return np.ascontiguousarray(found, dtype=np.float64).reshape(-1)
    except (TypeError, ValueError):
        pass
    raise refusal("not-understood", f"{name} is {given!r}", f"give {name} a list or an array of real numbers")


def _matrix(parts: Any, sparse: bool) -> Any:
    rows, columns, numbers, shape = parts
    if sparse:
        from scipy.sparse import csr_array

        return csr_array((numbers, (rows, columns)), shape=shape)
    matrix = np.zeros(shape)
    matrix[rows, columns] = numbers
    return matrix
