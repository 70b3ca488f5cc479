"""Turns texts into views and outcomes on threads of their own, and collects garbage while nobody waits."""

from __future__ import annotations

import asyncio
import gc
import time
from collections.abc import Callable, Hashable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pygls.exceptions import JsonRpcException

from aidl_lang.common import resources
from aidl_lang.common.running import Cancelled, cancelled_when, checkpoint
from aidl_lang.common.world import MemoryWorld, is_data
from aidl_lang.syntax import ast
from aidl_server.ide.completion import complete
from aidl_server.ide.hover import hover
from aidl_server.ide.preview import preview
from aidl_server.ide.references import CannotError
from aidl_server.ide.workspace import SETTINGS, View, look, run
from aidl_server.lsp.documents import Document, VersionedView

if TYPE_CHECKING:
    from aidl_server.lsp.server import Server

# --- Work off the message thread: single threads with queues.

T = TypeVar("T")
FAILED = -32803
"""The protocol's code for a request that was understood and cannot be done."""


class Dropped(Cancelled):
    """Raised in place of a result where newer work of the same key came before this had begun."""


class Lane:
    """Does one piece of work at a time, of those under one key the newest; for use in the loop's thread."""

    def __init__(self, name: str, finished: Callable[[], None] = lambda: None) -> None:
        self._executor = ThreadPoolExecutor(max_workers=1, thread_name_prefix=name)
        self._finished = finished
        self._waiting: dict[Hashable, tuple[Callable[[], Any], asyncio.Future[Any]]] = {}
        self.running: asyncio.Future[Any] | None = None
        self._is_closed = False

    def waits(self, key: Hashable) -> bool:
        return key in self._waiting

    def put(self, key: Hashable, work: Callable[[], T], first: bool = False) -> asyncio.Future[T]:
        """Queues work, last or as the next. Returns what will have its result."""
        self.drop(key)
        result: asyncio.Future[T] = asyncio.get_running_loop().create_future()
        result.add_done_callback(lambda done: done.cancelled() or done.exception())  # which is then no news
        if self._is_closed:
            result.set_exception(Dropped())
        else:
            put = {key: (work, result)}
            self._waiting = put | self._waiting if first else self._waiting | put
            self._start()
        return result

    async def ask(self, answer: Callable[[], T]) -> T:
        """Returns an answer, found in its turn and no longer than somebody waits for it; for a CannotError
        raises an error of the protocol.
        """

        def is_unwanted() -> bool:
            return self._is_closed or (self.running is not None and self.running.cancelled())

        def work() -> T:
            with cancelled_when(is_unwanted):
                return answer()

        try:
            return await self.put(object(), work)
        except CannotError as reason:
            raise JsonRpcException(str(reason), FAILED) from None
        except Dropped:
            raise asyncio.CancelledError from None

    def drop(self, key: Hashable) -> None:
        """Drops the work waiting under a key; running work goes on."""
        _, result = self._waiting.pop(key, (None, None))
        if result is not None and not result.done():
            result.set_exception(Dropped())

    def close(self) -> None:
        """Drops waiting work, cancels the present answer, and begins nothing more."""
        self._is_closed = True
        for key in list(self._waiting):
            self.drop(key)
        self._executor.shutdown(wait=False, cancel_futures=True)

    def _start(self) -> None:
        while self.running is None and self._waiting:
            work, result = self._waiting.pop(next(iter(self._waiting)))
            if not result.cancelled():
                self.running = result
                self._executor.submit(work).add_done_callback(partial(self._hand_over, result))

    def _hand_over(self, result: asyncio.Future[Any], future: Future[Any]) -> None:
        """Passes a result to the loop, from the lane's thread or whichever cancels."""
        with suppress(RuntimeError):  # the loop has ended: nobody waits for this any more
            result.get_loop().call_soon_threadsafe(self._finish, result, future)

    def _finish(self, result: asyncio.Future[Any], future: Future[Any]) -> None:
        self.running = None
        if not (future.cancelled() or result.done()):
            if (error := future.exception()) is not None:
                result.set_exception(error)
            else:
                result.set_result(future.result())
        result.get_loop().call_soon(self._start)  # once the result was taken note of
        self._finished()


