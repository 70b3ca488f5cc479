"""Applies sure fixes until none is left, and keeps those that improve the program."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache

from aidl_lang import pipeline
from aidl_lang.checking import library
from aidl_lang.checking.complaints import IDLE
from aidl_lang.common.diagnostics import Diagnostic, apply_fixes
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.parser import parse
from aidl_lang.syntax import ast

_STEPS = 100
"""Most times that a program is improved."""
_AHEAD = 6
"""Times that fixes may bring more errors to light before they are taken back."""
_SHARE = 0.5
"""Time for all checks but the first, as a share of that for building a program."""
_LEAST_SECONDS = 0.05
"""Least seconds for checking a program again."""
_CUT_OFF = "E08"
"""The family of findings about limits: the program may have more errors."""


@record()
class Mended:
    """A program as it stands now, the findings left in it, and the titles of the fixes made on the way."""

    source: SourceFile
    diagnostics: list[Diagnostic]
    fixes: tuple[str, ...] = ()


def mend(
    source: SourceFile, world: World | None = None, settings: pipeline.Settings = pipeline.Settings()
) -> Mended:
    """Applies sure fixes, and checks again until nothing changes.

    What was done is kept where the program has no more errors for it, states all that it stated, and does not
    return to an earlier text. Where all fixes together make it worse, parts of them are tried. No look after
    the first is begun once half the time is over that building a program may take.
    """
    last = time.thread_time() + _SHARE * settings.building.seconds

    def looked_at(changed: SourceFile, fixes: tuple[str, ...]) -> Mended:
        left = last - time.thread_time()
        if left < _LEAST_SECONDS:
            raise _OutOfTimeError
        hurried = replace(settings, building=replace(settings.building, seconds=left))
        return Mended(changed, pipeline.check(changed, world, hurried), fixes)

    now = Mended(source, pipeline.check(source, world, settings))
    seen: dict[object, Mended] = {_outlook(now): now}
    try:
        for _ in range(_STEPS):
            tried = (_after(now, part, looked_at) for part in _parts(_sure(now)))
            better = next((after for after in tried if after is not None), None)
            if better is None:
                break
            if (before := seen.setdefault(_outlook(better), better)) is not better:
                return before  # what was done since undoes itself
            now = better
    except _OutOfTimeError:
        pass
    return now


class _OutOfTimeError(Exception):
    """Raised if there is no time to check the program again."""


def _sure(state: Mended) -> list[Diagnostic]:
    return [d for d in state.diagnostics if d.fix is not None and d.fix.is_sure]


def _after(
    now: Mended, part: Sequence[Diagnostic], looked_at: Callable[[SourceFile, tuple[str, ...]], Mended]
) -> Mended | None:
    """Returns the program after some fixes and those that they bring to light; None if it is worse."""
    stated, errors, after = constraining(now.source), _errors(now.diagnostics), now
    for _ in range(_AHEAD):
        text, applied = apply_fixes(after.source, part)
        if not applied or text == after.source.text:
            return None
        titles = tuple(d.fix.title for d in part if d.fix)[:applied]
        after = looked_at(SourceFile(now.source.name, text), (*after.fixes, *titles))
        is_cut_off = any(d.code.startswith(_CUT_OFF) for d in after.diagnostics)
        if is_cut_off or constraining(after.source) < stated:
            return None
        if _errors(after.diagnostics) <= errors:
            return after
        part = _sure(after)
    return None


def _parts(found: Sequence[Diagnostic]) -> Iterator[Sequence[Diagnostic]]:
    """Yields all findings, the halves of them, the quarters, and so on down to each by itself."""
    size = len(found)
    while size:
        yield from (found[start : start + size] for start in range(0, len(found), size))
        size = -(-size // 2) if size > 1 else 0


def _errors(found: Sequence[Diagnostic]) -> int:
    return sum(d.is_error for d in found)


def constraining(source: SourceFile) -> int:
    """Counts the statements that constrain, wish or assert, as far as the program can be read. A call by
    itself counts if it calls a constraint, or stands where nothing else can.
    """
    module = parse(source).module
    nodes = list(ast.walk(module))
    blocks = (node.items for node in nodes if isinstance(node, ast.Constrain))
    demanded = {id(inner) for block in blocks for inner in ast.walk(block)}
    known = _known_constraints() | {
        fold(n.name.text) for n in nodes if isinstance(n, ast.ConstraintDefinition)
    }

    def constrains(node: ast.Node) -> bool:
        match node:
            case ast.Equation() | ast.Prefer() | ast.Assert():
                return True
            case ast.ExpressionStatement(ast.Call(callee)):
                word = fold(callee.text)
                return word in known or (id(node) in demanded and word not in IDLE)
            case _:
                return isinstance(node, ast.ExpressionStatement)

    return sum(map(constrains, nodes))


@cache
def _known_constraints() -> frozenset[str]:
    """Returns the names of the library's constraints, with their synonyms, folded."""
    known = library.load()
    names = {
        name
        for name, overloads in known.callables.items()
        if all(s.kind is ast.ConstraintDefinition for s in overloads)
    }
    others = {name for name in known.aliases if known.aliases[name] in names}
    return frozenset(map(fold, names | others))


def _outlook(state: Mended) -> object:
    """Returns a key of a state: the text without blanks, and its messages."""
    return "".join(state.source.text.split()), tuple(d.message for d in state.diagnostics)
