"""Diagnostics for names that are unknown, ambiguous, or used before they exist."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from aidl_lang.checking.builtins import WORDS
from aidl_lang.checking.resolving.foreign import call_answer, value_hint
from aidl_lang.checking.resolving.symbols import UNKNOWNS, Symbol, SymbolKind, SymbolScope, word_meant
from aidl_lang.checking.synonyms import FIELDS, PARAMETERS
from aidl_lang.checking.types import Signature
from aidl_lang.common.diagnostics import Edit, Fix, Label
from aidl_lang.common.names import fold, is_like, is_slip, nearest
from aidl_lang.common.prose import first_few, ticked
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.resolve import Resolver


def no_declaration(resolver: Resolver, name: ast.Name, is_value: bool) -> None:
    """Reports `h = …` among constraints with a new name: it compares, but was meant to declare one."""
    start = Span(name.span.source, name.span.start, name.span.start)
    resolver.report(
        "E0201",
        f"there is no `{name.text}` here; among constraints `=` compares",
        name,
        label="not declared",
        hints=(f"`let {name.text} = …` names an expression; geometry is made outside",),
        fix=Fix("declare it with `let`", (Edit(start, "let "),)) if is_value else None,
    )


def unknown_name(resolver: Resolver, node: ast.Name, scope: SymbolScope) -> None:
    """Reports a bare name that no scope has as a value."""
    name = node.text
    if scope.may_be_missing(name) or resolver.has_said_enough:
        return
    given = resolver.argument.arguments if resolver.argument is not None else ()
    if any(a.value is node for a in given) and word_meant(name, WORDS) is not None:
        resolver.resolution.uses[node] = Symbol(name, SymbolKind.WORD)
        return
    called = scope.called(name)
    if called is not None:
        kind = kind_of(called[1][0])
        resolver.report(
            "E0206",
            f"`{name}` is a {kind} and has to be called: `{name}(…)`",
            node,
            label="a name alone means a value",
        )
        return
    hint = value_hint(name)
    like = ["self"] if fold(name) == "this" else scope.near_values(name) if hint is None else []
    hints: tuple[str, ...] = (hint,) if hint else ()
    if not like and not hints:
        hints = ("names are declared with `param`, `let` or `name = …`",)
    declared = scope.value(like[0]) if like else None
    secondary = (
        (Label(declared.declarations[0].span, "declared here"),) if declared and declared.declarations else ()
    )
    resolver.report(
        "E0201",
        f"there is no `{name}` here" + did_you_mean(like),
        node,
        label="not declared",
        secondary=secondary,
        hints=hints,
        fix=respell(node, like),
    )


def unknown_callable(resolver: Resolver, node: ast.Call, scope: SymbolScope) -> None:
    name = node.callee.text
    if scope.may_be_missing(name) or resolver.has_said_enough:
        return
    value = scope.value(name)
    if value is not None and value.kind is not SymbolKind.BUILTIN:
        declared = (Label(value.declarations[0].span, "declared here"),) if value.declarations else ()
        hint, fix = f"`{name}` alone names it", None
        if isinstance(value.node, ast.Structure):
            fix = _as_template(value.node)
            hint = (
                f"with a parameter list, `{value.node.kind} {name}() {{ … }}`, it is a template to be called"
            )
        resolver.report(
            "E0206",
            f"`{name}` is {value.kind.with_article} and cannot be called",
            node.callee,
            secondary=declared,
            hints=(hint,),
            fix=fix,
        )
        return
    if (answer := call_answer(node)) is not None:
        code, headline, hint = answer
        resolver.report(code, headline, node.callee, hints=(hint,) if hint else ())
        return
    if node.receiver is not None and not node.arguments and fold(name) in FIELDS:
        message, fix = called_field(node)
        resolver.report("E0206", message, node.callee, fix=fix)
        return
    is_condition = resolver.condition is node
    like = nearest(name, scope.callable_names(), 2)
    if is_condition and not (like and is_like(name, like[0]) and not _is_built_in(scope, like[0])):
        like = nearest(name, [n for n in scope.callable_names() if _may_hold(scope, n)], 2)
    hint = _RELATIONS if is_condition else "define it with `fn`, `shape` or as a template"
    is_meant = bool(like) and not _is_spelled_right(name, like[0], scope)
    is_safe = is_meant and (is_condition or not _only_holds(scope, like[0]))
    resolver.report(
        "E0203",
        f"there is no function, shape or constraint `{name}`" + did_you_mean(like),
        node.callee,
        hints=() if like else (hint,),
        fix=respell(node.callee, like) if is_safe else None,
    )


def _is_spelled_right(name: str, meant: str, scope: SymbolScope) -> bool:
    """Tells whether a word in which two names differ is a known one: `same_side` is no slip for
    `same_size`.
    """
    known = {word for other in scope.callable_names() for word in other.casefold().split("_")}
    known |= PARAMETERS.keys() | FIELDS
    words, others = name.casefold().split("_"), meant.casefold().split("_")
    return any(w in known for w, other in zip(words, others, strict=False) if w != other)


def _only_holds(scope: SymbolScope, name: str) -> bool:
    """Tells whether a callable is a constraint and nothing else: it makes nothing."""
    found = scope.called(name)
    return found is not None and all(kind_of(s) is SymbolKind.CONSTRAINT for s in found[1])


_RELATIONS = (
    "there are `coincident`, `tangent`, `equal`, `above`, `right_of`, `touching`, `centered_in`, "
    "`align_left` and more; what has no name is an equation: `a.top == b.bottom`"
)


def _may_hold(scope: SymbolScope, name: str) -> bool:
    """Tells whether a callable may be a condition: shapes and templates are none, nor is `sin`."""
    found = scope.called(name)
    made = (SymbolKind.SHAPE, SymbolKind.TEMPLATE)
    return (
        found is not None and all(kind_of(s) not in made for s in found[1]) and not _is_built_in(scope, name)
    )


def _is_built_in(scope: SymbolScope, name: str) -> bool:
    """Tells whether a callable is built in and holds of nothing."""
    found = scope.called(name)
    return found is not None and found[1][0].node is None and name not in ("fixed", "overlaps")


def _as_template(node: ast.Structure) -> Fix | None:
    """Returns the fix that gives a structure a parameter list, so that it can be called."""
    if node.indices:
        return None
    behind = Span(node.name.span.source, node.name.span.end, node.name.span.end)
    return Fix(f"make `{node.name.text}` a template", (Edit(behind, "()"),))


def called_field(node: ast.Call) -> tuple[str, Fix]:
    """Returns message and fix for a field that is called: `c.center()`."""
    at = node.callee.span
    parentheses = Edit(Span(at.source, at.end, node.span.end), "")
    message = f"`{node.callee.text}` is a field, which is named without parentheses"
    return message, Fix("leave out the parentheses", (parentheses,), is_sure=True)


def declared_twice(resolver: Resolver, name: ast.Identifier, earlier: Symbol) -> None:
    resolver.report(
        "E0209",
        f"`{name.text}` is declared twice",
        name,
        secondary=(Label(earlier.declarations[0].span, "declared here"),),
        hints=(
            "give one of them another name, or give both an index to make an array: "
            f"`{name.text}[0]`, `{name.text}[1]`",
        ),
    )


def check_aliases(resolver: Resolver, scope: SymbolScope) -> None:
    """Reports aliases that lead to nothing that can be called."""
    for symbol in scope.aliases.values():
        assert isinstance(symbol.node, ast.Alias)
        target = symbol.node.target
        if symbol.owner is not scope.owner or scope.called(symbol.name) is not None:
            continue
        trail = [symbol.name]
        while (step := scope.aliases.get(trail[-1])) is not None and isinstance(step.node, ast.Alias):
            trail.append(step.node.target.text)
            if trail[-1] in trail[:-1]:
                break
        if len(trail) > 1 and trail[-1] in trail[:-1]:
            resolver.report(
                "E0207",
                f"the alias `{symbol.name}` stands for itself: {' → '.join(trail)}",
                target,
                hints=("let one of them name a function, shape, constraint or template",),
            )
            continue
        like = nearest(target.text, [n for n in scope.callable_names() if n != symbol.name], 2)
        resolver.report(
            "E0203",
            f"there is no function, shape or constraint `{target.text}`" + did_you_mean(like),
            target,
            fix=respell(target, like),
        )


def is_below(node: ast.Name, symbol: Symbol, scope: SymbolScope) -> bool:
    """Tells whether a name stands above the line that makes what it means."""
    if symbol.kind not in UNKNOWNS or symbol.node is None or symbol.is_array:
        return False
    if symbol.scope is None or symbol.scope.homes != scope.homes:
        return False
    here, place = node.span, symbol.node.span
    return here.source is place.source and here.start < place.end


def check_order(resolver: Resolver, node: ast.Name, symbol: Symbol, scope: SymbolScope) -> None:
    """Reports geometry and unknowns used above their line; those of other structures are judged by
    validity.
    """
    if is_below(node, symbol, scope):
        hint = "write a first guess here, and the relation in `constrain`, which is read after the rest"
        used_early(resolver.report, node, symbol, *(meant_outside(symbol, node) or (hint,)))


def meant_outside(symbol: Symbol, use: ast.Node) -> tuple[str, Fix | None] | None:
    """Returns the hint and, where it reaches all uses, the fix for a name that hides another one in its own
    definition, `name = text(name)`; None if there is no other, or the use is elsewhere.
    """
    made, scope = symbol.node, symbol.scope and symbol.scope.parent
    outer = scope.value(symbol.name) if scope else None
    if outer is None or not outer.declarations or not isinstance(made, ast.Assign | ast.Let | ast.Param):
        return None
    if not made.span.start <= use.span.start < made.span.end:
        return None
    value, source = made.value, made.span.source
    name = f"{symbol.name}_{value.callee.text}" if isinstance(value, ast.Call) else f"own_{symbol.name}"
    hint = (
        f"here `{symbol.name}` is what this line makes; call that `{name}`, and `{symbol.name}` is the "
        f"{outer.kind} again"
    )
    if outer.name != symbol.name or re.search(rf"\.\s*{symbol.name}\b|\b{name}\b", source.text):
        return hint, None
    uses = (n for n in ast.walk(symbol.owner or made) if isinstance(n, ast.Name) and n.text == symbol.name)
    places = [made.name, *(n for n in uses if not made.span.start <= n.span.start < made.span.end)]
    return hint, Fix(f"name it `{name}`", tuple(Edit(n.span, name) for n in places), is_sure=True)


def used_early(
    report: Callable[..., object], node: ast.Node, symbol: Symbol, hint: str, fix: Fix | None = None
) -> None:
    """Reports a use above the line that makes the thing."""
    assert symbol.node is not None
    inside = node.span.start >= symbol.node.span.start
    report(
        "E0205",
        f"`{symbol.name}` is used in its own definition"
        if inside
        else f"`{symbol.name}` is used above the line that makes it",
        node,
        label="not there yet",
        secondary=() if inside else (Label(symbol.declarations[0].span, "made here"),),
        hints=(hint,),
        fix=fix,
    )


_KINDS = {
    ast.ShapeDefinition: SymbolKind.SHAPE,
    ast.ConstraintDefinition: SymbolKind.CONSTRAINT,
    ast.Structure: SymbolKind.TEMPLATE,
}


def kind_of(signature: Signature) -> SymbolKind:
    return _KINDS.get(signature.kind, SymbolKind.FUNCTION) if signature.kind else SymbolKind.FUNCTION


def did_you_mean(like: Sequence[str], mark: str = "") -> str:
    return f"; did you mean `{mark}{like[0]}`?" if like else ""


def respell(node: ast.Node, like: Sequence[str]) -> Fix | None:
    """Returns the fix that writes the nearest of the names that a name is like. It is sure if the name as
    written is a slip for that one and no other.
    """
    name = node.span.text
    if not like or not (is_like(name, like[0]) or like == ["self"]):
        return None
    is_sure = like == ["self"] or [other for other in like if is_slip(name, other)] == like[:1]
    return Fix(f"write `{like[0]}`", (Edit(node.span, like[0]),), is_sure)


def renamed(node: ast.Node, name: str) -> Fix:
    """Returns the fix that writes a name for one that means the same elsewhere."""
    return Fix(f"write `{name}`", (Edit(node.span, name),), is_sure=True)


def list_of(start: str, names: Sequence[str], mark: str = "") -> str:
    return start + (first_few(ticked(names, mark), 8, ", …") or "nothing")
