"""The constraint solver: `solve(problem) -> Solution`. It knows nothing of the language.

In the order of reading: `operations`, `expression` (the tape), `problem`; `valuation`, `freezing` (some rows,
on numbers); `array_program` (many rows, on arrays); `linear`, `sparse`; `newton` (one smooth system),
`branches` (one attempt); `tiers` (what is free when), `loosening` (who gives way), `group` (one structure),
`levels` (all groups of a depth), `riding`, `hierarchy` (`solve`); `refuting`, `conflicts`. What is said of a
solution afterwards is in `analysis`. What stands at this door is loaded when it is asked for: who only checks
a program needs the limits of the solver (`settings`) and neither the solver nor numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from aidl_lang.solver.hierarchy import solve
    from aidl_lang.solver.problem import Constraint, Problem, Relation, Row, Solution, Status
    from aidl_lang.solver.riding import Memory
    from aidl_lang.solver.settings import Settings

__all__ = ["Constraint", "Memory", "Problem", "Relation", "Row", "Settings", "Solution", "Status", "solve"]

_HOME = {
    "Constraint": "problem",
    "Memory": "riding",
    "Problem": "problem",
    "Relation": "problem",
    "Row": "problem",
    "Settings": "settings",
    "Solution": "problem",
    "Status": "problem",
    "solve": "hierarchy",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    return found
