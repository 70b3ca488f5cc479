"""Values that are worked out when somebody asks for them."""

from __future__ import annotations

import atexit
from collections.abc import Callable
from typing import Any, Generic, TypeVar
from weakref import WeakSet

T = TypeVar("T")


class Later(Generic[T]):
    """A function that works a value out when it is first called, or copied. `work` is dropped then, and what
    is left of it when the process ends: the kernel of areas complains about those that outlive it.
    """

    def __init__(self, work: Callable[[], T] | None, known: T | None = None) -> None:
        self._work, self.known = work, known
        _waiting.add(self)

    def __call__(self) -> T:
        if (work := self._work) is not None:  # two threads may both do it
            self.known = work()
            self._work = None
        return self.known  # type: ignore[return-value]

    def __getstate__(self) -> dict[str, object]:
        return {"known": self(), "_work": None}


_waiting: WeakSet[Later[Any]] = WeakSet()
atexit.register(lambda: [vars(each).update(_work=None) for each in _waiting])
