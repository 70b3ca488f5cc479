"""Processes for work that may hang, crash or devour memory without harm to anything else; and many calls at a
time, on such processes of this machine or on the workers of a cluster.
"""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import threading
import time
import traceback
from collections.abc import Callable, Hashable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import contextmanager, suppress
from dataclasses import replace
from enum import Enum
from importlib.util import find_spec
from multiprocessing import connection
from multiprocessing.reduction import ForkingPickler
from queue import SimpleQueue
from typing import Any, Generic, TypeAlias, TypeVar

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean
from aidl_lang.common.records import record
from aidl_lang.common.resources import package

T = TypeVar("T")
K = TypeVar("K", bound=Hashable)

MEMORY = 3_000_000_000
"""Bytes that a worker may use, on systems that can limit it."""

_STARTING = 60.0
"""Seconds that a process may take to start."""
_TRIALS = 20
"""How often a process is started for a call before it is told that none lives."""
_BETWEEN_SEARCHES = 50_000
"""Objects that a worker makes before it looks for cycles among them."""


class Limit(Enum):
    """The limit that a call met: that of time, the end of its process, or that of memory."""

    TIME = "time"
    DEATH = "death"
    MEMORY = "memory"


class LimitError(Exception):
    """Raised in place of the result of a call that met a limit, here or on a machine of a cluster."""

    def __init__(self, limit: Limit) -> None:
        super().__init__(limit)
        self.limit = limit


Engine: TypeAlias = "Guarded | Cluster"
"""Whatever carries out calls: the processes of this machine, or the workers of a cluster."""


class Guarded:
    """A pool of processes that carry out calls side by side, each within limits of time and memory. A process
    may die at any instant, and takes none but its own call along: it shares a pipe with one thread of this
    process and nothing with the others. It is replaced. `places` says how many there are.
    """

    def __init__(self, workers: int, preload: str | Sequence[str], memory: int = MEMORY) -> None:
        """Starts the processes; `preload` has the modules that they load at the start."""
        # `multiprocessing` lets a daemon have no children, lest they outlive it: these end with their parent.
        multiprocessing.current_process()._config["daemon"] = False  # type: ignore[attr-defined]
        self.places = workers
        self._calls: SimpleQueue[_Call | None] = SimpleQueue()
        context = prepared(preload)
        self._places = [_Place(self._calls, context, memory) for _ in range(workers)]
        for place in self._places:
            place.start()

    def submit(self, seconds: float, task: Callable[..., T], *arguments: object) -> Future[T]:
        """Has a picklable call carried out within some seconds; `limit_met` tells how it broke. Cancelling
        ends its process.
        """
        future: Future[T] = Future()
        self._calls.put((seconds, ForkingPickler.dumps((task, arguments)), future))
        return future

    def close(self) -> None:
        """Ends all processes, busy or not."""
        for place in self._places:
            place.close()
        for _ in self._places:
            self._calls.put(None)
        for place in self._places:
            place.join(_STARTING)


_Call: TypeAlias = tuple[float, memoryview, Future[Any]]
"""The seconds that a call has, the pickled task with its arguments, and what comes of it."""


class _Place(threading.Thread):
    """A thread that has one process at a time carry out calls, one after the other."""

    def __init__(
        self, calls: SimpleQueue[_Call | None], context: multiprocessing.context.BaseContext, memory: int
    ) -> None:
        super().__init__(daemon=True)
        self._calls, self._context, self._memory = calls, context, memory
        self._process: Any = None
        self._current: Future[Any] | None = None
        self._lock = threading.Lock()
        self._is_closed = False

    def run(self) -> None:
        with suppress(LimitError, RuntimeError):  # which a call would meet again
            self._begin()
        while (call := self._calls.get()) is not None:
            self._carry_out(*call)
        self._end()

    def close(self) -> None:
        """Ends the process, and begins no other."""
        self._is_closed = True
        with self._lock:
            self._kill()

    def _given_up(self, future: Future[Any]) -> None:
        with self._lock:
            if self._current is future:
                self._kill()

    def _carry_out(self, seconds: float, data: memoryview, future: Future[Any]) -> None:
        self._current = future
        # a call that is carried out may be cancelled until it is done
        future.add_done_callback(self._given_up)
        is_well, result = False, None
        try:
            is_well, result = self._answer(seconds, data, future)
        except Exception as error:  # noqa: BLE001 (handed over, whatever it is)
            result = error
        with self._lock:
            self._current = None
        if not future.set_running_or_notify_cancel():
            self._end()
        elif is_well:
            future.set_result(result)
        else:
            future.set_exception(result)

    def _answer(self, seconds: float, data: memoryview, future: Future[Any]) -> tuple[bool, Any]:
        """Returns whether a call ended well, and its result or its error. Raises LimitError."""
        for left in reversed(range(_TRIALS)):
            try:
                self._begin()
                with self._within(seconds):
                    if future.cancelled():
                        raise EOFError
                    self._channel.send_bytes(data)
                break
            except LimitError as error:  # the process was gone before it had the call
                if error.limit is Limit.TIME or not left or future.cancelled():
                    raise
        with self._within(seconds):
            answer = self._channel.recv_bytes()
        return ForkingPickler.loads(answer)  # type: ignore[no-any-return]

    def _begin(self) -> None:
        """Starts the process unless there is one, and waits until it is ready. Raises LimitError."""
        if self._is_closed:
            raise LimitError(Limit.DEATH)
        if self._process is not None:
            return
        self._channel, theirs = self._context.Pipe()
        process = self._context.Process(target=_serve, args=(theirs, self._memory), daemon=True)  # type: ignore[attr-defined]
        try:
            with _starting:
                process.start()
        except (OSError, EOFError) as error:
            self._channel.close()
            raise LimitError(Limit.DEATH) from error
        finally:
            theirs.close()
        self._process = process
        with self._within(_STARTING):
            self._channel.recv_bytes()

    @contextmanager
    def _within(self, seconds: float) -> Iterator[None]:
        """Ends the process when some seconds are over; raises LimitError if it ends in this time or then."""
        until = time.monotonic() + seconds
        watchdog = threading.Timer(seconds, self._process.kill)
        watchdog.daemon = True
        watchdog.start()
        try:
            yield
        except (OSError, EOFError) as error:
            self._end()
            raise LimitError(Limit.DEATH if time.monotonic() < until else Limit.TIME) from error
        finally:
            watchdog.cancel()

    def _kill(self) -> None:
        if (process := self._process) is not None:
            process.kill()

    def _end(self) -> None:
        if (process := self._process) is not None:
            self._process = None
            self._channel.close()
            process.kill()
            process.join(_STARTING)


