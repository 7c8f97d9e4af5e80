"""Errors of the Python part, with the same attributes as those of the compiled one."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from numbers import Real
from typing import Any

from ._native import TriadError


def refusal(code: str, what: str, hint: str) -> TriadError:
    """An error with its stable code, a sentence and a remedy."""
    error = TriadError(f"{what} [{code}]\n  try: {hint}")
    error.code, error.what, error.hint, error.pointer, error.partial = code, what, hint, None, None
    return error


def place(what: str, name: str, known: Sequence[str]) -> int:
    """Where a name is in a list."""
    if name in known:
        return known.index(name)
    near = difflib.get_close_matches(name, known, 3)
    hint = f"did you mean {' or '.join(near)}?" if near else f"there are {', '.join(known)}"
    raise refusal(f"unknown-{what}", f"there is no {what} {name!r}", hint)


def word(what: str, given: Any, known: Sequence[str]) -> str:
    """One of a few words."""
    if isinstance(given, str) and given in known:
        return given
    raise refusal(f"unknown-{what}", f"there is no {what} {given!r}", f"give {', '.join(known[:-1])} or {known[-1]}")


def finite(options: Mapping[str, Any]) -> None:
    """Refuses options that are no finite numbers."""
    for name, value in options.items():
        if isinstance(value, Real) and not math.isfinite(value):
            raise refusal("not-finite", f"{name} is {value}", f"give {name} a finite number, or leave it out")
