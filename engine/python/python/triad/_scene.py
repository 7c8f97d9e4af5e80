"""Which scene is meant."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Union

from ._json import as_json, finite

Scene = Union[str, "os.PathLike[str]", Mapping[str, Any]]
"""A built-in scene's name, a file, the JSON of a scene, or the same as a dict."""


def named(scene: Scene) -> tuple[str, str]:
    """How the native part is told: the kind of the name, and the name or text."""
    if isinstance(scene, Mapping):
        return "json", as_json(scene)
    if isinstance(scene, os.PathLike):
        return "path", os.fspath(scene)
    if not isinstance(scene, str):
        raise TypeError(f"a scene is a name, a path, JSON text or a dict, not {type(scene).__name__}")
    return ("json", finite(scene)) if scene.lstrip().startswith("{") else ("name", scene)
