"""Which scene is meant."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from typing import Any, Union

Scene = Union[str, "os.PathLike[str]", Mapping[str, Any]]
"""A built-in scene's name, a file, the JSON of a scene, or the same as a dict."""


def named(scene: Scene) -> tuple[str, str]:
    """How the native part is told: the kind of the name, and the name or text."""
    if isinstance(scene, Mapping):
        return "json", json.dumps(scene, default=_plain)
    if isinstance(scene, os.PathLike):
        return "path", os.fspath(scene)
    if not isinstance(scene, str):
        raise TypeError(f"a scene is a name, a path, JSON text or a dict, not {type(scene).__name__}")
    return ("json", scene) if scene.lstrip().startswith("{") else ("name", scene)


def words(given: Union[None, str, Iterable[str]]) -> Union[None, list[str]]:
    """A list of words; one word is a list of it, not of its letters."""
    if given is None:
        return None
    return [given] if isinstance(given, str) else list(given)


def as_json(value: Mapping[str, Any]) -> str:
    """JSON of options whose numbers may be NumPy's."""
    return json.dumps(value, default=_plain)


def _plain(value: Any) -> Any:
    """Numbers and arrays of NumPy as JSON has them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a {type(value).__name__} is neither a number, a text nor a list of them")
