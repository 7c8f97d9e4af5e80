"""Scenes, and analyses other than running."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any, Literal, Union

from . import _native
from ._conventions import Frame, Point, Side, convention
from ._options import text, texts
from ._scene import Scene, named


def scenes() -> dict[str, str]:
    """The built-in scenes: names, with ``:N`` where a number belongs, and what each is."""
    return dict(_native.scenes())


def scene(of: Scene) -> dict[str, Any]:
    """A scene as a dict, to change and to run: ``s = triad.scene("n-four-bar:2"); s["gravity"] = [0, -1.62, 0]``."""
    found: dict[str, Any] = json.loads(_native.scene_json(*named(of)))
    return found


def scene_schema() -> dict[str, Any]:
    """The JSON Schema of scenes."""
    found: dict[str, Any] = json.loads(_native.scene_schema())
    return found


def check(of: Scene) -> dict[str, Any]:
    """What a scene amounts to: bodies, coordinates, rows, rank, degrees of freedom, redundant rows by joint."""
    found: dict[str, Any] = json.loads(_native.check(*named(of)))
    return found


def equilibrium(of: Scene) -> dict[str, Any]:
    """The position of rest near the start, whether it is stable, and the reactions there: as ``triad equilibrium --json``."""
    return _analysis("equilibrium", of)


def modes(of: Scene, *, about: Literal["equilibrium", "start", "steady"] = "equilibrium") -> dict[str, Any]:
    """Frequencies and shapes of small vibrations: as ``triad modes --json``."""
    return _analysis("modes", of, text("about", about))


def assemble(of: Scene, *, keep: Union[str, Iterable[str]] = ()) -> dict[str, Any]:
    """Where the bodies of a roughly placed scene are once its joints are closed; bodies to ``keep`` stay."""
    return _analysis("assemble", of, keep=keep)


def kinematics(
    of: Scene,
    *,
    side: Side = "j",
    point: Point = "joint-point",
    frame: Frame = "world",
) -> dict[str, Any]:
    """The motion that drivers prescribe, and the forces that it takes: as ``triad kinematics --json``."""
    return _analysis("kinematics", of, convention(side, point, frame))


def _analysis(which: str, of: Scene, at: str = "", keep: Union[str, Iterable[str]] = ()) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(_native.analyse(which, *named(of), at, texts("keep", keep)))
    return found
