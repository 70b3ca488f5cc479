"""Many calls at a time on one engine: those that are done are handed over as they come, and one whose process
dies, or of which nothing is heard, is given once more when there is nothing else to do.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import replace
from typing import Generic, TypeVar

from aidl_lang.common.diagnostics import AidlError
from aidl_lang.common.processes import Engine, Limit, LimitError, limit_met
from aidl_lang.common.records import record

K = TypeVar("K", bound=Hashable)
T = TypeVar("T")

_LIVES = 4
"""How often a call may be begun that ends its process: another may have taken all the memory there is, or
somebody ended it.
"""
_AHEAD = 2
"""Calls that wait at the engine for each that is carried out, so that none of its places is idle."""
_STALLED = 5
"""After how many times what a call may take, if none is done by then, all are begun again."""
_RETURNS = 20
"""How often a call is given again because what carried it out is gone, by no fault of its own."""


class GoneError(Exception):
    """Raised in place of a result where the engine lost a call, as a cluster that was started anew does."""


class EngineError(AidlError):
    """Raised where the engine itself fails, so that no call can be carried out."""


@record()
class Broke:
    """A call without a result: the limit that it met, or the error that it raised."""

    limit: Limit | None
    error: BaseException


@record()
class _Call(Generic[K, T]):
    key: K
    seconds: float
    task: Callable[..., T]
    arguments: tuple[object, ...]
    deaths: int = 0
    losses: int = 0


class Crew(Generic[K, T]):
    """The calls that are under way on an engine, each under a key of its own."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._waiting: dict[Future[T], _Call[K, T]] = {}
        self._later: list[_Call[K, T]] = []
        self._heard = time.monotonic()
        self.given_again = 0
        """The calls that were begun once more."""

    def __len__(self) -> int:
        return len(self._waiting) + len(self._later)

    @property
    def has_room(self) -> bool:
        """Tells whether another call would be begun soon; who gives more only fills memory."""
        return len(self._waiting) < _AHEAD * max(1, self._engine.places)

    @property
    def running(self) -> list[K]:
        """The keys of the calls that are likely carried out now: those given first."""
        return [call.key for call in list(self._waiting.values())[: self._engine.places]]

    def give(self, key: K, seconds: float, task: Callable[..., T], *arguments: object) -> None:
        """Has a call carried out within some seconds."""
        if not self._waiting:
            self._heard = time.monotonic()
        self._begin(_Call(key, seconds, task, arguments))

    def _begin(self, call: _Call[K, T]) -> None:
        self._waiting[self._engine.submit(call.seconds, call.task, *call.arguments)] = call

    def came(self, timeout: float | None = None) -> list[tuple[K, T | Broke]]:
        """Returns the calls that are done, once there are some or after `timeout` seconds. Raises
        EngineError.
        """
        longest = _STALLED * max((call.seconds for call in self._waiting.values()), default=0.0)
        done, _ = wait(self._waiting, longest if timeout is None else timeout, FIRST_COMPLETED)
        if done or not self._engine.places:
            self._heard = time.monotonic()
        found = self._stirred() if time.monotonic() - self._heard >= longest else []
        for future in [each for each in self._waiting if each in done]:
            call = self._waiting.pop(future)
            try:
                found.append((call.key, future.result()))
            except EngineError:
                raise
            except Exception as error:  # noqa: BLE001 (handed over, whatever it is)
                if (again := _once_more(call, error)) is None:
                    found.append((call.key, Broke(limit_met(error), error)))
                else:
                    self._later.append(again)
        self._go_on()
        return found

    def _go_on(self) -> None:
        """Begins calls again where places would be idle: whatever ended their processes may be over then."""
        while self._later and len(self._waiting) < max(1, self._engine.places):
            self.given_again += 1
            self._begin(self._later.pop(0))

    def _stirred(self) -> list[tuple[K, T | Broke]]:
        """Begins all calls again; returns those that were begun too often."""
        calls = list(self._waiting.values())
        self._give_up()
        self._heard = time.monotonic()
        for call in calls:
            if call.deaths + 1 < _LIVES:
                self._later.append(replace(call, deaths=call.deaths + 1))
        over = LimitError(Limit.TIME)
        return [(call.key, Broke(over.limit, over)) for call in calls if call.deaths + 1 >= _LIVES]

    def cancel(self) -> None:
        """Gives up all calls that are under way."""
        self._give_up()
        self._later.clear()

    def _give_up(self) -> None:
        for future in self._waiting:
            future.cancel()
        self._waiting.clear()


def _once_more(call: _Call[K, T], error: BaseException) -> _Call[K, T] | None:
    """Returns a call that broke as it is to be begun again; None if it is not."""
    deaths = call.deaths + (limit_met(error) is Limit.DEATH)
    losses = call.losses + isinstance(error, GoneError)
    is_unlucky = (deaths > call.deaths and deaths < _LIVES) or (losses > call.losses and losses < _RETURNS)
    if not is_unlucky:
        return None
    return _Call(call.key, call.seconds, call.task, call.arguments, deaths, losses)