# A run leaves tens of thousands of objects that hold each other. Python's collector would look for them in
# the middle of the next run, and go through the library and everything else each time; here it does so in
# the pauses, and what was loaded is put out of its sight once. What documents stood for then is among that,
# so all is looked through again when some are closed.

_PAUSE = 0.05
"""Seconds without work after which nobody seems to wait."""
_MOST = 100
"""Pieces of work after which it collects without a pause."""
_RELEASED = 2.0
"""Seconds after which nothing is under way for the documents that were closed."""


class Tidier:
    """`is_busy` tells whether anybody waits. All methods belong to the loop's thread."""

    def __init__(self, loop: asyncio.AbstractEventLoop, is_busy: Callable[[], bool]) -> None:
        self._loop, self._is_busy = loop, is_busy
        self._left = 0
        self._planned: dict[Callable[[], None], asyncio.TimerHandle] = {}
        gc.disable()

    def note(self) -> None:
        self._left += 1
        self.plan(0 if self._left >= _MOST else _PAUSE, self._tidy)

    def plan(self, seconds: float, work: Callable[[], None]) -> None:
        """Calls a while after it was last asked to: once for documents that are closed in a row."""
        if (planned := self._planned.get(work)) is not None:
            planned.cancel()
        self._planned[work] = self._loop.call_later(seconds, work)

    def _tidy(self) -> None:
        if self._left >= _MOST or not self._is_busy():  # else there is a note at the end of that
            self._left = 0
            gc.collect()

    def settle(self) -> None:
        """Looks through everything, and puts what stays out of sight."""
        if not gc.isenabled():  # else this is closed
            gc.unfreeze()
            gc.collect()
            gc.freeze()

    def close(self) -> None:
        for planned in self._planned.values():
            planned.cancel()
        gc.enable()


# --- Turns texts into views and outcomes: every change is checked, and the newest view is run.
#
# One thread looks, another runs. A run whose text has changed is given up, unless the run before was given
# up as well: under quick typing at least every second run comes to its end, if it is a short one.

LIMITS = replace(
    SETTINGS,
    building=replace(SETTINGS.building, seconds=10.0),
    solving=replace(SETTINGS.solving, seconds=10.0),
    drawing=10.0,
)
"""Limits of a run: nobody looks at a text for longer without changing it."""
GRACE = 0.25
"""Seconds that a run may still take when its text has changed, if the run before it was given up."""
PATIENCE = 0.2
"""Seconds of solving after which the results of checking are published."""


