"""Scenes and answers as JSON, whose numbers may be NumPy's."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from typing import Any

from ._errors import refusal


def as_json(value: Mapping[str, Any]) -> str:
    """The text of JSON, with finite numbers only."""
    return finite(json.dumps(value, default=_known))


def plain(given: Any) -> Any:
    """Numbers and arrays of NumPy as Python has them."""
    return given.tolist() if hasattr(given, "tolist") else given


def _known(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return plain(value)
    raise TypeError(f"a {type(value).__name__} is neither a number, a text nor a list of them")


def finite(text: str) -> str:
    """A text of JSON, which has no words for what is no finite number, though Python writes them."""
    if not any(word in text for word in ("NaN", "Infinity")):
        return text
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        return text  # Whoever reads it says where it is wrong.
    for pointer, found in _not_finite("", value):
        raise refusal("not-finite", f"{found} is no finite number", "look where it was computed", pointer)
    return text


def _not_finite(pointer: str, value: Any) -> Iterator[tuple[str, float]]:
    """Places whose number is not finite."""
    if isinstance(value, float) and not math.isfinite(value):
        yield pointer, value
    parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for name, part in parts:
        yield from _not_finite(f"{pointer}/{str(name).replace('~', '~0').replace('/', '~1')}", part)
