"""The type wanted at a place, by the nodes around it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from aidl_lang.checking.infer import Inference
from aidl_lang.checking.types import (
    ANY,
    AnyType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RangeType,
    TextType,
    TruthType,
    Type,
    accepts,
    parameter_type,
)
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

_WHOLE = NumberType(None, whole=True)
_NUMBER = NumberType(LENGTH)
_PERHAPS = 3
"""Distance of an unknown type from the wanted one."""


@record()
class Wanted:
    """The wanted types, likelier first; empty for any. `name` is the parameter to fill."""

    types: tuple[Type, ...] = ()
    name: str = ""

    def distance(self, given: Type) -> int | None:
        """Returns how far a type is from the wanted ones; None if it does not fit. An unknown type may
        fit.
        """
        if isinstance(given, AnyType):
            return _PERHAPS
        found = [d for kind in self.types if (d := accepts(kind, given)) is not None]
        return min(found) if found else None if self.types else 0


CONDITION = Wanted((TruthType(),))
"""The type of a condition, which often begins with a value: `a.radius >= 3`."""


@record()
class Around:
    """The nodes around a place; `argument` returns the types wanted of an argument."""

    check: Inference
    argument: Callable[[], Wanted]

    def wanted(self, path: Sequence[ast.Node]) -> Wanted:
        """Returns the types wanted of the last node of a path."""
        if len(path) < 2:
            return Wanted()
        node, above = path[-1], path[-2]
        match above:
            case ast.Argument() | ast.Unary(operator="-" | "+"):
                return self.argument() if isinstance(above, ast.Argument) else self.wanted(path[:-1])
            case ast.Binary(operator="+" | "-", left=left, right=right):
                other = self.check.fact(right if node is left else left).type
                return _alike(other) if not isinstance(other, AnyType) else self.wanted(path[:-1])
            case ast.Binary(operator="and" | "or") | ast.Unary():
                return CONDITION
            case ast.Binary():
                return Wanted((_NUMBER, NumberType(None)))
            case ast.Comparison(operands=operands):
                return self._compared(node, operands)
            case ast.Equation(left=left, right=right):
                return self._compared(node, (left, right))
            case ast.Conditional(test=test):
                return CONDITION if node is test else self.wanted(path[:-1])
            case ast.ArgumentBlock() | ast.ForArguments() if not _is_run_through(node, above):
                return self.wanted(path[:-1])
            case ast.IfArguments(test=test):
                return CONDITION if node is test else self.wanted(path[:-1])
            case ast.List():
                return _member_of(self.wanted(path[:-1]))
            case _:
                return _of_place(node, above, path)

    def _compared(self, node: ast.Node, operands: tuple[ast.Expression, ...]) -> Wanted:
        """Returns the types comparable with the other sides."""
        facts = [self.check.fact(o) for o in operands if o is not node]
        known = next((f.type for f in facts if not isinstance(f.type, AnyType)), None)
        return _alike(known) if known is not None else Wanted()


def _is_run_through(node: ast.Node, above: ast.Node) -> bool:
    return isinstance(above, ast.For | ast.ForArguments | ast.Comprehension) and node is above.iterable


def _of_place(node: ast.Node, above: ast.Node, path: Sequence[ast.Node]) -> Wanted:
    """Returns the types that a statement, or another fixed place, wants."""
    match above:
        case ast.Point():
            return Wanted((NumberType(LENGTH),))
        case ast.Placement(at=at):
            return Wanted((PointType() if node is at else NumberType(ANGLE),))
        case ast.Membership(container=container) | ast.Param(domain=container) if node is container:
            return Wanted((RangeType(), ListType(ANY)))
        case ast.Range() | ast.Membership():
            return Wanted((_NUMBER, _WHOLE))
        case ast.For() | ast.ForArguments() | ast.Comprehension() if _is_run_through(node, above):
            return Wanted((ListType(ANY), RangeType()))
        case ast.Index() | ast.Structure() | ast.Assign() if _is_index(node, above):
            return Wanted((_WHOLE,))
        case ast.If(test=test) | ast.Assert(test=test) | ast.Prefer(value=test) if node is test:
            return CONDITION
        case ast.Assert():
            return Wanted((TextType(),))
        case ast.Prefer():
            return Wanted((NumberType(None),))
        case ast.ExpressionStatement():
            return CONDITION
        case ast.Parameter() if (kind := parameter_type(above)) is not None:
            return Wanted((kind,))
        case _:
            return Wanted()


def _is_index(node: ast.Node, above: ast.Index | ast.Structure | ast.Assign) -> bool:
    return node is above.index if isinstance(above, ast.Index) else node in above.indices


def _alike(kind: Type) -> Wanted:
    """Returns the types that may be compared with, or added to, a type."""
    match kind:
        case NumberType(dimension):
            return Wanted((NumberType(dimension), NumberType(None)))
        case GeometryType("line"):
            return Wanted((NumberType(LENGTH), kind))
        case _:
            return Wanted((kind,))


def _member_of(wanted: Wanted) -> Wanted:
    elements = [kind.element for kind in wanted.types if isinstance(kind, ListType)]
    known = tuple(kind for kind in elements if not isinstance(kind, AnyType))
    if not elements and PointType() in wanted.types:
        known = (NumberType(LENGTH),)
    return Wanted(known, wanted.name)
