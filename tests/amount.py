"""How much the tests try: `make test` a share of the examples of each property, the same ones each time, and
one in six cases of a corpus; `make test-all` all of them, and other examples each time, and
`AIDL_EXAMPLES=20 pytest …` twenty times as many.
"""

from __future__ import annotations

import os
from typing import Any, TypeVar

import pytest
from hypothesis import HealthCheck, settings

T = TypeVar("T")
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


def some(cases: list[T], one_in: int = 4) -> list[T]:
    """Returns the cases that this run tries."""
    return cases if TRIES_ALL else cases[::one_in]


def large(size: int) -> int:
    """Returns how large something is made that is `size` where all is tried."""
    return size if TRIES_ALL else round(size * _SHARE)


def tries(count: int, **more: Any) -> settings:
    """Settings of a property of which `count` examples are tried where all are."""
    return settings(max_examples=tried(count), **more)


_MANY, _ONE_IN = 12, 6
_CORPORA = (
    *(f"tests/{room}/" for room in ("checker", "drawings", "export", "geometry")),
    *(f"tests/property/test_{name}.py" for name in ("constraints", "operations", "paths", "shapes")),
    "tests/resolve/",
    "server/tests/ide/",
    "tests/solver/",
    "tests/test_freedom.py",
    "tests/test_measured.py",
    "dev/tests/",
    "eval/tests/",
)
"""What is tried in shares; specs, pages, commands and what keeps users safe are tried whole on every run."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Marks all but one in six cases as slow, of a test of a corpus that has many."""
    families: dict[str, list[pytest.Item]] = {}
    for item in items:
        if item.nodeid.startswith(_CORPORA) and item.get_closest_marker("slow") is None:
            families.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for cases in families.values():
        if len(cases) > _MANY:
            for number, case in enumerate(cases):
                if number % _ONE_IN:
                    case.add_marker(pytest.mark.slow)


settings.register_profile(
    "aidl",
    max_examples=tried(100),
    derandomize=not TRIES_ALL,
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("aidl")
