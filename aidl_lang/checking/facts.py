"""Facts about an expression before anything is built: its type, and the unknowns it reads."""

from __future__ import annotations

from dataclasses import replace

from aidl_lang.checking.resolving.symbols import Symbol
from aidl_lang.checking.types import ANY, AnyType, GeometryType, ListType, NumberType, PointType, Type
from aidl_lang.common.records import record
from aidl_lang.syntax import ast


@record(slots=True)
class ReadPlace:
    """A structure whose unknowns are read: the one at the path `below`, seen from the structure `holder`
    around the program text (or from the file).
    """

    holder: ast.Node
    below: tuple[str, ...] = ()


NOTHING_READ: frozenset[ReadPlace] = frozenset()


@record(slots=True)
class Fact:
    """The facts about a value, as far as they are known.

    type   of the value
    reads  the structures whose unknowns the value depends on; empty for constants, and if it is not known
    of     the definition whose members it has (a list: its elements): structure, template, shape, or file
    place  of a structure
    bare   the param or let whose number without a unit it is
    pattern  the operation that laid out the members of an array
    """

    type: Type = ANY
    reads: frozenset[ReadPlace] = NOTHING_READ
    of: ast.Node | None = None
    place: ReadPlace | None = None
    bare: Symbol | None = None
    pattern: str = ""

    @property
    def is_any(self) -> bool:
        return isinstance(self.type, AnyType)

    def reading(self, reads: frozenset[ReadPlace]) -> Fact:
        return replace(self, reads=reads)

    def listed(self, times: int = 1) -> Fact:
        """Returns the fact of a list of such values, or of lists of lists."""
        kind = self.type
        for _ in range(times):
            kind = ListType(kind)
        return Fact(kind, self.reads, self.of, self.place, None, "" if times else self.pattern)

    def element(self) -> Fact:
        """Returns the fact of a member of a list of such values."""
        kind = self.type.element if isinstance(self.type, ListType) else ANY
        return replace(self, type=kind, pattern="")


UNKNOWN = Fact()


def joined(a: Fact, b: Fact) -> Fact:
    """Returns the facts that two alternative values have in common."""
    reads = a.reads | b.reads
    if a.type == b.type and a.of is b.of:
        return Fact(a.type, reads, a.of, a.place if a.place == b.place else None)
    return Fact(ANY, reads)


def is_point(kind: Type) -> bool:
    return isinstance(kind, PointType) or kind == GeometryType("point")


def is_number(kind: Type) -> bool:
    """Tells whether a type is a number, or an edge that stands for its coordinate."""
    return isinstance(kind, NumberType) or kind == GeometryType("line")
