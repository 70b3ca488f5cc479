"""The files of a program that is previewed: read, watched, and edited in one step each."""

from __future__ import annotations

from codecs import BOM_UTF8
from collections.abc import Awaitable, Callable, Iterable, Mapping, Sequence
from pathlib import Path

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import Reads, may_be_read
from aidl_server.ide.references import CannotError
from aidl_server.ide.workspace import applied

# --- Watches for changes of a program, and of the files that it may import.

_DEBOUNCE = 30
"""Milliseconds in which several changes count as one."""
_QUIET = 500
"""Milliseconds without a change after which the file is read: systems begin late, and miss some changes."""


Changed = Callable[[Iterable[Path]], Awaitable[None]]
Begun = Callable[[], Awaitable[None]]


async def watch(file: Path, changed: Changed, begun: Begun) -> None:
    """Calls back with changed paths of a file and what it may read; with none at first and after a while."""
    try:
        await _watch(file, changed, begun, polling=None)
    except (OSError, RuntimeError):  # the system watches no more files, or not this folder
        await _watch(file, changed, begun, polling=True)


async def _watch(file: Path, changed: Changed, begun: Begun, polling: bool | None) -> None:
    from watchfiles import awatch  # a program that nobody else writes is not watched

    def concerns(change: object, path: str) -> bool:
        return may_be_read(path) or path == str(file)

    has_begun = False
    async for changes in awatch(
        file.parent,
        watch_filter=concerns,
        debounce=_DEBOUNCE,
        step=10,
        force_polling=polling,
        rust_timeout=_QUIET,
        yield_on_timeout=True,
    ):
        if changes or has_begun:
            await changed({Path(path) for _, path in changes})
        else:
            await begun()
        has_begun = True


Write = Callable[[Path, bytes], None]
"""Replaces a file in one step. Raises OSError."""


def text_of(path: Path) -> str:
    """Returns the text of a file. Raises CannotError."""
    return _text(_read(path))


def replaced(file: Path, known: str, text: str) -> bytes:
    """Returns the content of a file with another text in place of a known one. Raises CannotError."""
    data = _read(file)
    if _text(data) != known:
        raise _changed(file)
    return _mark(data) + text.encode()


def rewritten(file: Path, known: SourceFile, edits: Sequence[Edit]) -> tuple[bytes, bytes]:
    """Returns the content of a file before and after edits of its known text. Raises CannotError."""
    data = _read(file)
    text = _text(data)
    known_text = known.text.removeprefix("\ufeff")
    skipped = len(known.text) - len(known_text)
    # What is imported is read with its line ends made one.
    is_converted = text != known_text and text.replace("\r\n", "\n") == known_text
    if text != known_text and not is_converted:
        raise _changed(file)
    after = applied(known.text, edits)[skipped:]
    return data, _mark(data) + (after.replace("\n", "\r\n") if is_converted else after).encode()


def write(files: Sequence[tuple[Path, bytes]], put: Write) -> None:
    """Gives files their contents. Raises CannotError."""
    for file, data in files:
        try:
            put(file, data)
        except OSError as reason:
            raise CannotError(f"{file.name} was not written: {_why(reason)}") from None


def _read(path: Path) -> bytes:
    try:
        return Reads().contents(path)
    except OSError as reason:
        raise CannotError(f"{path.name} cannot be read: {_why(reason)}") from None


def _mark(data: bytes) -> bytes:
    return BOM_UTF8 if data.startswith(BOM_UTF8) else b""


def _changed(file: Path) -> CannotError:
    return CannotError(f"{file.name} has changed meanwhile; nothing was written")


