"""The checks of constraints: which expressions can constrain, and which stand in the place of one."""

from __future__ import annotations

from aidl_lang.checking import rules
from aidl_lang.checking.builtins import EDITS, FINISHES, PRIMITIVE
from aidl_lang.checking.calls import arguments
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.resolving.declare import made_by
from aidl_lang.checking.resolving.symbols import SymbolKind
from aidl_lang.checking.rules import shown
from aidl_lang.checking.types import AnyType, GeometryType, StructureType, TruthType
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

_OPERATIONS = EDITS | FINISHES
"""Calls that are statements of their own: they edit the drawing, and are no conditions."""


def check_operation(infer: Inference, node: ast.Expression) -> bool:
    """Checks the arguments of an operation on geometry. Returns whether the statement is one."""
    if not isinstance(node, ast.Call):
        return False
    if _called(infer, node) not in _OPERATIONS:
        return False
    infer.fact(node)
    return True


def _called(infer: Inference, node: ast.Call) -> str:
    return infer.resolution.canonical.get(node.callee, node.callee.text)


def operation(infer: Inference, node: ast.Expression) -> str | None:
    """Returns the name of the operation that an expression calls; None for anything else."""
    is_condition = isinstance(infer.fact(node).type, TruthType)
    if not isinstance(node, ast.Call) or is_condition:
        return None
    return name if (name := _called(infer, node)) in _OPERATIONS else None


def check_empty(infer: Inference, node: ast.Constrain) -> None:
    """Reports a `constrain { }` without anything in it."""
    if not node.items.statements and not node.items.span.text.strip("{} \t\r\n"):
        fix = Fix("remove it", (Edit(node.span.with_separator, ""),), is_sure=True)
        infer.report("W0202", "this `constrain` holds nothing", node, fix=fix)


def check_item(infer: Inference, node: ast.Expression) -> None:
    """Reports an operation among constraints, where nothing is made and nothing edited."""
    if (name := operation(infer, node)) is not None:
        text, fix = shown(node), None
        hints = [f"`{text}` is a statement of its own, outside `constrain`"]
        if name == "rotate":
            said = _turned(infer, node)
            fix = Fix(f"write `{said}`", (Edit(node.span, said),), is_sure=True) if said else None
            example = "" if said else ": `a.angle == 30deg`, for a structure `a.rotation == 30deg`"
            hints = [f"how a thing is turned is an equation too{example}"]
        elif name in EDITS:
            hints = [
                "where a thing has to be says a relation: `a.left == b.right`, `a.above(b)`, "
                "`coincident(a.end, b.start)`",
                f"outside `constrain`, `{text}` changes what was written, and `name = {text}` makes a copy; "
                "a structure is placed by `at`",
            ]
        message = f"`{name}` constrains nothing: it changes what is drawn"
        infer.report("E0352", message, node, hints=hints, fix=fix)
        return
    check_condition(infer, node, may_make=False)


def _turned(infer: Inference, node: ast.Expression) -> str | None:
    """Returns the equation that `rotate(r, 30)` among constraints is meant to be; None for what has no
    angle.
    """
    given = arguments(infer, node) if isinstance(node, ast.Call) else []
    if len(given) not in (2, 3):
        return None
    thing, angle, *about = given
    if about and shown(about[0]) != f"{shown(thing)}.center":
        return None
    fact, field = infer.fact(thing), "angle"
    if isinstance(fact.type, StructureType):
        field = "rotation"
    elif not isinstance(fact.type, GeometryType) or not (
        infer.resolution.scope_of(fact.of).values if fact.of else PRIMITIVE.get(fact.type.kind, {})
    ).get(field):
        return None
    unit = "deg" if isinstance(angle, ast.Number) and not angle.unit else ""
    return f"{shown(thing)}.{field} == {shown(angle)}{unit}"


def check_condition(infer: Inference, node: ast.Expression, may_make: bool = True) -> None:
    """Reports an expression that cannot constrain anything; `may_make`: with a name it would be geometry."""
    fact = infer.fact(node)
    if isinstance(fact.type, TruthType):
        _check_logic(infer, node)
        return
    if isinstance(node, ast.Call):
        if _called(infer, node) == "fixed":
            return  # holds a thing where it was written
        scope = infer.resolution.scopes[infer.homes[-1]]
        if made_by(node, scope) is not SymbolKind.LET:
            _needs_name(infer, node, may_make)
            return
    if isinstance(fact.type, AnyType):
        return
    infer.misfit(rules.no_condition(shown(node), fact.type), node)


def _needs_name(infer: Inference, node: ast.Call, may_make: bool) -> None:
    kind = node.callee.text
    taken = {symbol.name for symbol in infer.resolution.symbols}
    number = next(n for n in range(1, len(taken) + 2) if f"{kind}_{n}" not in taken)
    name = f"{kind}_{number}"
    start = Span(node.span.source, node.span.start, node.span.start)
    remedy = "give it a name" if may_make else "make it outside `constrain`"
    infer.report(
        "E0323",
        f"this `{kind}` has no name, so nothing could refer to it",
        node,
        label="made and lost",
        hints=[f"{remedy}: `{name} = {shown(node)}`"],
        fix=Fix(f"name it `{name}`", (Edit(start, f"{name} = "),), is_sure=True) if may_make else None,
    )


def _check_logic(infer: Inference, node: ast.Expression) -> None:
    """Reports `or`, `not` and `!=` over unknowns, which leave the solver no equation; over constants they are
    checked while building.
    """
    match node:
        case ast.Binary(operator="and", left=left, right=right):
            _check_logic(infer, left)
            _check_logic(infer, right)
        case ast.Binary(operator="or", left=left, right=right) if infer.fact(node).reads:
            _cannot(
                infer,
                node,
                "or",
                f"constrain the one you mean, as in `constrain {shown(left)}`, or let an `if` over "
                "constants choose; `assert` takes `or`",
                Fix("constrain the first of them", (Edit(node.span, left.span.text),)),
            )
        case ast.Unary(operator="not", operand=operand) if infer.fact(node).reads:
            _cannot(
                infer,
                node,
                "not",
                f"constrain what shall hold instead; `assert not {shown(operand)}` checks it",
            )
        case ast.Comparison(operators=operators) if "!=" in operators and infer.fact(node).reads:
            _cannot(infer, node, "!=", "say on which side, with `<=` or `>=` and a distance, or `assert` it")
        case _:
            pass


def _cannot(infer: Inference, node: ast.Expression, word: str, hint: str, fix: Fix | None = None) -> None:
    infer.misfit(rules.no_equation(word, hint), node, fix)
