"""The limits of the solver."""

from __future__ import annotations

from aidl_lang.common.records import record


@record()
class Settings:
    """Limits that keep any problem from running away.

    tolerance   residual at which a row counts as satisfied, relative to its scale
    iterations  Newton steps per attempt
    branches    re-choices of `min`/`max` branches per stage
    seconds     wall clock for the whole solve; reaching it ends with status `failed` and `timed_out`
    """

    tolerance: float = 1e-9
    iterations: int = 60
    branches: int = 12
    seconds: float = 20.0
    explain: bool = True
