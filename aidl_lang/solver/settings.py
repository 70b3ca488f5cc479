"""The limits of the solver."""

from __future__ import annotations

from enum import Enum

from aidl_lang.common.records import record


class Stages(Enum):
    """The stages at which unknowns become free (see `tiers`). All but the first are for comparison."""

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