class Runner:
    """Checks and runs the documents of a server. All methods belong to the loop's thread."""

    def __init__(self, server: Server, loop: asyncio.AbstractEventLoop) -> None:
        self._server, self.documents, self.workspace = server, server.documents, server.open_files
        self.limits, self.delay = server.limits, 0.0
        self.active: Document | None = None
        """What the user is at: it goes first."""
        self._tidier = Tidier(loop, lambda: any((self.looking.running, self.solving.running)))
        self.looking = Lane("looking", self._tidier.note)
        self.solving = Lane("solving", self._tidier.note)
        self._loop, self._is_closing = loop, False

    def warm_up(self) -> None:
        """Loads what the first run and the first questions need while nobody waits for it."""
        self.solving.put("first run", lambda: run(_example()))
        questions = self.solving.put("first questions", _ask_something)
        questions.add_done_callback(lambda _: self._tidier.settle())

    def renew(self, document: Document, *, active: bool = False) -> None:
        """Checks and runs a document after a change of its text, or of one that it imports."""
        if active:
            self.active = document
        document.serial += 1
        version, serial = document.version, document.serial
        world = self.workspace.world(document.path)
        work = partial(look, document.path, document.text, world, self.limits)
        looked = self.looking.put(document, work, first=active)
        looked.add_done_callback(partial(self._looked, document, version, serial))

    def renew_dependents(self, path: Path) -> None:
        """Renews the documents that use a file, after a change of it on disk or in the editor."""
        for document in self.documents:
            known = document.newest
            if known is not None and document.path != path and _stands_on(known.view, path):
                self.renew(document)

    async def work(
        self, key: Hashable, function: Callable[[], T], is_unwanted: Callable[[], bool], *, first: bool = True
    ) -> T:
        """Returns a result from the solving thread, before waiting work or behind it; cancels older ones."""

        def work() -> T:
            with cancelled_when(lambda: self._is_closing or is_unwanted() or self.solving.waits(key)):
                checkpoint()
                return function()

        return await self.solving.put(key, work, first=first)

    def forget(self, document: Document) -> None:
        self.looking.drop(document)
        self.solving.drop(document)
        if self.active is document:
            self.active = None
        self._tidier.plan(_RELEASED, self._tidier.settle)

    def close(self) -> None:
        self._is_closing = True
        self.looking.close()
        self.solving.close()
        self._tidier.close()

    def _looked(self, document: Document, version: int, serial: int, looked: asyncio.Future[View]) -> None:
        error = looked.exception()
        if not document.is_open or isinstance(error, Dropped):
            return
        document.seen = serial
        if error is not None:
            document.solved = serial  # nothing will come of this text
            self._server.crashed(error)
        else:
            drawn = document.ran.view.drawn if document.ran is not None else None
            view = replace(looked.result(), drawn=drawn)
            document.newest = VersionedView(view, version, serial)
            if document.path.is_relative_to(resources.resource("stdlib")):
                document.solved = serial  # it is of the library, and no program
            elif self.delay:
                self._loop.call_later(self.delay, self._solve_if_newest, document, document.newest)
            else:
                self._solve(document, document.newest)
        document.tell()

    def _solve_if_newest(self, document: Document, known: VersionedView) -> None:
        if document.is_open and document.serial == known.serial and not self._is_closing:
            self._solve(document, known)

    def _solve(self, document: Document, known: VersionedView) -> None:
        began = self._loop.time()
        work = partial(self._run, document, known, document.was_given_up)
        ran = self.solving.put(document, work, first=document is self.active)
        ran.add_done_callback(partial(self._ran, document, known))
        self._loop.call_at(began + PATIENCE, self._tell_what_is_known, document, known)

    def _tell_what_is_known(self, document: Document, known: VersionedView) -> None:
        if document.is_open and document.seen == known.serial > document.solved:
            self._server.took_long(document)

    def _run(self, document: Document, known: VersionedView, is_patient: bool) -> View:
        began = time.monotonic()

        def is_unwanted() -> bool:
            if self._is_closing or not document.is_open:
                return True
            if document.serial != known.serial:
                return not is_patient or time.monotonic() > began + GRACE
            return document is not self.active and self.solving.waits(self.active)

        with cancelled_when(is_unwanted):
            last = document.ran.view if document.ran is not None else None
            view = run(known.view, last, document.memory, settings=self.limits)
            _ = view.diagnostics  # worked out where it can be given up: the loop's thread reads them
            return view

    def _ran(self, document: Document, known: VersionedView, ran: asyncio.Future[View]) -> None:
        error = ran.exception()
        if not document.is_open or self._is_closing or isinstance(error, Dropped):
            return
        if isinstance(error, Cancelled):
            document.was_given_up = True
            if document.serial == known.serial:  # it made way for what is more urgent
                self._solve(document, known)
            return
        document.was_given_up = False
        document.solved = known.serial
        if error is not None:
            self._server.crashed(error)
        else:
            document.ran = replace(known, view=ran.result())
            newest = document.newest
            if newest is None or newest.serial == known.serial:
                document.newest = document.ran
            else:
                document.newest = replace(newest, view=replace(newest.view, drawn=document.ran.view.drawn))
            self._server.solved(document)
        document.tell()


def _example() -> View:
    text = "solid example { part = circle(radius: 1) }"
    return look(Path("example.aidl").absolute(), text, MemoryWorld({}))


def _ask_something() -> None:
    view = run(_example())
    complete(view, view.source.text.index("circle"))
    hover(view, view.source.text.index("circle"))
    preview(view)


def _stands_on(view: View, path: Path) -> bool:
    """True if a program imports a file, directly or not, names it as a font, or has a missing import."""
    modules = view.resolution.modules
    if is_data(path):
        return any(path.name in module.source.text for module in modules)
    return any(view.file(module.source) == path for module in modules) or any(
        isinstance(statement, ast.Import) and statement not in view.resolution.imports
        for module in modules
        for statement in module.statements
    )
