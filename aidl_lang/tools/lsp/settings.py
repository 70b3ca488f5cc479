"""The user's settings, as the client has them under `aidl`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from aidl_lang.common.records import record

LONGEST_DELAY = 5_000


@record()
class Settings:
    """The settings of a user.

    solved_values  inlay hints for the solved values of first guesses
    readings       inlay hints for chosen readings of ambiguous constraints
    lenses         code lenses on structures
    delay          seconds after a change before the program is run
    """

    solved_values: bool = True
    readings: bool = True
    lenses: bool = True
    delay: float = 0.0

    @classmethod
    def read(cls, said: object) -> Settings:
        """Reads nested objects as `{"inlayHints": {"readings": false}}`; invalid values count as absent."""
        delay = _value(said, "run.delay")
        is_number = isinstance(delay, int | float) and not isinstance(delay, bool)
        return cls(
            solved_values=_value(said, "inlayHints.solvedValues") is not False,
            readings=_value(said, "inlayHints.readings") is not False,
            lenses=_value(said, "codeLens.enabled") is not False,
            delay=min(max(float(delay), 0.0), LONGEST_DELAY) / 1000 if is_number else 0.0,
        )


def _value(said: object, path: str) -> Any:
    for name in path.split("."):
        if not isinstance(said, Mapping):
            return None
        said = said.get(name)
    return said
