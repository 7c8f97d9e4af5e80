"""Options: of which kind each is. What is of another kind is refused with the option's name."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from numbers import Integral, Real
from typing import Any

from ._errors import refusal
from ._json import plain
from ._native import TriadError


def checked(options: Mapping[str, Any]) -> dict[str, Any]:
    """The options that are given, as Python's own numbers, texts and lists."""
    return {name: _KINDS[name](name, given) for name, given in options.items() if given is not None}


def number(name: str, given: Any) -> float:
    """A finite number, NumPy's as well."""
    value = plain(given)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise _wrong_kind(name, given, "a number")
    if not math.isfinite(value):
        raise refusal("not-finite", f"{name} is {value}", f"give {name} a finite number, or leave it out")
    return float(value)


def seconds(name: str, given: Any) -> float:
    """A time that may be used up: a number above zero."""
    found = number(name, given)
    if found <= 0:
        what = f"{name} is {found:g}, and must be above 0, as nothing is computed in no time"
        raise refusal("out-of-range", what, f"give {name} a number of seconds, or leave it out")
    return found


def whole(name: str, given: Any) -> int:
    """A whole number from zero on."""
    value = plain(given)
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise _wrong_kind(name, given, "a whole number")
    if value < 0:
        raise refusal("out-of-range", f"{name} is {value}", f"give {name} a whole number that is not negative")
    return int(value)


def truth(name: str, given: Any) -> bool:
    """Yes or no."""
    value = plain(given)
    if not isinstance(value, bool):
        raise _wrong_kind(name, given, "True or False")
    return value


def text(name: str, given: Any) -> str:
    """A text."""
    if not isinstance(given, str):
        raise _wrong_kind(name, given, "a text")
    return str(given)


def texts(name: str, given: Any) -> list[str]:
    """A list of texts; one text is a list of it, not of its letters."""
    if isinstance(given, str):
        return [given]
    found = list(given) if isinstance(given, Iterable) else [given]
    if not all(isinstance(part, str) for part in found):
        raise _wrong_kind(name, given, "a text or a list of them")
    return [str(part) for part in found]


def called(name: str, given: Any) -> Any:
    """A function."""
    if not callable(given):
        raise _wrong_kind(name, given, "a function")
    return given


def _wrong_kind(name: str, given: Any, wanted: str) -> TriadError:
    return refusal("not-understood", f"{name} is {given!r}, of type {type(given).__name__}", f"give {name} {wanted}")


_KINDS: dict[str, Callable[[str, Any], Any]] = {
    "until": number,
    "every": number,
    "tolerance": number,
    "integrator": text,
    "treatment": text,
    "step": number,
    "coordinates": text,
    "outputs": texts,
    "no_skip": texts,
    "estimate": truth,
    "verify": truth,
    "most_steps": whole,
    "most_seconds": seconds,
    "samples": whole,
    "seed": whole,
    "threads": whole,
    "progress": called,
}
