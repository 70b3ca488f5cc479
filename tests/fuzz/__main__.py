"""`make fuzz MINUTES=2`: tries programs for so long, and ends with 1 if one of them broke something."""

from __future__ import annotations

import sys

from tests.fuzz.judge import finding
from tests.fuzz.running import Found, fuzz, options
from tests.fuzz.sources import program


def _found(kind: str, text: str, seed: int) -> Found | None:
    found = finding(text, seed)
    return found and (f"{found.stage}: {found.kind}", found.details)


if __name__ == "__main__":
    sys.exit(fuzz(options(__doc__).parse_args(), program, _found))
