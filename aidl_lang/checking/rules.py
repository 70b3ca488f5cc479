"""The rules of what fits where, each once with the words of its misfit, and the words for types."""

from __future__ import annotations

from collections.abc import Callable

from aidl_lang.checking import units
from aidl_lang.checking.builtins import BOX
from aidl_lang.checking.types import (
    AnyType,
    GeometryType,
    ListType,
    NumberType,
    PointType,
    StructureType,
    Type,
)
from aidl_lang.checking.units import ANGLE, AREA, LENGTH, MaybeDimension
from aidl_lang.common.prose import shortened, with_article
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

# --- The words of the checker for types and for program text.

_LONGEST = 40


def a(kind: Type) -> str:
    """Returns a type with its article."""
    word = "thing" if isinstance(kind, AnyType) else str(kind)
    if isinstance(kind, NumberType) and kind.whole:
        word = "number" if kind.dimension is None else "whole number"
    return with_article(f"number in {word}" if word.startswith(("mm", "deg")) else word)


def shown(node: ast.Node) -> str:
    """Returns the text of an expression on one line, shortened if it is long."""
    return shortened(node.span.one_line, _LONGEST)


def place_before(node: ast.Node) -> Span:
    """Returns the place of what is put before an expression."""
    return Span(node.span.source, node.span.start, node.span.start)


def blocks(node: ast.For | ast.If) -> list[ast.Block]:
    """Returns the body of a loop, or the branches of an `if`."""
    return [child for child in ast.children(node) if isinstance(child, ast.Block)]


def in_box(kind: Type, text: str, other: Type) -> str | None:
    """Returns the text of a side or corner of a box that a part hides by its name, if that would compare with
    the other side: `table.bb.top` for `table.top`.
    """
    whole, _, name = text.rpartition(".")
    is_hiding = whole and isinstance(kind, GeometryType) and type(BOX.get(name)) is type(other)
    return f"{whole}.bb.{name}" if is_hiding else None


def comparison_hint(x: Type, y: Type, left: str, right: str) -> str:
    """Returns the hint for a comparison of things that have no order or equality."""
    if isinstance(x, ListType) or isinstance(y, ListType):
        return "compare their members one by one, in a `for`"
    for kind, text, other in ((x, left, y), (y, right, x)):
        if isinstance(kind, PointType) and isinstance(other, NumberType):
            return f"points compare with points; of one coordinate say `{text}.x` or `{text}.y`"
        if boxed := in_box(kind, text, other):
            return f"`{text}` is a part of that name; the side or corner of the box is `{boxed}`"
    kinds = GeometryType | StructureType
    if isinstance(x, kinds) and isinstance(y, kinds):
        return f"say what shall agree: `{left}.center == {right}.center`, `equal({left}, {right})`, …"
    return "numbers compare with numbers and points with points: name a field, as in `.width` or `.center`"


# The checker applies them to types that follow from the text, the builder to those that only values show.

FOUND = "depends on unknowns"
"""The label of an expression whose value the solver finds, but which is needed before."""


@record()
class TypeMisfit:
    """The diagnostic for an expression that does not fit its place."""

    code: str
    message: str
    hints: tuple[str, ...] = ()
    label: str = ""


def _refusal(code: str, message: str, *hints: str, label: str = "") -> Callable[..., TypeMisfit]:
    """Returns a function that refuses an expression in these words; a type in them gets its article."""

    def refused(*words: str | Type) -> TypeMisfit:
        said = (word if isinstance(word, str) else a(word) for word in words)
        return TypeMisfit(code, message.format(*said), hints, label)

    return refused


