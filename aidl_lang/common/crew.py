"""Many calls under way at once: on processes of this machine, or on the workers of a cluster."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Hashable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import replace
from importlib.util import find_spec
from typing import Any, Generic, TypeVar

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.names import nearest
from aidl_lang.common.processes import Engine, Guarded, Limit, LimitError, limit_met
from aidl_lang.common.prose import did_you_mean
from aidl_lang.common.records import record
from aidl_lang.common.resources import package

# --- Many calls at a time on one engine: those that are done are handed over as they come, and one whose
# process dies, or of which nothing is heard, is given once more when there is nothing else to do.

K = TypeVar("K", bound=Hashable)
T = TypeVar("T")

_LIVES = 4
"""How often a call may begin that ends its process: others may take the memory, or somebody ends it."""
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
        """Returns the calls that are done, once there are some or the time is up. Raises EngineError."""
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
    return replace(call, deaths=deaths, losses=losses)


# --- Calls on a cluster: a scheduler of Dask and its workers, which come and go.
#
# Each worker carries a call out in a guarded process of its own, so that limits of time and memory hold as
# they do on one machine: one that hangs takes up a place for as long as it may and no longer. Nothing is
# assumed of a worker but the same package, which every call is compared with.

PROTOCOLS = ("tcp", "tls", "ws", "wss")
_CONNECTING = 15.0
"""Seconds for the first connection."""
_RECONNECTING = 60.0
"""Seconds that a scheduler may be away, as while it is started anew."""
_KNOWN_FOR = 2.0
"""Seconds for which the number of places is believed."""
_LOOKING = 0.5
"""Seconds after which it is looked whether the scheduler is there."""


class Cluster:
    """The workers of a scheduler, as an `Engine`."""

    def __init__(self, address: str, preload: str) -> None:
        """Connects to a scheduler at an address such as `tcp://host:8786`; `preload` is the module that
        guarded processes load at the start. Raises AidlError.
        """
        protocol, mark, rest = address.partition("://")
        if not mark or protocol not in PROTOCOLS or not rest:
            hints = did_you_mean(f"{near}://{rest}" for near in nearest(protocol, PROTOCOLS)[:1] if rest)
            there = "there is `local`, and the scheduler of a cluster, as in `tcp://127.0.0.1:8786`"
            raise AidlError(Diagnostic("E0976", f"there is no engine `{address}`", hints=(*hints, there)))
        if find_spec("distributed") is None:
            message = "a cluster needs a package that is not installed"
            raise AidlError(Diagnostic("E0913", message, hints=("pip install 'aidl-lang[cluster]'",)))
        from distributed import Client

        self.address, self._preload = address, preload
        try:
            client: Any = Client  # which has no types
            self._client = client(address, timeout=_CONNECTING, set_as_default=False)
        except (OSError, ValueError, TypeError, RuntimeError) as error:
            hint = "a scheduler is begun by `dask scheduler`, workers by `dask worker ADDRESS`"
            message = f"no scheduler answers at `{address}`: {_short(error)}"
            raise AidlError(Diagnostic("E0976", message, hints=(hint,))) from None
        self._client._timeout = _RECONNECTING
        self._places, self._asked = 0, 0.0
        self._lock = threading.Lock()
        self._given: dict[Any, Future[Any]] = {}
        self._is_closed = threading.Event()
        threading.Thread(target=self._watch, daemon=True).start()

    @property
    def places(self) -> int:
        """The number of calls that the present workers carry out side by side."""
        if time.monotonic() - self._asked > _KNOWN_FOR:
            self._asked = time.monotonic()
            try:
                self._places = sum(self._client.nthreads().values())
            except (OSError, RuntimeError, ValueError, AttributeError):
                self._places = 0  # it is away; calls are lost and given again, or told of
        return self._places

    def submit(self, seconds: float, task: Callable[..., T], *arguments: object) -> Future[T]:
        """Has a call carried out (see `Engine`)."""
        local: Future[T] = Future()
        if self._client.status == "closed":
            raise self._gone()
        remote = self._client.submit(
            carried, package(), self._preload, seconds, task, arguments, pure=False, retries=0
        )
        with self._lock:
            self._given[remote] = local
        remote.add_done_callback(self._hand_over)
        return local

    def _watch(self) -> None:
        """Ends all calls once the scheduler has been away for too long: the client tells nobody then."""
        while not self._is_closed.wait(_LOOKING):
            if self._client.status == "closed":
                with self._lock:
                    lost, self._given = list(self._given.values()), {}
                for local in lost:
                    if local.set_running_or_notify_cancel():
                        local.set_exception(self._gone())

    def _hand_over(self, remote: Any) -> None:
        """Passes what came of a call on; runs in a thread of the client."""
        with self._lock:
            local = self._given.pop(remote, None)
        if local is None or not local.set_running_or_notify_cancel():
            return
        try:
            kind, *found = remote.result(timeout=_RECONNECTING)
        except Exception as error:  # noqa: BLE001 (handed over, whatever it is)
            local.set_exception(self._error(remote, error))
            return
        finally:
            remote.release()
        if kind == "value":
            local.set_result(found[0])
        elif kind == "limit":
            local.set_exception(LimitError(found[0]))
        elif kind == "other":
            local.set_exception(_other(*found))
        else:
            local.set_exception(RuntimeError(": ".join(map(str, found))))

    def _error(self, remote: Any, error: Exception) -> Exception:
        from distributed.client import FutureCancelledError
        from distributed.scheduler import KilledWorker

        if isinstance(error, KilledWorker):
            return LimitError(Limit.DEATH)
        if isinstance(error, ModuleNotFoundError | ImportError | AttributeError):
            return _other("a worker", f"none that has it ({_short(error)})")
        if self._client.status == "closed":
            return self._gone()
        if isinstance(error, FutureCancelledError | OSError) or remote.status in ("cancelled", "lost"):
            return GoneError(str(error))
        return error

    def _gone(self) -> EngineError:
        message = (
            f"the scheduler at `{self.address}` is gone, and did not come back within {_RECONNECTING:g} s"
        )
        return EngineError(Diagnostic("E0978", message, hints=("what was done is kept; start it and go on",)))

    def close(self) -> None:
        """Gives up all calls that are not done, and leaves the cluster as it is."""
        self._is_closed.set()
        with self._lock:
            remote, self._given = list(self._given), {}
        try:
            if remote and self._client.status == "running":
                self._client.cancel(remote, force=True)
        except (OSError, RuntimeError):
            pass  # it is gone, and so are they
        finally:
            self._client.close(timeout=5)


def _other(worker: str, version: str) -> EngineError:
    message = f"{worker} has another package: {version}, and here is {package()}"
    hint = "install the same version of `aidl-lang` on all workers and start them anew"
    return EngineError(Diagnostic("E0977", message, hints=(hint,)))


def _short(error: BaseException) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0][:200]


# --- On the workers --------------------------------------------------------------------------------


_pools: dict[str, Guarded] = {}
_starting = threading.Lock()


def carried(
    wanted: str, preload: str, seconds: float, task: Callable[..., Any], arguments: tuple[object, ...]
) -> tuple[Any, ...]:
    """Carries out a call on a worker, in a guarded process; returns how it went as plain data."""
    from distributed import get_worker

    if package() != wanted:
        return "other", f"the worker at {get_worker().address}", package()
    try:
        return "value", _pool(preload, get_worker().state.nthreads).submit(seconds, task, *arguments).result()
    except Exception as error:  # noqa: BLE001 (handed over, whatever it is)
        limit = limit_met(error)
        return ("error", type(error).__name__, str(error)) if limit is None else ("limit", limit)


def _pool(preload: str, threads: int) -> Guarded:
    with _starting:
        if preload not in _pools:
            _pools[preload] = Guarded(threads, preload)
        return _pools[preload]
