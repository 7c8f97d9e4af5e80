"""Grading answers as the workbench does it."""

from __future__ import annotations

import json
import os
import re
import unicodedata
from collections.abc import Mapping
from typing import Any, Optional, Union

from . import _native
from ._errors import refusal
from ._json import as_json, plain
from ._options import text

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
    if not isinstance(answers, Mapping):
        what = f"answers is {answers!r}, of type {type(answers).__name__}"
        raise refusal("not-understood", what, 'give a dict by the ids of questions, such as {"tension": 29.4}')
    submission: dict[str, Any] = {"answers": {name: _answer(answer) for name, answer in answers.items()}}
    if student is not None:
        visible = _INVISIBLE.sub("", unicodedata.normalize("NFC", text("student", student)))
        submission["student"] = " ".join(visible.split())
    found: dict[str, Any] = json.loads(_native.grade(_folder(course), text("lesson", lesson), as_json(submission)))
    return found


def _answer(answer: Answer) -> Any:
    value = plain(answer)
    return dict(value) if isinstance(value, Mapping) else {"value": value}


def _folder(course: Optional[Union[str, os.PathLike[str]]]) -> Optional[str]:
    return None if course is None else os.fspath(course)
