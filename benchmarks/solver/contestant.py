"""What the benchmark asks of a solver."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

from benchmarks.solver.sketch import Sketch


class UnsupportedError(Exception):
    """A type of constraint that a solver has no equivalent of."""


class Contestant(ABC):
    """One solver. `build` and `solve` are timed apart; every call starts from nothing.

    Raises ImportError when made, if the solver is not installed.
    """

    version: ClassVar[str]

    @abstractmethod
    def build(self, sketch: Sketch) -> Any:
        """The sketch as the solver wants it. Raises `UnsupportedError`."""

    @abstractmethod
    def solve(self, built: Any) -> str:
        """Solves; says in a word what the solver thinks of its result."""

    @abstractmethod
    def read(self, built: Any) -> list[float]:
        """The values of the unknowns, in the order of the sketch."""

    def analyse(self, built: Any) -> bool:
        """Counts degrees of freedom after solving; False for a solver that does not, or already has."""
        return False
