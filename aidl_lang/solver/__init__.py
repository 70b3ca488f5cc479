"""The constraint solver: `solve(problem) -> Solution`. It knows nothing of the language.

In the order of reading: `expression` (operations, and the tape), `problem`; `valuation`, `freezing` (some
rows, on numbers); `array_program` (many rows, on arrays); `linear`, `sparse`; `newton` (one smooth system),
`branches` (one attempt); `loosening` (what is free when, who gives way), `group` (one structure), `levels`
(all groups of a depth), `hierarchy` (`solve`); `refuting`, `conflicts` (and what is asked besides). What is
said of a solution afterwards is in `analysis`. What stands here is loaded when asked for: a program is
checked without the solver and without numpy.
"""

from __future__ import annotations

from enum import Enum
from importlib import import_module
from typing import TYPE_CHECKING, Any

from aidl_lang.common.records import record

if TYPE_CHECKING:
    from aidl_lang.solver.hierarchy import Memory, solve
    from aidl_lang.solver.problem import Constraint, Problem, Relation, Row, Solution, Status

__all__ = ["Constraint", "Memory", "Problem", "Relation", "Row", "Settings", "Solution", "Status", "solve"]

_HOME = {"Memory": "hierarchy", "solve": "hierarchy"}


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(f"{__name__}.{_HOME.get(name, 'problem')}"), name)
    return found


class Stages(Enum):
    """The stages at which unknowns become free (see `loosening`). All but the first are for comparison."""

    FULL = "full"
    PAPER = "paper"
    """Own geometry; then, level by level, translations; then, level by level, all else. No size is kept."""
    LEVEL = "level"
    """Translations of what lies deeper have no preference to its geometry."""
    FLAT = "flat"
    """One system of all constraints, in which everything is free at once."""


@record()
class Settings:
    """Limits that keep any problem from running away.

    tolerance   residual at which a row counts as satisfied, relative to its scale
    iterations  Newton steps per attempt
    branches    re-choices of `min`/`max` branches per stage
    stages      what becomes free when
    pruning     whether a branch of `min`, `max`, `abs`, `select` is chosen before each search (see
                `freezing`); without it a search follows them as they bend, for comparison
    together    whether all groups of a depth may be solved at once (see `levels`); for comparison, too
    seconds     wall clock for the whole solve; reaching it ends with status `failed` and `timed_out`
    """

    tolerance: float = 1e-9
    iterations: int = 60
    branches: int = 12
    seconds: float = 20.0
    stages: Stages = Stages.FULL
    pruning: bool = True
    together: bool = True
    explain: bool = True
