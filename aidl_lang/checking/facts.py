"""What is known of an expression before anything is built."""

from __future__ import annotations

from dataclasses import replace

from aidl_lang.checking.resolving.symbols import Symbol
from aidl_lang.checking.types import ANY, AnyType, GeometryType, ListType, NumberType, PointType, Type
from aidl_lang.common.records import record
from aidl_lang.syntax import ast


@record(slots=True)
class Place:
    """Whose unknowns are read: the structure at the path `below`, seen from the structure `holder` that the
    program text is in (or from the file).
    """

    holder: ast.Node
    below: tuple[str, ...] = ()


NOTHING_READ: frozenset[Place] = frozenset()


@record(slots=True)
class Fact:
    """
    type   of the value
    reads  the structures whose unknowns the value depends on; empty for constants, and where it is not known
    of     the definition whose members it has (a list: its elements): structure, template, shape, or file
    place  for a structure, where it stands
    bare   the param or let whose number without a unit it is
    pattern  the operation that laid the members of an array out
    """

    type: Type = ANY
    reads: frozenset[Place] = NOTHING_READ
    of: ast.Node | None = None
    place: Place | None = None
    bare: Symbol | None = None
    pattern: str = ""

    @property
    def is_any(self) -> bool:
        return isinstance(self.type, AnyType)

    def reading(self, reads: frozenset[Place]) -> Fact:
        return replace(self, reads=reads)

    def listed(self, times: int = 1) -> Fact:
        """A list of such values, or a list of lists."""
        kind = self.type
        for _ in range(times):
            kind = ListType(kind)
        return Fact(kind, self.reads, self.of, self.place, None, "" if times else self.pattern)

    def element(self) -> Fact:
        """A member of a list of such values."""
        kind = self.type.element if isinstance(self.type, ListType) else ANY
        return replace(self, type=kind, pattern="")


UNKNOWN = Fact()


def joined(a: Fact, b: Fact) -> Fact:
    """What is known of a value that is one of two."""
    reads = a.reads | b.reads
    if a.type == b.type and a.of is b.of:
        return Fact(a.type, reads, a.of, a.place if a.place == b.place else None)
    return Fact(ANY, reads)


def is_point(kind: Type) -> bool:
    return isinstance(kind, PointType) or kind == GeometryType("point")


def is_number(kind: Type) -> bool:
    """A number, or an edge that stands for its coordinate."""
    return isinstance(kind, NumberType) or kind == GeometryType("line")
