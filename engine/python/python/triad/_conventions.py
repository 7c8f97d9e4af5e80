"""On which body, about which point and along which axes reactions are told."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, Literal, Union

import numpy as np

from ._errors import refusal, word

Side = Literal["i", "j"]
Point = Union[Literal["joint-point", "center-of-mass", "origin"], Sequence[float]]
Frame = Literal["world", "joint", "body"]


def convention(side: Side, point: Point, frame: Frame) -> str:
    """These three, as the native part is told."""
    return json.dumps(
        {
            "on": word("side", side, ("j", "i")),
            "about": _about(point),
            "expressed_in": word("frame", frame, ("world", "joint", "body")),
        }
    )


def _about(point: Point) -> Any:
    words_known = ("joint-point", "center-of-mass", "origin")
    if isinstance(point, str):
        known = word("point", point, (*words_known, "three numbers in the world"))
        return {"world-point": [0.0, 0.0, 0.0]} if known == "origin" else known
    try:
        at = [float(x) for x in point]
    except (TypeError, ValueError):
        at = []
    if len(at) != 3 or not np.isfinite(at).all():
        raise refusal("unknown-point", f"{point!r} is no point", f"give {', '.join(words_known)} or three numbers in the world, m")
    return {"world-point": at}