_starting = threading.Lock()
"""Held by a thread that starts a process: `multiprocessing` is not made for several at a time."""


def prepared(preload: str | Sequence[str]) -> multiprocessing.context.BaseContext:
    """Returns how processes start that have loaded some modules; these load meanwhile."""
    if not hasattr(os, "fork"):
        return multiprocessing.get_context("spawn")
    from multiprocessing import forkserver

    context = multiprocessing.get_context("forkserver")  # of a process with the language and no threads
    context.set_forkserver_preload([preload] if isinstance(preload, str) else list(preload))
    forkserver.ensure_running()
    return context


def limit_met(error: BaseException) -> Limit | None:
    """Returns the limit that broke a call; None if the call raised the error by itself."""
    if isinstance(error, LimitError):
        return error.limit
    return Limit.MEMORY if isinstance(error, MemoryError) else None


def count() -> int:
    """Returns the number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0)) or 1
    return os.cpu_count() or 1


def _serve(channel: connection.Connection, memory: int) -> None:
    """Carries out the calls that come through a pipe, in a process of its own, until the pipe is closed."""
    _prepare(memory)
    channel.send_bytes(b"")
    while True:
        try:
            data = channel.recv_bytes()
        except EOFError:
            return
        channel.send_bytes(_outcome(data))


def _outcome(data: bytes) -> memoryview:
    """Returns pickled whether a call ended well, and its result or its error."""
    try:
        task, arguments = ForkingPickler.loads(data)
        return ForkingPickler.dumps((True, task(*arguments)))
    except Exception as error:  # noqa: BLE001 (handed over, whatever it is)
        error.add_note(traceback.format_exc())
        try:
            told = ForkingPickler.dumps((False, error))
            ForkingPickler.loads(told)
        except Exception:  # noqa: BLE001 (an error that does not travel is told in words)
            return ForkingPickler.dumps((False, RuntimeError(f"{type(error).__name__}: {error}")))
        return told


def _prepare(memory: int) -> None:
    """Prepares a worker: limits its memory, leaves interrupts to the main process, makes it end with that,
    and spares it to look for cycles among what it was started with.
    """
    gc.freeze()
    gc.set_threshold(_BETWEEN_SEARCHES)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_server, daemon=True).start()
    with suppress(ImportError, OSError, ValueError):  # Windows has no such module, and macOS no such limit
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def _end_with_server() -> None:
    server = multiprocessing.parent_process()
    if server is not None:
        connection.wait([server.sentinel])
        os._exit(1)


# --- Many calls at a time on one engine: those that are done are handed over as they come, and one whose
# process dies, or of which nothing is heard, is given once more when there is nothing else to do.

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
class _Given(Generic[K, T]):
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
        self._waiting: dict[Future[T], _Given[K, T]] = {}
        self._later: list[_Given[K, T]] = []
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
        self._begin(_Given(key, seconds, task, arguments))

    def _begin(self, call: _Given[K, T]) -> None:
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
        self._later += [replace(call, deaths=call.deaths + 1) for call in calls if call.deaths + 1 < _LIVES]
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


def _once_more(call: _Given[K, T], error: BaseException) -> _Given[K, T] | None:
    """Returns a call that broke as it is to be begun again; None if it is not."""
    if limit_met(error) is Limit.DEATH and call.deaths + 1 < _LIVES:
        return replace(call, deaths=call.deaths + 1)
    if isinstance(error, GoneError) and call.losses + 1 < _RETURNS:
        return replace(call, losses=call.losses + 1)
    return None


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
    """The workers of a scheduler, which carry out calls as `Guarded` does."""

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
        """Has a call carried out (see `Guarded`)."""
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
_pooling = threading.Lock()


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
    with _pooling:
        if preload not in _pools:
            _pools[preload] = Guarded(threads, preload)
        return _pools[preload]
