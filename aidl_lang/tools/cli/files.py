"""Reads programs and writes results: whole or not at all, with one clear line on any error."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.diagnostics import AidlError, Diagnostic, Severity
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MAX_BYTES, Reads, replace, require_fitting

if TYPE_CHECKING:
    from aidl_lang.common.world import DiskWorld


# --- Reports on standard error, and the exit code that follows from diagnostics.

_FAMILY_OF_USE = "E09"


class UseError(AidlError):
    """Raised for wrong use: a file is missing, a format unknown. The command ends with 2."""

    def __init__(self, code: str, message: str, *hints: str) -> None:
        super().__init__(Diagnostic(code, message, hints=hints))


def show(diagnostics: Iterable[Diagnostic], quiet: bool = False) -> None:
    """Prints diagnostics for a reader, errors only if `quiet`."""
    said = [d for d in diagnostics if not quiet or d.severity is Severity.ERROR]
    if not said:
        return
    import shutil

    from aidl_lang.common.render import TerminalStyle, render, wants_colour

    style = TerminalStyle(wants_colour(sys.stderr, os.environ))
    width = shutil.get_terminal_size((110, 24)).columns
    for diagnostic in said:
        say(render(diagnostic, style, width), end="\n\n" if diagnostic.span else "\n")


def say(line: str, end: str = "\n") -> None:
    """Prints a line about the work; standard output is left to the results."""
    print(line, end=end, file=sys.stderr)


def pass_by(line: str) -> None:
    """Prints a line on a terminal in place of the last one; an empty one removes it."""
    if sys.stderr.isatty():
        print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)


def print_json(found: object, indent: int = 2) -> None:
    import json

    print(json.dumps(found, indent=indent, ensure_ascii=False))


def exit_code(diagnostics: Iterable[Diagnostic]) -> int:
    """Returns 2 if the command was used wrongly, 1 if the program is wrong, else 0."""
    codes = {d.code for d in diagnostics if d.is_error}
    if any(code.startswith(_FAMILY_OF_USE) for code in codes):
        return 2
    return 1 if codes else 0


STANDARD = "-"
"""The file name of standard input or output."""
reads = Reads()
"""The files that this command has read."""


def read(name: str) -> SourceFile:
    """Returns the program in a file, or on standard input for `-`."""
    try:
        if name == STANDARD:
            data = sys.stdin.buffer.read(MAX_BYTES + 1)
            require_fitting(len(data), MAX_BYTES, name)
        else:
            data = reads.contents(name)
    except FileNotFoundError:
        raise UseError("E0901", f"there is no file `{name}`", *_neighbours(Path(name))) from None
    except IsADirectoryError:
        raise UseError("E0902", f"`{name}` is a directory, not a program") from None
    except OSError as error:
        raise UseError("E0902", f"`{name}` cannot be read: {_reason(error)}") from None
    if name == STANDARD:
        return SourceFile("<stdin>", decoded(data, "standard input"))
    return SourceFile(name, decoded(data, f"`{name}`"))


def require_watchable(name: str) -> None:
    """Refuses standard input, and a program that cannot be read."""
    if name == STANDARD:
        raise UseError("E0902", "standard input cannot be watched", "name a file")
    read(name)


def world(name: str) -> DiskWorld:
    """Returns the world whose imports are read beside the program."""
    from aidl_lang.common.world import DiskWorld

    return DiskWorld(Path.cwd() if name == STANDARD else Path(name).resolve().parent, reads)


def require_directory(name: str) -> None:
    """Refuses an output whose directory is missing before any work is done for it."""
    parent = Path(name).parent
    if name != STANDARD and not parent.is_dir():
        raise UseError("E0904", f"`{name}` cannot be written: there is no directory `{parent}`")


def make_directories(names: Iterable[str]) -> None:
    for parent in dict.fromkeys(Path(name).parent for name in names if name != STANDARD):
        try:
            parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UseError("E0904", f"`{parent}` cannot be made: {_reason(error)}") from None


def require_unread(names: Iterable[str]) -> None:
    """Refuses to overwrite what was read."""
    reads.require_unread(name for name in names if name != STANDARD)


def write(name: str, data: bytes) -> None:
    """Replaces a file by its new content in one step, but for one that was read; `-` is standard output."""
    require_unread([name])
    rewrite(name, data)


def rewrite(name: str, data: bytes) -> None:
    """Does as `write`, also with a file that was read: a program that is edited."""
    if name == STANDARD:
        if sys.stdout.isatty() and b"\0" in data:
            raise UseError(
                "E0920",
                "a terminal cannot show this format",
                "name a file with -o",
                "`aidl show` draws in the terminal",
            )
        sys.stdout.flush()
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
        return
    path = Path(os.path.realpath(name))
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)
        else:
            replace(path, data)
    except OSError as error:
        raise UseError("E0904", f"`{name}` cannot be written: {_reason(error)}") from None


def create(name: str, data: bytes) -> None:
    """Writes a file that must not exist yet."""
    try:
        with open(name, "xb") as file:
            file.write(data)
    except FileExistsError:
        raise UseError("E0906", f"`{name}` exists already; it is left as it is") from None
    except OSError as error:
        raise UseError("E0904", f"`{name}` cannot be written: {_reason(error)}") from None


def decoded(data: bytes, what: str) -> str:
    """Returns the text of a program; `what` names it. Raises UseError."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise UseError("E0903", f"{what} is not UTF-8 text (line {line})", "save it as UTF-8") from None
    if "\0" in text:
        raise UseError("E0903", f"{what} is not text: it holds zero bytes")
    return text


def _neighbours(path: Path) -> list[str]:
    """Returns files of the kind beside a missing one that may have been meant; most are programs."""
    from difflib import get_close_matches

    with suppress(OSError):
        kind = path.suffix if path.suffix == ".toml" else ".aidl"
        beside = [entry.name for entry in path.parent.glob(f"*{kind}")]
        near = get_close_matches(path.name.removesuffix(kind) + kind, beside, n=1)
        return [f"did you mean `{path.with_name(name)}`?" for name in near]
    return []


def _reason(error: OSError) -> str:
    text = error.strerror or str(error)
    return text[:1].lower() + text[1:]
