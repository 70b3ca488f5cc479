"""Checking programs in tests."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

from aidl_lang import parser
from aidl_lang.checking import library
from aidl_lang.checking.resolve import Resolution, resolve
from aidl_lang.common.diagnostics import Diagnostic, apply_fixes, ordered
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from aidl_lang.typecheck import Program, check


def checked(
    text: str, files: Mapping[str, str] | None = None, name: str = "main.aidl"
) -> tuple[Program, list[Diagnostic]]:
    """A program and all that is said of it before it is built."""
    parsed = parser.parse(SourceFile(name, textwrap.dedent(text).lstrip("\n")))
    resolution = resolve(parsed.module, MemoryWorld(files or {}), library.load())
    program = check(resolution)
    found = [violation.diagnostic({}) for violation in program.violations]
    return program, ordered([*parsed.diagnostics, *program.diagnostics, *found])


def resolved(text: str, files: Mapping[str, str] | None = None) -> Resolution:
    return checked(text, files)[0].resolution


def messages(text: str, files: Mapping[str, str] | None = None) -> list[str]:
    """`CODE LINE: message` for everything that is said of a program."""
    return [f"{d.code} {d.span.line if d.span else 0}: {d.message}" for d in checked(text, files)[1]]


def mended(text: str) -> str:
    """The program with all fixes applied; they have to leave nothing to complain about."""
    program, found = checked(text)
    new, _ = apply_fixes(program.main.source, found)
    assert [d.message for d in checked(new)[1]] == []
    return new