def _text(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as reason:
        line = data.count(b"\n", 0, reason.start) + 1
        raise CannotError(f"line {line} is not UTF-8 text; the picture is of what was there before") from None


def _why(reason: OSError) -> str:
    text = reason.strerror or str(reason)
    return text[:1].lower() + text[1:]


# --- The text as its pages change it: what of it is in the file, and the steps that can be undone.
#
# What is set at once, as by a slider, goes into the file if all before it did. What is typed waits until it
# is saved; then what is set waits with it. What others do to the file meanwhile is never overwritten
# unasked.

MOST_STEPS = 100
"""Most steps that can be undone."""
PAUSE = 1.0
"""Seconds after which what is typed begins a step of its own."""
_TYPING = "Typing"


@record()
class Step:
    """A change that can be undone.

    label   says what it did
    text    the text of the program before and after
    others  the contents of other files before and after
    typist  the page that typed it, at a time; None for what was set at once
    """

    label: str
    text: tuple[str, str]
    others: Mapping[Path, tuple[bytes, bytes]]
    typist: tuple[str, float] | None = None

    @property
    def reversed(self) -> Step:
        others = {path: (after, before) for path, (before, after) in self.others.items()}
        return Step(self.label, (self.text[1], self.text[0]), others, self.typist)


class Manuscript:
    """The text that is shown, `None` until it was read. `version` counts its changes."""

    def __init__(self, path: Path, write: Write) -> None:
        self.path, self._write = path, write
        self.text: str | None = None
        self.version = 0
        self.is_contested = False
        """whether the file was changed by others while there was something to save"""
        self.looks = 0
        """counts how often the file was read or written"""
        self._in_file = ""
        self._is_foreign = False
        """whether the steps ended with a change by others"""
        self._past: list[Step] = []
        self._future: list[Step] = []

    @property
    def is_saved(self) -> bool:
        return self.text == self._in_file

    @property
    def undoes(self) -> str | None:
        """Returns what would be undone."""
        return self._past[-1].label if self._past else None

    @property
    def redoes(self) -> str | None:
        return self._future[-1].label if self._future else None

    def read(self) -> None:
        """Takes note of what the file holds now. Raises CannotError."""
        self.take(text_of(self.path))

    def take(self, found: str) -> None:
        self.looks += 1
        if self.text is None or (found != self._in_file and self.is_saved):
            self._is_foreign = self.text is not None
            self._forget()
            self._become(found)
        elif found != self._in_file:
            self.is_contested = found != self.text
        self._in_file = found
        self.is_contested &= not self.is_saved

    def take_file(self) -> None:
        """Gives up what is not saved."""
        self.read()
        self._forget()
        self._become(self._in_file)
        self.is_contested = False

    def save(self, *, anyway: bool = False) -> None:
        """Writes the text into the file; over what others wrote only if `anyway`. Raises CannotError."""
        self.read()
        if self.is_contested and not anyway:
            raise CannotError(f"{self.path.name} has changed on disk, so your text was not saved over it")
        self._put(self._current, {})

    def type(self, text: str, page: str, now: float) -> None:
        """Takes a text that a page made of the present one."""
        before = self._current
        last = self._past[-1].typist if self._past and not self._future else None
        if last is not None and last[0] == page and now - last[1] < PAUSE:
            before = self._past.pop().text[0]
        self._keep(Step(_TYPING, (before, text), {}, (page, now)))
        self._become(text)

    def set(
        self,
        label: str,
        known: SourceFile | None,
        edits: Sequence[Edit],
        others: Mapping[Path, tuple[bytes, bytes]],
    ) -> None:
        """Edits the program as it was run, and sets other files; nothing if one differs (CannotError)."""
        if known is not None and known.text != self._current:
            raise CannotError("the text has changed meanwhile")
        step = Step(label, (self._current, applied(self._current, edits)), others)
        self._carry_out(step)
        self._keep(step)

    def undo(self) -> None:
        """Takes the last step back. Raises CannotError."""
        self._future.append(self._go(self._past, "undo"))

    def redo(self) -> None:
        """Makes the step again that was undone last. Raises CannotError."""
        self._past.append(self._go(self._future, "redo"))

    def rescue(self) -> Path | None:
        """Writes what is not saved into a file beside, and returns it; None if all is. Raises CannotError."""
        if self.text is None or self.is_saved:
            return None
        beside = self.path.with_name(f"{self.path.name}.unsaved")
        write([(beside, self.text.encode())], self._write)
        return beside

    @property
    def _current(self) -> str:
        if self.text is None:
            raise CannotError(f"{self.path.name} could not be read")
        return self.text

    def _go(self, steps: list[Step], way: str) -> Step:
        self.read()
        if not steps:
            why = f": {self.path.name} was changed elsewhere meanwhile" if self._is_foreign else ""
            raise CannotError(f"there is nothing to {way}{why}")
        step = steps[-1]
        self._carry_out(step.reversed if way == "undo" else step)
        return steps.pop()

    def _carry_out(self, step: Step) -> None:
        before, after = step.text
        if before != self._current:
            raise CannotError("the text has changed meanwhile")
        self._put(after if step.typist is None and self.is_saved else None, step.others)
        self._become(after)

    def _put(self, text: str | None, others: Mapping[Path, tuple[bytes, bytes]]) -> None:
        """Writes a text into the file, and other files, each of which must be as it was known."""
        for path, (before, _) in others.items():
            if _read(path) != before:
                raise _changed(path)
        written = [(path, after) for path, (_, after) in others.items()]
        if text is not None and text != self._in_file:
            written.append((self.path, replaced(self.path, self._in_file, text)))
        try:
            write(written, self._write)
        finally:
            self.looks += 1
        if text is not None:
            self._in_file, self.is_contested = text, False

    def _become(self, text: str) -> None:
        if text != self.text:
            self.text = text
            self.version += 1

    def _keep(self, step: Step) -> None:
        self._future.clear()
        self._is_foreign = False
        self._past = [*self._past, step][-MOST_STEPS:]

    def _forget(self) -> None:
        self._past.clear()
        self._future.clear()
