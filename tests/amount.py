"""How much the tests try: `make test` a share of the examples of each property, and the same ones each time;
`make test-all` all of them, and others each time, and `AIDL_EXAMPLES=20 pytest …` twenty times as many.
"""

from __future__ import annotations

import os
from typing import Any

from hypothesis import HealthCheck, settings

_SHARE = 0.15
_LEAST = 2
"""Examples of any property: the first that Hypothesis tries is the smallest there is, and shows little."""

_TIMES = os.environ.get("AIDL_EXAMPLES")
TRIES_ALL = _TIMES is not None
"""Whether this run tries all there is to try."""


def tried(count: int) -> int:
    """Returns how many examples of `count` this run tries."""
    return (
        round(count * float(_TIMES)) if _TIMES is not None else max(min(count, _LEAST), round(count * _SHARE))
    )


def large(size: int) -> int:
    """Returns how large something is made that is `size` where all is tried."""
    return size if TRIES_ALL else round(size * _SHARE)


def tries(count: int, **more: Any) -> settings:
    """Settings of a property of which `count` examples are tried where all are."""
    return settings(max_examples=tried(count), **more)


settings.register_profile(
    "aidl",
    max_examples=tried(100),
    derandomize=not TRIES_ALL,
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("aidl")
