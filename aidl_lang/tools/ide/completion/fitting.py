"""The kinds of things that each constraint takes, from the reference's table of all pairs.

That table was made by compiling a program for each of its cells.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache

from aidl_lang.checking.facts import Fact
from aidl_lang.checking.types import GeometryType, ListType, NumberType, PointType, StructureType, Type
from aidl_lang.common.records import record
from aidl_lang.common.resources import resource

_TABLE = "docs/reference/coverage.md"
_FORM = re.compile(r"^`([^`]+)`(?:: (.*))?$")
_ROW = re.compile(r"^\| \*\*(\w+)\*\* \|(.*)\|$")
_MARK = "●"
_HEAD = "| a ╲ b |"


@record()
class Form:
    """A form of a constraint of `a`, or of `a` and `b`, and the kinds of things it takes; `second` is "" for
    a single one.
    """

    name: str
    text: str
    pairs: frozenset[tuple[str, str]]


@cache
def forms() -> Mapping[str, tuple[Form, ...]]:
    """Returns the forms of each constraint of the library, in the order of the reference."""
    return read(resource(_TABLE).read_text("utf-8"))


@cache
def kinds() -> tuple[str, ...]:
    """Returns the kinds of things, as the heads of the tables name them."""
    lines = resource(_TABLE).read_text("utf-8").splitlines()
    head = next(line for line in lines if line.startswith(_HEAD))
    return tuple(cell.strip() for cell in head.removeprefix(_HEAD).removesuffix("|").split("|"))


def read(page: str) -> Mapping[str, tuple[Form, ...]]:
    found: dict[str, list[Form]] = {}
    name = ""
    for line in page.splitlines():
        if line.startswith("## "):
            name = line[3:].strip()
        elif name and (form := _FORM.match(line)):
            found.setdefault(name, []).append(Form(name, form[1], _told(form[2] or "")))
        elif name in found and (row := _ROW.match(line)):
            cells = [cell.strip() == _MARK for cell in row[2].split("|")]
            more = {(row[1], kind) for kind, works in zip(kinds(), cells, strict=True) if works}
            last = found[name][-1]
            found[name][-1] = Form(last.name, last.text, last.pairs | more)
    return {name: tuple(listed) for name, listed in found.items()}


def _told(words: str) -> frozenset[tuple[str, str]]:
    """Parses `any two, but no number`, or the kinds of a single thing."""
    if words.startswith("any two"):
        but = {word.strip() for word in re.split(r", but no | and no ", words)[1:]}
        left = [kind for kind in kinds() if kind not in but]
        return frozenset((a, b) for a in left for b in left)
    return frozenset((kind, "") for kind in re.split(r",\s*", words) if kind in kinds())


def kind_of(fact: Fact) -> str:
    """Returns the kind of a thing in that table; "" for a thing that is not in it."""
    return _kind(fact.type, is_unknown=bool(fact.reads))


def _kind(kind: Type, *, is_unknown: bool) -> str:
    match kind:
        case PointType():
            return "point" if is_unknown else ""
        case GeometryType(name) if name in kinds():
            return name
        case GeometryType():
            return "shape"
        case StructureType():
            return "structure"
        case ListType():
            return "list" if is_unknown else ""
        case NumberType():
            return "number" if is_unknown else ""
        case _:
            return ""
