"""Grading answers as the workbench does it."""

from __future__ import annotations

import json
import os
import re
import unicodedata
from collections.abc import Mapping
from typing import Any, Optional, Union

from . import _native

Answer = Union[str, float, int, list[Any], Mapping[str, Any]]
# Characters that names are spoofed with: the workbench takes them out as well.
_INVISIBLE = re.compile("[\u00ad\u061c\u200b-\u200f\u202a-\u202e\u2060-\u206f\ufeff]")


def lessons(course: Optional[Union[str, os.PathLike[str]]] = None) -> list[dict[str, Any]]:
    """The lessons of a course: slug, title, and the ids of the questions. Without a folder those of the built-in course."""
    found: list[dict[str, Any]] = json.loads(_native.lessons(_folder(course)))
    return found


def grade(
    lesson: str,
    answers: Mapping[str, Answer],
    *,
    student: Optional[str] = None,
    course: Optional[Union[str, os.PathLike[str]]] = None,
) -> dict[str, Any]:
    """The verdict on answers to a lesson: ``passed``, ``earned`` of ``possible`` points, and each question's message.

    answers  by the ids of questions: a number or text, or a dict such as {"value": "29.4", "unit": "N"}, {"choice": "a"}
             or {"file": text}
    student  whose numbers the questions are about; without one, those that everybody sees
    course   the folder of a course; without one, the built-in course
    """
    submission: dict[str, Any] = {"answers": {name: _answer(answer) for name, answer in answers.items()}}
    if student is not None:
        plain = _INVISIBLE.sub("", unicodedata.normalize("NFC", student))
        submission["student"] = " ".join(plain.split())
    found: dict[str, Any] = json.loads(_native.grade(_folder(course), lesson, json.dumps(submission)))
    return found


def _answer(answer: Answer) -> Any:
    plain = answer.tolist() if hasattr(answer, "tolist") else answer
    return dict(plain) if isinstance(plain, Mapping) else {"value": plain}


def _folder(course: Optional[Union[str, os.PathLike[str]]]) -> Optional[str]:
    return None if course is None else os.fspath(course)
