"""Calls with another meaning in other languages: squares, angles, corners and flags."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from aidl_lang.checking.builtins import MATH
from aidl_lang.checking.resolving.declare import made_by
from aidl_lang.checking.resolving.symbols import SymbolKind
from aidl_lang.checking.rules import shown
from aidl_lang.checking.types import AnyType, Binding, ListType, NumberType, PointType
from aidl_lang.checking.units import ANGLE, PLAIN
from aidl_lang.common.diagnostics import Edit, Fix, has_errors
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.infer import Inference


def check_habits(check: Inference, node: ast.Call, nodes: Sequence[ast.Expression], fit: Binding) -> None:
    """Notes how a call was read if the same words mean something else in other languages."""
    _check_angles(check, node, nodes, fit)
    _check_corner(check, node, fit)
    if not fit.sources:
        return
    first = len(nodes) - len(node.arguments)
    used = {index for s in fit.sources for index in (s.index, s.other)}
    for index, argument in enumerate(node.arguments, first):
        is_true = isinstance(argument.value, ast.Boolean) and argument.value.value
        if index not in used and not is_true:
            check.report(
                "E0347",
                f"`{shown(argument)}` says nothing: a `{node.callee.text}` is placed by its centre",
                argument,
                hints=["to place a corner, constrain it, as in `plate.bottom_left == (0, 0)`"],
            )
    name = fit.signature.name
    if name == "square" and first == 0 and not any(a.name for a in node.arguments[:1]):
        value = node.arguments[0].value
        check.report(
            "N0502",
            f"`{shown(node)}` is about its centre, here as everywhere",
            node,
            hints=["for one that begins at the origin: `constrain s.bottom_left == origin`"],
            fix=Fix("name the size", (Edit(_before(value), "size: "),), is_sure=True),
        )
    pair = next((s for s in fit.sources if s.other is not None and "width" in fit.signature.by_fold), None)
    if pair is not None and pair.other is not None:
        x, y = node.arguments[pair.index - first], node.arguments[pair.other - first]
        point = f"center: ({x.value.span.text}, {y.value.span.text})"
        is_both = pair.other == pair.index + 1
        both = Span(x.span.source, x.span.start, y.span.end)
        check.report(
            "N0503",
            f"`{shown(x)}` and `{shown(y)}` are read as the centre of the `{node.callee.text}`",
            x,
            hints=["to place a corner, constrain it, as in `plate.bottom_left == (0, 0)`"],
            fix=Fix(f"write `{point}`", (Edit(both, point),), is_sure=True) if is_both else None,
        )


def _check_corner(check: Inference, node: ast.Call, fit: Binding) -> None:
    """Reports `rectangle(5, 5, 40, 20)`: a corner and a size, or four sides."""
    names = [name for name, _, _ in fit.signature.parameters]
    if fit.signature.name != "rectangle" or len(node.arguments) != 4 or "left" not in names[:1]:
        return
    if any(argument.name is not None for argument in node.arguments):
        return
    x, y, w, h = (shown(argument.value) for argument in node.arguments)
    right = f"left: {x}, bottom: {y}, width: {w}, height: {h}"
    span = Span(node.span.source, node.arguments[0].span.start, node.arguments[-1].span.end)
    check.report(
        "E0344",
        f"`{shown(node)}` could mean a corner and a size, or four sides",
        node,
        label="say which",
        hints=["name them: `left`, `bottom` with `width`, `height` or with `right`, `top`"],
        fix=Fix(f"write `{right}`", (Edit(span, right),)),
    )


def check_unused_geometry(check: Inference) -> None:
    """Notes a `let c = circle(…)` that nothing refers to, which draws nothing by itself."""
    resolution = check.resolution
    used = {symbol for node, symbol in resolution.uses.items() if isinstance(node, ast.Name | ast.Member)}
    for symbol in resolution.symbols:
        node, scope = symbol.node, symbol.scope
        if not isinstance(node, ast.Let) or not isinstance(node.value, ast.Call) or symbol in used:
            continue
        if scope is None or not isinstance(scope.owner, ast.Structure | ast.Module):
            continue
        if made_by(node.value, scope) in (SymbolKind.GEOMETRY, SymbolKind.STRUCTURE):
            word = Span(node.span.source, node.span.start, node.name.span.start)
            check.report(
                "N0505",
                f"`{symbol.name}` is not drawn: nothing refers to it",
                node.name,
                label="`let` only names it",
                hints=[f"`{symbol.name} = {shown(node.value)}` makes it a part of the drawing"],
                fix=Fix("leave out `let`", (Edit(word, ""),)),
            )


def check_unused_params(check: Inference) -> None:
    """Notes a `param` of the program itself that nothing refers to; not after an error, which may have hidden
    a use.
    """
    resolution = check.resolution
    if has_errors([*resolution.diagnostics, *check.diagnostics]):
        return
    params = [s for s in resolution.symbols if isinstance(s.node, ast.Param)]
    used = {symbol for node, symbol in resolution.uses.items() if isinstance(node, ast.Name | ast.Member)}
    if used.issuperset(params):
        return
    unresolved = {
        node.name.text
        for module in resolution.modules
        for node in ast.walk(module)
        if isinstance(node, ast.Member) and node not in resolution.uses
    }
    for symbol in params:
        assert isinstance(symbol.node, ast.Param)
        is_own = symbol.node.span.source is resolution.main.source
        if is_own and symbol not in used and symbol.name not in unresolved:
            check.report(
                "W0201",
                f"`{symbol.name}` is used nowhere: setting it changes nothing",
                symbol.node.name,
                hints=["use it where its value is meant, or leave it out"],
            )


def _check_angles(check: Inference, node: ast.Call, nodes: Sequence[ast.Expression], fit: Binding) -> None:
    """Reports numbers of radians read as degrees, and the reverse."""
    called = _called(check, node)
    wanted = {name: kind for name, kind, _ in fit.signature.parameters}
    for index, value in enumerate(nodes):
        kind = wanted.get(fit.parameter_of(index) or "")
        if isinstance(kind, NumberType) and kind.dimension == ANGLE and _called(check, value) == "radians":
            assert isinstance(value, ast.Call)
            inner = value.arguments[0].value
            _not_degrees(check, value, inner, "deg", f"`{shown(value)}` is a plain number")
        elif called in _TRIGONOMETRY and _is_module(check, node) and _is_plain(check, value):
            _not_degrees(check, value, value, "rad", f"`{shown(node)}` is read in radians elsewhere")
        elif called == "degrees" and _is_written(check, value):
            message = f"`{shown(node)}` turns radians into an angle"
            _not_degrees(check, node, value, "deg", message, is_sure=False)


_TRIGONOMETRY = ("sin", "cos", "tan")


def _not_degrees(
    check: Inference,
    place: ast.Expression,
    value: ast.Expression,
    unit: str,
    message: str,
    is_sure: bool = True,
) -> None:
    """Reports an angle without its unit: the fix puts the one that is meant behind the number."""
    text = value.span.text
    if check.fact(value).type == NumberType(ANGLE):
        right = text
    elif isinstance(value, ast.Number):
        right = text + unit
    else:
        right = (
            f"{text} * 1{unit}"
            if isinstance(value, ast.Name | ast.Member | ast.Call)
            else f"({text}) * 1{unit}"
        )
    check.report(
        "E0348",
        f"{message}; an angle is written with its unit: `{right}`",
        place,
        hints=["a number without a unit is in degrees where an angle is due"],
        fix=Fix(f"write `{right}`", (Edit(place.span, right),), is_sure),
    )


def _called(check: Inference, node: ast.Expression) -> str | None:
    """Returns the name that an expression calls, with aliases resolved."""
    if not isinstance(node, ast.Call):
        return None
    return check.resolution.canonical.get(node.callee, node.callee.text)


def _is_module(check: Inference, node: ast.Call) -> bool:
    receiver = node.receiver
    symbol = check.resolution.uses.get(receiver) if isinstance(receiver, ast.Name) else None
    return symbol is not None and symbol.kind is SymbolKind.NAMESPACE and symbol.name in MATH


def _is_written(check: Inference, node: ast.Expression) -> bool:
    """Tells whether a number was written down without a unit, rather than worked out."""
    bare = check.fact(node).bare
    if isinstance(node, ast.Number):
        return not node.unit
    return bare is not None and bare.kind is SymbolKind.PARAM


def _is_plain(check: Inference, node: ast.Expression) -> bool:
    kind = check.fact(node).type
    return isinstance(kind, NumberType) and kind.dimension in (None, PLAIN)


def check_square(check: Inference, node: ast.Expression) -> None:
    """Reports `s = square(10)`, which could be a shape or a number."""
    if _called(check, node) != "square" or not isinstance(node, ast.Call) or len(node.arguments) != 1:
        return
    value = node.arguments[0].value
    kind = check.fact(value).type
    text = shown(value)
    if not isinstance(check.fact(node).type, NumberType | AnyType) or node.arguments[0].name is not None:
        return
    if isinstance(kind, NumberType):
        check.report(
            "E0344",
            f"`{shown(node)}` could mean a square of that size, or the number multiplied by itself",
            node,
            label="say which",
            hints=[f"write `square(size: {text})` for the shape, `{text} ^ 2` for the number"],
            fix=Fix("make it the shape", (Edit(_before(value), "size: "),)),
        )
    elif isinstance(kind, PointType) or (isinstance(kind, ListType) and kind.length == 2):
        two_sizes(check, node, node.arguments[0])


def _before(node: ast.Node) -> Span:
    return Span(node.span.source, node.span.start, node.span.start)


def two_sizes(check: Inference, node: ast.Call, argument: ast.Argument) -> None:
    start = argument.span.start
    name = Span(node.span.source, start, argument.value.span.start)
    check.report(
        "E0345",
        f"a square has one size; two make a rectangle: `rectangle(size: {shown(argument.value)})`",
        argument.value,
        label="two sizes",
        fix=Fix(
            "make it a rectangle", (Edit(node.callee.span, "rectangle"), Edit(name, "size: ")), is_sure=True
        ),
    )