needed = _refusal("E0302", "{} is needed here, and this is {}")
no_coordinate = _refusal("E0301", "a coordinate must be a length, and `{}` is {}")
no_run = _refusal(
    "E0304",
    "`for` runs through a range or a list, and this is {}",
    "as in `for i in 0..9 { … }` or `for s in [-1, 1] { … }`",
)
no_members = _refusal("E0305", "`{}` is {} and has no members by number")
list_on_a_line = _refusal(
    "E0305",
    "this `[` goes on with the line above: `{}` is {} and has no members by number",
    "a list of things stands in a call: `centered_in([a, b], c)`, `align_left(a, b, c)`",
)
no_whole_number = _refusal("E0302", "{} must be a whole number, not {}")
fraction = _refusal("E0306", "{} must be a whole number, and this is `{}`")
no_order = _refusal(
    "E0309", "points have no order, so `{}` does not compare them", "compare coordinates, as in `a.x <= b.x`"
)
no_domain = _refusal("E0314", "the range of a `param` is as `20..200` or a list of choices, not {}")
unknown_yet = _refusal(
    "E0501",
    "{} must be known before solving, and `{}` is found by the solver",
    "use a `param`, a `let` of constants or a loop variable; `written(…)` is the value as written",
    label=FOUND,
)
undecided = _refusal(
    "E0502",
    "`{}` is decided by the solver, so it cannot choose what is built",
    "compare `param`s and constants, or use `written(…)` for the value as written",
    label=FOUND,
)


def no_equation(word: str, hint: str) -> TypeMisfit:
    """Refuses `or`, `not` and `!=` as constraints."""
    return TypeMisfit("E0322", f"`{word}` does not constrain: there are many ways to satisfy it", (hint,))


def unwanted(what: str, wanted: Type, kind: Type, text: str) -> TypeMisfit:
    """Refuses an expression of another type than a word such as `at` or `rotated` wants."""
    hints: tuple[str, ...] = ()
    if isinstance(wanted, PointType) and isinstance(kind, NumberType):
        hints = (f"as in `at ({text}, 0)`",)
    elif isinstance(kind, GeometryType):
        hints = (f"name a part of it: `{text}.center`",)
    return TypeMisfit("E0302", f"{what} wants {a(wanted)}, and this is {a(kind)}", hints)


def no_vectors(operator: str, left: Type, right: Type, left_text: str, right_text: str) -> TypeMisfit:
    """Refuses an operator between points, or a point and a number, that has no meaning there."""
    hint = "points take `+` and `-` with points, `*` and `/` with numbers; see also `dot` and `cross`"
    if operator in "+-" and (isinstance(left, NumberType) or isinstance(right, NumberType)):
        text = right_text if isinstance(left, NumberType) else left_text
        hint = "to move a point, add a point: `p + (dx, dy)`"
        if not text.startswith("("):
            hint = f"a coordinate is `{text}.x` or `{text}.y`; {hint}"
    return TypeMisfit("E0307", f"`{operator}` does not work on {a(left)} and {a(right)}", (hint,))


def unequal(what: str, left: MaybeDimension, right: MaybeDimension) -> TypeMisfit:
    """Refuses two numbers of different dimensions, as `length + angle`, for the operation `what`."""
    hint = "both sides need the same dimension; units are written as in `30deg`, `4mm`"
    if {left, right} == {LENGTH, units.multiply(LENGTH, ANGLE)}:  # as the length of an arc is often written
        hint = "an angle times a radius is no length: an arc is `radians(angle) * radius` long"
    if {left, right} == {LENGTH, AREA}:
        hint = (
            "a length times a length is an area, also with `unit(v)`, which is 1 mm long: "
            "divide by `1mm`, or write `polar(length, angle)`"
        )
    return TypeMisfit("E0308", f"{what} {a(NumberType(left))} and {a(NumberType(right))}", (hint,))


def no_comparison(relation: str, left: Type, right: Type, left_text: str, right_text: str) -> TypeMisfit:
    """Refuses a comparison of two things that cannot be compared."""
    hint = comparison_hint(left, right, left_text, right_text)
    return TypeMisfit("E0309", f"`{relation}` does not compare {a(left)} with {a(right)}", (hint,))


def no_condition(text: str, kind: Type) -> TypeMisfit:
    """Refuses an expression in place of a constraint."""
    hint = f"compare it with something: `{text} == …`"
    if isinstance(kind, NumberType):
        hint = f"say what it shall be: `{text} == …` or `{text} <= …`"
    elif isinstance(kind, GeometryType | StructureType | PointType):
        hint = f"say what about it, as in `fixed({text})`, `horizontal({text})` or `{text}.center == …`"
    return TypeMisfit("E0321", f"`{text}` is {a(kind)} and constrains nothing", (hint,))
