"""Notes and warnings that a program wants unsaid: `@allow("N0602")` before a statement.

What is silenced has its place within the statement and is no error. One that silenced nothing is told, once
it is known what there was to tell.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from aidl_lang.common import resources
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

IDLE = "N0201"

_LATER = frozenset({"N0731", "N0741", "W0720", "W0725", "W0726", "W0733", "W0736"})
"""Codes that are told only when a file is written or parts are measured."""
_OF_TEXT = ("N02", "W01", "W02")
"""Codes of what a text says, whatever the values of its params."""


@record()
class Allowance:
    """A code that is not to be told within a statement: `place` is where it is written, `attribute` the whole
    of the attribute, `is_alone` whether it has no other code, `may_come` whether there may be something to
    silence though nothing is found: when a file is written, or with other values of the params.
    """

    code: str
    statement: Span
    place: Span
    attribute: Span
    is_alone: bool
    may_come: bool

    def covers(self, found: Diagnostic) -> bool:
        here = self.statement
        if found.code != self.code or found.is_error or (span := found.span) is None:
            return False
        return span.source is here.source and here.start <= span.start and span.end <= here.end


def allowances(modules: Iterable[ast.Module]) -> tuple[tuple[Allowance, ...], list[Diagnostic]]:
    """Returns what the files of a program allow, and what is wrong with how they say it."""
    allowed: list[Allowance] = []
    wrong: list[Diagnostic] = []
    modules = list(modules)
    for statement, attribute in _attributes(modules):
        if not attribute.arguments:
            hint = 'write the codes of the notes and warnings: `@allow("N0602", "W0705")`'
            wrong.append(Diagnostic("E0216", "`@allow` names no code", attribute.span, hints=(hint,)))
        for argument in attribute.arguments:
            value = argument.value
            code = value.value if isinstance(value, ast.String) else value.span.text
            if code in resources.codes() and not code.startswith("E"):
                is_alone = len(attribute.arguments) == 1
                may_come = code in _LATER or not (code.startswith(_OF_TEXT) or _is_still(modules))
                places = statement.span, value.span, attribute.span
                allowed.append(Allowance(code, *places, is_alone, may_come))
            else:
                wrong.append(_unknown(code, value.span))
    return tuple(allowed), wrong


def _is_still(modules: Iterable[ast.Module]) -> bool:
    return not any(isinstance(node, ast.Param) for module in modules for node in ast.walk(module))


def _attributes(modules: Iterable[ast.Module]) -> Iterator[tuple[ast.Node, ast.Attribute]]:
    """Yields the statements with an `@allow`, those outside first."""
    for module in modules:
        if ast.ALLOW not in module.source.text.lower():
            continue
        for node in ast.walk(module):
            if isinstance(node, ast.Allowing | ast.Structure | ast.Assign):
                for attribute in ast.attributes(node):
                    if fold(attribute.name.text) == ast.ALLOW:
                        yield node, attribute


def _unknown(code: str, place: Span) -> Diagnostic:
    if code in resources.codes():
        message = f"`{code}` is an error, and only notes and warnings can be allowed"
        return Diagnostic("E0216", message, place, hints=(f"mend it: `aidl explain {code}` tells how",))
    codes = resources.codes()
    alike = [c for c in (code.upper(), *resources.near(code.upper())) if c in codes and c[0] != "E"]
    near = sorted(alike, key=lambda c: c[0] != code[:1].upper())[:1]
    message = f"there is no note or warning `{code}`" + (f"; did you mean `{near[0]}`?" if near else "")
    hints = () if near else ("codes stand in brackets in front of a message: `note[N0602]: …`",)
    fix = Fix(f"write `{near[0]}`", (Edit(place, f'"{near[0]}"'),)) if near else None
    return Diagnostic("E0216", message, place, hints=hints, fix=fix)


def audible(found: Iterable[Diagnostic], allowed: Sequence[Allowance]) -> list[Diagnostic]:
    """Returns the diagnostics without those that are allowed."""
    return [d for d in found if not any(each.covers(d) for each in allowed)]


def idle(found: Sequence[Diagnostic], allowed: Sequence[Allowance]) -> list[Diagnostic]:
    """Returns a note on each code that is allowed where `found`, all there is to tell, has none of it."""
    told: list[Diagnostic] = []
    for each in allowed:
        if not each.may_come and not any(each.covers(d) for d in found):
            message = f"`@allow` silences nothing: there is no `{each.code}` here"
            told.append(Diagnostic(IDLE, message, each.place, fix=_without(each)))
    return told


def _without(allowed: Allowance) -> Fix | None:
    if not allowed.is_alone:
        return None
    text, end = allowed.attribute.source.text, allowed.attribute.end
    end += len(text[end:]) - len(text[end:].lstrip())
    return Fix("remove it", (Edit(Span(allowed.attribute.source, allowed.attribute.start, end), ""),))
