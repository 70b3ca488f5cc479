"""The text of a program as its pages change it: what of it is in the file, and the steps that can be undone.

What is set at once, as by a slider, goes into the file if all before it did. What is typed waits until it is
saved; then what is set waits with it. What others do to the file meanwhile is never overwritten unasked.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.ide.edits import applied
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.preview import files

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

    def __init__(self, path: Path, write: files.Write) -> None:
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
        self.take(files.text_of(self.path))

    def take(self, found: str) -> None:
        """Takes note of what was found in the file."""
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
        """Writes the text into the file; over what others have written there only if `anyway`. Raises
        CannotError.
        """
        self.read()
        if self.is_contested and not anyway:
            raise CannotError(f"{self.path.name} has changed on disk, so your text was not saved over it")
        self._put(self._current, {})

    def type(self, text: str, page: str, now: float) -> None:
        """Takes a text that a page made of the present one."""
        before = self._current
        last = self._past[-1] if self._past and not self._future else None
        if last is not None and last.typist is not None:
            typist, when = last.typist
            if typist == page and now - when < PAUSE:
                before = last.text[0]
                self._past.pop()
        self._keep(Step(_TYPING, (before, text), {}, (page, now)))
        self._become(text)

    def set(
        self,
        label: str,
        known: SourceFile | None,
        edits: Sequence[Edit],
        others: Mapping[Path, tuple[bytes, bytes]],
    ) -> None:
        """Makes edits of the program's text as it was run, if there are any, and gives other files their
        contents. Raises CannotError if any of them is another now, and then changes nothing.
        """
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
        """Writes what is not saved into a file beside the program's, and returns that; None if all is saved.
        Raises CannotError.
        """
        if self.text is None or self.is_saved:
            return None
        beside = self.path.with_name(f"{self.path.name}.unsaved")
        files.write([(beside, self.text.encode())], self._write)
        return beside

    @property
    def _current(self) -> str:
        if self.text is None:
            raise CannotError(f"{self.path.name} could not be read")
        return self.text

    def _go(self, steps: list[Step], way: str) -> Step:
        """Takes the last of these steps, carries it out, and returns it."""
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
        if step.typist is None and self.is_saved:
            self._put(after, step.others)
        else:
            self._put(None, step.others)
        self._become(after)

    def _put(self, text: str | None, others: Mapping[Path, tuple[bytes, bytes]]) -> None:
        """Writes a text into the file, and other files, each of which must be as it was known."""
        for path, (before, _) in others.items():
            files.require(path, before)
        written = [(path, after) for path, (_, after) in others.items()]
        if text is not None and text != self._in_file:
            written.append((self.path, files.replaced(self.path, self._in_file, text)))
        try:
            files.write(written, self._write)
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
