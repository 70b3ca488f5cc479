"""What can constrain, and what stands where a constraint is expected."""

from __future__ import annotations

from aidl_lang import ast
from aidl_lang.checking.infer import Inference
from aidl_lang.checking.wording import a, shown
from aidl_lang.diagnostics import Edit, Fix
from aidl_lang.resolving.declare import made_by
from aidl_lang.resolving.symbols import SymbolKind
from aidl_lang.source import Span
from aidl_lang.types import AnyType, GeometryType, NumberType, PointType, StructureType, TruthType

_OPERATIONS = frozenset({"rotate", "move", "translate", "scale", "fillet", "chamfer"})
"""Calls that are statements of their own: they edit what was written, and are no conditions."""


def check_operation(infer: Inference, node: ast.Expression) -> bool:
    """Whether a statement is an operation on geometry; its arguments are checked."""
    if not isinstance(node, ast.Call):
        return False
    name = infer.resolution.canonical.get(node.callee, node.callee.text)
    if name not in _OPERATIONS:
        return False
    infer.fact(node)
    return True


def check_condition(infer: Inference, node: ast.Expression) -> None:
    """Report an expression that cannot constrain anything."""
    fact = infer.fact(node)
    if isinstance(fact.type, TruthType):
        _check_logic(infer, node)
        return
    if isinstance(node, ast.Call):
        name = infer.resolution.canonical.get(node.callee, node.callee.text)
        if name == "fixed":
            return  # holds a thing where it was written
        scope = infer.resolution.scopes[infer.homes[-1]]
        if made_by(node, scope) is not SymbolKind.LET:
            _needs_name(infer, node)
            return
    if isinstance(fact.type, AnyType):
        return
    text = shown(node)
    hint = f"compare it with something: `{text} == …`"
    if isinstance(fact.type, NumberType):
        hint = f"say what it shall be: `{text} == …` or `{text} <= …`"
    elif isinstance(fact.type, GeometryType | StructureType | PointType):
        hint = f"say what about it, as in `fixed({text})`, `horizontal({text})` or `{text}.center == …`"
    infer.report("E0321", f"`{text}` is {a(fact.type)} and constrains nothing", node, hints=[hint])


def _needs_name(infer: Inference, node: ast.Call) -> None:
    kind = node.callee.text
    taken = {symbol.name for symbol in infer.resolution.symbols}
    number = next(n for n in range(1, len(taken) + 2) if f"{kind}_{n}" not in taken)
    name = f"{kind}_{number}"
    start = Span(node.span.source, node.span.start, node.span.start)
    infer.report(
        "E0323",
        f"this `{kind}` has no name, so nothing could refer to it",
        node,
        label="made and lost",
        hints=[f"give it a name: `{name} = {shown(node)}`"],
        fix=Fix(f"name it `{name}`", (Edit(start, f"{name} = "),)),
    )


def _check_logic(infer: Inference, node: ast.Expression) -> None:
    """`or`, `not` and `!=` leave the solver no equation; over constants they are checked while building."""
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
    message = f"`{word}` does not constrain: there are many ways to satisfy it"
    infer.report("E0322", message, node, hints=[hint], fix=fix)
