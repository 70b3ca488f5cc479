"""Arithmetic, vectors and comparisons: the operands that go together, and the types of the results."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from aidl_lang.checking import rules, units
from aidl_lang.checking.facts import Fact, body_of, is_number, is_point
from aidl_lang.checking.rules import a, in_box, shown
from aidl_lang.checking.types import (
    ANY,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    RangeType,
    TextType,
    TruthType,
)
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference


def unary(check: Inference, node: ast.Unary) -> Fact:
    if node.operator == "not":
        return Fact(TruthType(), check.wants(node.operand, "a condition", TruthType).reads)
    fact = check.fact(node.operand)
    return fact if isinstance(fact.type, PointType) else check.numeric(node.operand)


def binary(check: Inference, node: ast.Binary) -> Fact:
    if node.operator in ("and", "or"):
        sides = [check.wants(n, "a condition", TruthType) for n in (node.left, node.right)]
        return Fact(TruthType(), sides[0].reads | sides[1].reads)
    left, right = check.fact(node.left), check.fact(node.right)
    reads = left.reads | right.reads
    if left.is_any or right.is_any or isinstance(left.type, ListType) or isinstance(right.type, ListType):
        return Fact(ANY, reads)
    if node.operator == "+" and isinstance(left.type, TextType) and isinstance(right.type, TextType):
        return Fact(TextType(), reads)
    if is_point(left.type) or is_point(right.type):
        return _vector(check, node, left, right)
    left, right = check.numeric(node.left), check.numeric(node.right)
    if not isinstance(left.type, NumberType) or not isinstance(right.type, NumberType):
        return Fact(ANY, reads)
    return _arithmetic(check, node, left, right, left.type, right.type)


def _vector(check: Inference, node: ast.Binary, left: Fact, right: Fact) -> Fact:
    points = is_point(left.type), is_point(right.type)
    numbers = isinstance(left.type, NumberType), isinstance(right.type, NumberType)
    op = node.operator
    if (
        (all(points) and op in "+-")
        or (points[0] and numbers[1] and op in "*/")
        or (numbers[0] and op == "*")
    ):
        return Fact(PointType(), left.reads | right.reads)
    misfit = rules.no_vectors(op, left.type, right.type, shown(node.left), shown(node.right))
    sides = ((node.left, left, right), (node.right, right, left))
    for side, fact, other in sides:
        if isinstance(side, ast.Member) and (text := _meant_point(check, side, fact, other)) is not None:
            hints = misfit.hints
            if isinstance(fact.type, GeometryType):
                hints = (f"`{shown(side)}` is {a(fact.type)} of the outline; the corner is `{text}`",)
            fix = Fix(f"write `{text}`", (Edit(side.span, text),))
            return check.misfit(replace(misfit, hints=hints), node, fix)
    return check.misfit(misfit, node)


def _meant_point(check: Inference, node: ast.Member, fact: Fact, other: Fact) -> str | None:
    """Returns the point or coordinate that is meant by a member beside a point or a number:
    `plate.top_left` by the arc `plate.corner_top_left`, `disc.top.y` by the point `disc.top`.
    """
    of, name = node.value.span.text, check.resolution.canonical.get(node.name, node.name.text)
    if is_number(other.type) and isinstance(fact.type, PointType):
        axis = {"top": "y", "bottom": "y", "left": "x", "right": "x"}.get(name)
        return f"{of}.{name}.{axis}" if axis else None
    corner = name.removeprefix("corner_")
    whole = check.fact(node.value).of
    if corner == name or whole is None or not is_point(other.type):
        return None
    return f"{of}.{corner}" if corner in body_of(check, whole).values else None


def _arithmetic(
    check: Inference, node: ast.Binary, left: Fact, right: Fact, x: NumberType, y: NumberType
) -> Fact:
    reads = left.reads | right.reads
    op = node.operator
    if op == "%":
        for operand in (node.left, node.right):
            if not check.known(operand, "an operand of `%`"):
                break
    if op in "+-%":
        dimension = check.same_dimension(left, right, node, f"`{op}` does not join")
        bare = left.bare or right.bare if dimension is None else None
        return Fact(NumberType(dimension, x.whole and y.whole), reads, bare=bare)
    if op == "^":
        if x.dimension in (None, units.PLAIN):
            return Fact(NumberType(x.dimension), reads)
        return Fact(ANY, reads)
    if (x.dimension is None) != (y.dimension is None) and not _is_plain(
        node.left if x.dimension is None else node.right
    ):
        return Fact(ANY, reads)  # a bare param may be a length or a plain number, which only building shows
    combine = units.multiply if op == "*" else units.divide
    return Fact(NumberType(combine(x.dimension, y.dimension), op == "*" and x.whole and y.whole), reads)


def comparison(check: Inference, node: ast.Comparison) -> Fact:
    facts = [check.fact(operand) for operand in node.operands]
    for i, operator in enumerate(node.operators):
        compare(check, operator, node.operands[i], node.operands[i + 1], node)
    return Fact(TruthType(), frozenset().union(*(f.reads for f in facts)))


def compare(
    check: Inference, operator: str, left: ast.Expression, right: ast.Expression, node: ast.Node
) -> None:
    """Reports two sides that cannot be compared."""
    x, y = check.fact(left), check.fact(right)
    if x.is_any or y.is_any:
        return
    if is_number(x.type) and is_number(y.type):
        check.same_dimension(
            check.numeric(left), check.numeric(right), node, f"`{operator}` does not compare"
        )
        return
    if is_point(x.type) and is_point(y.type):
        if operator not in ("==", "!="):
            check.misfit(rules.no_order(operator), node)
        return
    if isinstance(x.type, ListType) or isinstance(y.type, ListType):
        return
    if type(x.type) is type(y.type) and isinstance(x.type, TextType | TruthType) and operator in ("==", "!="):
        return
    misfit = rules.no_comparison(operator, x.type, y.type, shown(left), shown(right))
    sides = ((left, x.type, y.type), (right, y.type, x.type))
    boxed = ((side, in_box(kind, side.span.text, other)) for side, kind, other in sides)
    fix = next((Fix(f"write `{text}`", (Edit(side.span, text),)) for side, text in boxed if text), None)
    check.misfit(misfit, node, fix)


def membership(check: Inference, node: ast.Membership) -> Fact:
    value, container = (
        check.fact(node.value),
        check.wants(node.container, "a range or a list", RangeType, ListType),
    )
    if isinstance(node.container, ast.Range) and isinstance(container.type, RangeType):
        compare(check, ">=", node.value, node.container.start, node)
        if not isinstance(node.container.end, ast.Number):
            compare(check, "<=", node.value, node.container.end, node)
    return Fact(TruthType(), value.reads | container.reads)


def _is_plain(node: ast.Expression) -> bool:
    """Tells whether a number without a unit can only be plain: it is made of digits alone."""
    return all(isinstance(n, ast.Number | ast.Unary | ast.Binary) for n in ast.walk(node))
