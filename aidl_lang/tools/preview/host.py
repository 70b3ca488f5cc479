"""The host of the pages that show a program: brings them pictures, and carries out what they ask for."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from functools import partial
from typing import TypeAlias

from aidl_lang.common.cancelling import Cancelled
from aidl_lang.common.records import record
from aidl_lang.tools.agents.workspace import RefusalError
from aidl_lang.tools.ide.preview import Preview
from aidl_lang.tools.ide.preview.protocol import Json
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.ide.view import View
from aidl_lang.tools.preview import messages
from aidl_lang.tools.preview.messages import ApplyFix, Cancel, Drag, Export, Ready, SetKnob, Show
from aidl_lang.tools.preview.program import Program
from aidl_lang.tools.preview.worker import Job, Worker

Then: TypeAlias = Callable[[], None]
"""What is left to do in the event loop."""


@record(eq=False)
class Picture:
    """A preview of a version of the text, and the message that says it."""

    preview: Preview
    version: int
    text: str


_BUSY: Json = {"type": "busy"}
_TOO_MUCH: Json = {
    "type": "error",
    "message": "this page asks for more than can be done at once: what it asked for last was left out",
}
_GIVEN_UP: Json = {"type": "error", "message": "the text has changed meanwhile: ask for it again"}
MOST_UNTAKEN = 16
"""Messages that wait for a page before it is heard again."""


class Page:
    """One page that is open. What it has not taken yet waits; of pictures the newest, of equals one."""

    def __init__(self) -> None:
        self.show: frozenset[str] = frozenset()
        self.shown: Picture | None = None
        """what it was sent last"""
        self.is_owed = False
        """whether it waits for a picture even if the text stays as it is"""
        self.is_held_up = False
        """whether it was told that it asks for too much, and nothing of it was taken since"""
        self._waiting: list[tuple[bool, str]] = []
        self._news = asyncio.Event()

    def post(self, text: str, *, is_picture: bool = False) -> None:
        if is_picture:
            self._waiting = [each for each in self._waiting if not each[0]]
        if (is_picture, text) not in self._waiting:
            self._waiting.append((is_picture, text))
        self._news.set()

    @property
    def is_behind(self) -> bool:
        """Whether it asks for more than it takes."""
        return len(self._waiting) >= MOST_UNTAKEN

    def take(self, picture: Picture) -> None:
        self.shown = picture
        self.post(picture.text, is_picture=True)

    def tell(self, message: Json) -> None:
        self.post(json.dumps(message))

    async def next(self) -> str:
        """The next message for it."""
        while not self._waiting:
            self._news.clear()
            await self._news.wait()
        return self._waiting.pop(0)[1]


class Host:
    def __init__(self, program: Program) -> None:
        self.program = program
        self.pages: list[Page] = []
        self._worker = Worker(Job(self._refreshed, partial(self._tell_all, _BUSY), self._trouble))
        self._trouble_told = ""

    async def run(self) -> None:
        """Works until it is cancelled."""
        self._worker.refresh()
        await self._worker.run()

    def changed(self) -> None:
        """A file has changed, or may have."""
        self._worker.refresh()

    def look(self) -> None:
        """A file may have changed before anybody saw to it. What runs goes on."""
        self._worker.ask(None)

    def join(self) -> Page:
        page = Page()
        self.pages.append(page)
        return page

    def leave(self, page: Page) -> None:
        self.pages.remove(page)
        self._worker.leave(page)

    # --- The text

    def _refreshed(self) -> Then:
        is_new, trouble = False, ""
        try:
            is_new = self.program.refresh()
        except CannotError as reason:
            if self.program.view is None:
                raise
            trouble = str(reason)
        pages = [page for page in tuple(self.pages) if is_new or page.is_owed]
        view = self.program.current
        pictures: dict[frozenset[str], Picture] = {}
        for show in {page.show for page in pages}:
            made = self.program.picture(view, show)
            pictures[show] = Picture(made, self.program.version, self.program.message(view, made))
        return partial(self._show_all, pages, pictures, trouble)

    def _show_all(self, pages: list[Page], pictures: dict[frozenset[str], Picture], trouble: str) -> None:
        for page in pages:
            if page.show in pictures:  # else it has just asked for others
                page.is_owed = False
                page.take(pictures[page.show])
        self._tell_trouble(trouble)
        if pages:
            self._worker.later(Job(self._completed, _nothing, self._trouble))

    def _completed(self) -> Then:
        """What takes longer is told when the pictures are there."""
        found: list[tuple[Page, Picture, Picture]] = []
        for page in tuple(self.pages):
            before = page.shown
            if before is not None and not before.preview.tried and before.version == self.program.version:
                made = self.program.completed(before.preview)
                if made.handles != before.preview.handles:
                    text = self.program.message(self.program.current, made)
                    found.append((page, before, Picture(made, before.version, text)))
        return partial(self._complete_all, found)

    def _complete_all(self, found: list[tuple[Page, Picture, Picture]]) -> None:
        for page, before, after in found:
            if page.shown is before:
                page.take(after)

    def _trouble(self, error: BaseException) -> None:
        if not isinstance(error, Cancelled):
            self._tell_trouble(_told(error))

    def _tell_trouble(self, message: str) -> None:
        """That the file cannot be read is told once, not at each look at it."""
        if message and message != self._trouble_told:
            self._tell_all({"type": "error", "message": message})
        self._trouble_told = message

    def _tell_all(self, message: Json) -> None:
        for page in self.pages:
            page.tell(message)

    # --- What pages ask for

    def hear(self, page: Page, text: str) -> None:
        """Take a message; the answer comes when there is one."""
        if page.is_behind:
            self._hold_up(page)
            return
        match messages.read(text):
            case Ready() | Cancel():
                self._worker.forget(page)
                self._owe(page)
            case Show(layers):
                page.show = layers
                self._owe(page)
            case SetKnob(path, value, final):
                if final:
                    self._edit(page, lambda: self.program.set_knob(path, value))
                else:
                    self._attempt(page, lambda: self._tried_knob(page, path, value))
            case Drag(handle, to, final):
                if final:
                    self._edit(page, lambda: self.program.drop(handle, to))
                else:
                    self._attempt(page, lambda: self._dragged(page, handle, to))
            case ApplyFix(problem, fix):
                self._edit(page, partial(self._fix, page.shown, problem, fix))
            case Export(name):
                self._order(page, lambda: self._exported(page, name))
            case None:
                pass

    def _owe(self, page: Page) -> None:
        page.is_owed = True
        self._worker.ask(page)

    def _attempt(self, page: Page, do: Callable[[], Then]) -> None:
        self._worker.attempt(page, Job(do, partial(page.tell, _BUSY), partial(self._refused, page)))

    def _order(self, page: Page, do: Callable[[], Then], *, lasts: bool = False) -> None:
        job = Job(do, partial(page.tell, _BUSY), partial(self._refused, page, is_order=True), lasts)
        if self._worker.order(page, job):
            page.is_held_up = False
        else:
            self._hold_up(page)

    def _hold_up(self, page: Page) -> None:
        """Leave out what it asks for; that is told once."""
        if not page.is_held_up:
            page.is_held_up = True
            page.tell(_TOO_MUCH)
            self._owe(page)

    def _edit(self, page: Page, edit: Callable[[], None]) -> None:
        """An order after which the page gets the picture of the text."""

        def do() -> Then:
            edit()
            return partial(self._edited, page)

        self._worker.forget(page)
        self._order(page, do, lasts=True)

    def _edited(self, page: Page) -> None:
        page.is_owed = True
        self._worker.refresh()

    def _refused(self, page: Page, error: BaseException, *, is_order: bool = False) -> None:
        """What was given up is followed by the picture of the text."""
        if not isinstance(error, Cancelled):
            page.tell({"type": "error", "message": _told(error)})
        elif is_order:
            page.tell(_GIVEN_UP)
        self._owe(page)

    # --- In the thread of the worker

    def _tried_knob(self, page: Page, path: str, value: float | str | bool) -> Then:
        view = self.program.with_knob(path, value)
        return self._tried(page, view)

    def _dragged(self, page: Page, handle: str, to: tuple[float, float]) -> Then:
        return self._tried(page, self.program.dragged(handle, to))

    def _tried(self, page: Page, view: View) -> Then:
        made = self.program.picture(view, page.show, is_tried=True)
        return partial(page.take, Picture(made, self.program.version, self.program.message(view, made)))

    def _fix(self, shown: Picture | None, problem: int, fix: int) -> None:
        if shown is None or shown.version != self.program.version:
            raise CannotError("the text has changed meanwhile")
        problems = shown.preview.problems
        if not (0 <= problem < len(problems) and 0 <= fix < len(problems[problem].fixes)):
            raise CannotError("there is no such fix")
        self.program.edit(problems[problem].fixes[fix].edits)

    def _exported(self, page: Page, name: str) -> Then:
        return partial(page.tell, self.program.export(name, page.show))


def _nothing() -> None:
    """Nobody waits for it."""


def _told(error: BaseException) -> str:
    """What ended a job, for people. Raises what nobody foresaw, to be told by the event loop."""
    match error:
        case CannotError():
            return str(error)
        case RefusalError(diagnostics=(first, *_)):
            return "; ".join([first.message, *first.hints[:1]])
        case _:
            asyncio.get_running_loop().call_exception_handler(
                {"message": "the preview failed at something", "exception": error}
            )
            return "this did not work; the terminal says more"
