"""Finds the program in a model's reply."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from aidl_lang.common.records import record

_THOUGHT = re.compile(r"<(think|thinking|reasoning)>.*?(</\1>|\Z)", re.S)
_FENCE = re.compile(r"^[ \t]*(`{3,}|~{3,})[ \t]*([^\s`]*)[^\n`]*$", re.M)


@record()
class FoundProgram:
    """The program in a reply, None if there is none, and whether the reply ends inside a block."""

    program: str | None
    is_open: bool


def find_program(text: str, fences: Sequence[str], reads: Callable[[str], bool]) -> FoundProgram:
    """Returns the last fenced block: of those with one of the names `fences` if there is one, else of all.

    A reply without a fence may be a program itself, which `reads` tells. Thoughts between tags are no part of
    the reply, and a block that is not closed holds no whole program.
    """
    spoken = _THOUGHT.sub("", text)
    blocks: list[tuple[str, str]] = []
    opened: re.Match[str] | None = None
    for fence in _FENCE.finditer(spoken):
        if opened is None:
            opened = fence
        elif fence[1].startswith(opened[1]) and not fence[2]:
            blocks.append((opened[2].lower(), spoken[opened.end() + 1 : fence.start()]))
            opened = None
    if not blocks:
        bare = spoken.strip()
        is_program = opened is None and bool(bare) and reads(bare)
        return FoundProgram(f"{bare}\n" if is_program else None, opened is not None)
    named = [program for name, program in blocks if name in fences]
    return FoundProgram(named[-1] if named else blocks[-1][1], opened is not None)
