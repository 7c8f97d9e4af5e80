"""Columns that are looked up by their names, as a dict's values are."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray


class Columns(ABC):
    """``r["energy"]`` is a column, ``"energy" in r`` says whether there is one, ``for name in r`` goes over their names."""

    @abstractmethod
    def keys(self) -> list[str]:
        """The names of the columns."""

    @abstractmethod
    def __getitem__(self, column: str) -> NDArray[np.float64]: ...

    def __contains__(self, column: object) -> bool:
        return column in self.keys()

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())
