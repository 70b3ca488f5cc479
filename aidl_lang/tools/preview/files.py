"""The files of a program that is previewed: read, and edited in one step each."""

from __future__ import annotations

from codecs import BOM_UTF8
from collections.abc import Callable, Sequence
from pathlib import Path

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.reading import Reads
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.ide.edits import applied
from aidl_lang.tools.ide.refusing import CannotError

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


def require(file: Path, data: bytes) -> None:
    """Raises CannotError if a file has another content."""
    if _read(file) != data:
        raise _changed(file)


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
