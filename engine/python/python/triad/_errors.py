"""Errors of the Python part, with the same attributes as those of the compiled one."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from typing import Any, Optional

from ._native import TriadError


def refusal(code: str, what: str, hint: str, pointer: Optional[str] = None) -> TriadError:
    """An error with its stable code, a sentence, a remedy, and the place in the scene if it has one."""
    at = f"\n  at {pointer}" if pointer else ""
    error = TriadError(f"{what} [{code}]{at}\n  try: {hint}")
    error.code, error.what, error.hint, error.pointer, error.partial = code, what, hint, pointer, None
    return error


def place(what: str, name: object, known: Sequence[str]) -> int:
    """Where a name is in a list."""
    if isinstance(name, str) and name in known:
        return known.index(name)
    near = difflib.get_close_matches(name, known, 3) if isinstance(name, str) else []
    hint = f"did you mean {' or '.join(near)}?" if near else f"there are {', '.join(known)}" if known else "the scene has none"
    raise refusal(f"unknown-{what}", f"there is no {what} {name!r}", hint)


def word(what: str, given: Any, known: Sequence[str]) -> str:
    """One of a few words."""
    if isinstance(given, str) and given in known:
        return given
    raise refusal(f"unknown-{what}", f"there is no {what} {given!r}", f"give {', '.join(known[:-1])} or {known[-1]}")
