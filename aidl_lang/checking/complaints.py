"""Diagnostics for names that are unknown, ambiguous, used too early, or of other languages."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from aidl_lang.checking.binding import FIELDS, PARAMETERS
from aidl_lang.checking.builtins import WORDS, word_set
from aidl_lang.checking.imports import exchanged
from aidl_lang.checking.rules import place_before
from aidl_lang.checking.symbols import UNKNOWNS, Symbol, SymbolKind, SymbolScope, word_meant
from aidl_lang.checking.types import Signature
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.names import fold, is_like, is_slip, nearest
from aidl_lang.common.prose import first_few, ticked
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.checking.resolve import Resolver


# --- Names of other languages and programs, with their counterparts here.


def _words(*lines: str) -> frozenset[str]:
    return frozenset(map(fold, word_set(*lines)))


def _by_word(*rows: tuple[str, str]) -> Mapping[str, str]:
    return {fold(word): said for words, said in rows for word in words.split()}


IDLE = _words(
    "solve build render show display draw plot view preview finish done run update compile commit",
    "export save write show_object export_svg export_dxf export_stl save_svg to_svg to_dxf write_svg",
    "print echo println log puts",
)
"""Calls that elsewhere start what happens here by itself, or write what the compiler writes."""

_SOLIDS = _words(
    "cube cuboid box3d cylinder cone sphere torus wedge3d prism polyhedron hull minkowski",
    "extrude linear_extrude rotate_extrude extrude_linear extrude_rotate revolve loft sweep shell",
)

_INSTEAD = _by_word(
    ("solid part body component module", "solid base { … }"),
    ("hole cut pocket", "hole bore { rim = circle(radius: 3) }"),
    ("assembly group compound", "assembly frame { … }"),
    ("drawing sketch workplane", "drawing plan { … }"),
)
"""Kinds of structures called like functions, and how a structure is written."""

_CALLS = _by_word(
    ("int trunc", "whole numbers come from `floor(x)`, `ceil(x)` or `round(x)`"),
    ("float number double", "numbers need no conversion"),
    ("pow power", "powers are written `x ^ 2`"),
    ("mod fmod", "the remainder is written `a % b`"),
    ("list array tuple", "lists are written `[1, 2, 3]`, or `[i * 10 for i in 0..3]`"),
    ("require ensure check", "what must hold is written `constrain …`, or `assert …` to check it at the end"),
    ("param parameter slider knob", "a parameter is declared by `param w = 80 in 20..200`"),
    ("var variable unknown", "an unknown is declared by `var gap = 5`"),
    ("linear_pattern pattern", "copies in a row are made by `linear_array(…)`"),
    ("circular_pattern", "copies about a centre are made by `polar_array(…)`"),
    ("if_then_else ternary select", "a choice is written `if c then a else b`"),
    (
        "thicker thinner thicker_than thinner_than higher lower",
        "sizes compare by `wider`, `narrower`, `taller` and `shorter`, or as numbers: "
        "`a.width <= b.width`; places by `above` and `below`",
    ),
    (
        "orient oriented rotated rotate_by rotate_to turn rotation_angle fixed_angle angle_constraint "
        "incline inclined inclination slope slant slanted skew skewed spin pivot",
        "how a thing is turned is an equation: `a.angle == 30deg`, for a structure `a.rotation == 30deg`",
    ),
    (
        "connect connects connected attach attaches attached join joins joined weld welded glue glued "
        "attached_to attach_to connected_to connect_to joined_to snap snapped mate mated "
        "fasten fastened link linked bond meet meets hinge hinged pinned",
        "points become one by `coincident(a.end, b.start)`, parts lie against each other by `touching(a, b)`",
    ),
)

_VALUES = _by_word(
    ("null none nil undefined nan", "every name has a value; leave an argument out to take its default"),
    ("new", "things are made without `new`: `c = circle(radius: 5)`"),
    ("lambda function", "functions are defined as `fn f(x) = 2 * x`"),
    ("inf infinity", "give a number that is large enough, or leave the bound out"),
    ("e euler", "write the number: `2.718281828`"),
    ("is equals", "equality is written `a == b`"),
    ("between", "a range is written `x in 3..5`"),
    ("model sketch doc part cq b3d wp workplane canvas", "constraints and geometry are written without it"),
)


_ROUND = "round corners are geometry: `rounded_rectangle(radius: 5, …)`, or `fillet(outline, 5)`"
ATTRIBUTES_MEANT: Mapping[str, tuple[str, str]] = {
    **dict.fromkeys(("fill", "fillcolor", "background", "paint"), ("color", "")),
    **dict.fromkeys(("strokewidth", "linewidth"), ("stroke", "")),
    **dict.fromkeys(("cornerradius", "radius", "rounded", "borderradius", "fillet"), ("", _ROUND)),
    **dict.fromkeys(("extrude", "depth"), ("thickness", "")),
}
"""Attributes of other languages, folded: the attribute that is meant, or a hint if it is none."""


def without_idle(module: ast.Module, modules: Sequence[ast.Module]) -> tuple[ast.Module, list[Diagnostic]]:
    """Returns a file without `solve()` and the like that none of the files defines, and a note on each."""
    statements = (node for node in ast.walk(module) if isinstance(node, ast.ExpressionStatement))
    idle = {node: word for node in statements if (word := _idle_word(node.value))}
    if idle:
        nodes = (node for each in modules for node in ast.walk(each))
        defined = {fold(node.name.text) for node in nodes if isinstance(node, ast.Callable | ast.Alias)}
        idle = {node: word for node, word in idle.items() if word not in defined}
    return exchanged(module, dict.fromkeys(idle)) if idle else module, list(map(_idle, idle))


def _idle_word(call: ast.Expression) -> str:
    """Returns the folded name of a call of `IDLE`; "" for anything else."""
    if not isinstance(call, ast.Call) or not isinstance(call.receiver, ast.Name | None):
        return ""
    return word if (word := fold(call.callee.text)) in IDLE else ""


def _idle(node: ast.ExpressionStatement) -> Diagnostic:
    assert isinstance(node.value, ast.Call)
    message = f"`{node.value.callee.text}(…)` has nothing to do: compiling solves, draws and writes"
    hint = "the output is named on the command line: `aidl compile plate.aidl -o plate.svg`"
    fix = Fix("remove it", (Edit(node.span.with_separator, ""),), is_sure=True)
    return Diagnostic("N0504", message, node.span, hints=(hint,), fix=fix)


def call_answer(node: ast.Call) -> tuple[str, str, str] | None:
    """Returns code, headline and hint for a call of a function that other languages have."""
    name, word = node.callee.text, fold(node.callee.text)
    if word in _SOLIDS:
        thick = "draw the outline; how thick a part is says `@thickness(10mm)` before its `solid`"
        return "E0349", f"there is no `{name}`: AIDL draws in two dimensions", thick
    if (form := _INSTEAD.get(word)) is not None:
        return "E0203", f"`{name}` is not called: a structure is written `{form}`", ""
    if (hint := _CALLS.get(word)) is not None:
        return "E0203", f"there is no function, shape or constraint `{name}`", hint
    return None


def no_declaration(resolver: Resolver, name: ast.Name, is_value: bool) -> None:
    """Reports `h = …` among constraints with a new name: it compares, but was meant to declare one."""
    message = f"there is no `{name.text}` here; among constraints `=` compares"
    hint = f"`let {name.text} = …` names an expression; geometry is made outside"
    fix = Fix("declare it with `let`", (Edit(place_before(name), "let "),)) if is_value else None
    resolver.report("E0201", message, name, label="not declared", hints=(hint,), fix=fix)


def unknown_name(resolver: Resolver, node: ast.Name, scope: SymbolScope) -> None:
    """Reports a bare name that no scope has as a value."""
    name = node.text
    if scope.may_be_missing(name) or resolver.has_said_enough:
        return
    given = resolver.argument.arguments if resolver.argument is not None else ()
    if any(a.value is node for a in given) and word_meant(name, WORDS) is not None:
        resolver.resolution.uses[node] = Symbol(name, SymbolKind.WORD)
        return
    if (called := scope.called(name)) is not None:
        kind = kind_of(called[1][0])
        message = f"`{name}` is a {kind} and has to be called: `{name}(…)`"
        resolver.report("E0206", message, node, label="a name alone means a value")
        return
    hint = _VALUES.get(fold(name))
    like = nearest(name, scope.visible(), 2) if hint is None else []
    like = ["self"] if fold(name) == "this" else like
    hints: tuple[str, ...] = (hint,) if hint else ()
    if not like and not hints:
        hints = ("names are declared with `param`, `let` or `name = …`",)
    declared = scope.value(like[0]) if like else None
    places = declared.declarations[:1] if declared else ()
    secondary = tuple(Label(place.span, "declared here") for place in places)
    message = f"there is no `{name}` here" + did_you_mean(like)
    fix = respell(node, like)
    resolver.report("E0201", message, node, label="not declared", secondary=secondary, hints=hints, fix=fix)


def unknown_callable(resolver: Resolver, node: ast.Call, scope: SymbolScope) -> None:
    name = node.callee.text
    if scope.may_be_missing(name) or resolver.has_said_enough:
        return
    value = scope.value(name)
    if value is not None and value.kind is not SymbolKind.BUILTIN:
        declared = (Label(value.declarations[0].span, "declared here"),) if value.declarations else ()
        hint, fix = f"`{name}` alone names it", None
        if isinstance(value.node, ast.Structure):
            if not value.node.indices:
                behind = Span(value.node.span.source, value.node.name.span.end, value.node.name.span.end)
                fix = Fix(f"make `{value.name}` a template", (Edit(behind, "()"),))
            listed_so = f"`{value.node.kind} {name}() {{ … }}`"
            hint = f"with a parameter list, {listed_so}, it is a template to be called"
        message = f"`{name}` is {value.kind.with_article} and cannot be called"
        resolver.report("E0206", message, node.callee, secondary=declared, hints=(hint,), fix=fix)
        return
    if (answer := call_answer(node)) is not None:
        code, headline, hint = answer
        resolver.report(code, headline, node.callee, hints=(hint,) if hint else ())
        return
    if node.receiver is not None and not node.arguments and fold(name) in FIELDS:
        parentheses = Span(node.span.source, node.callee.span.end, node.span.end)
        fix = Fix("leave out the parentheses", (Edit(parentheses, ""),), is_sure=True)
        message = f"`{name}` is a field, which is named without parentheses"
        resolver.report("E0206", message, node.callee, fix=fix)
        return
    is_condition = resolver.condition is node
    like = nearest(name, scope.callable_names(), 2)
    if is_condition and not (like and is_like(name, like[0]) and not _is_built_in(scope, like[0])):
        like = nearest(name, [n for n in scope.callable_names() if _may_hold(scope, n)], 2)
    hint = _RELATIONS if is_condition else "define it with `fn`, `shape` or as a template"
    is_meant = bool(like) and not _is_spelled_right(name, like[0], scope)
    is_safe = is_meant and (is_condition or not _only_holds(scope, like[0]))
    message = f"there is no function, shape or constraint `{name}`" + did_you_mean(like)
    fix = respell(node.callee, like) if is_safe else None
    resolver.report("E0203", message, node.callee, hints=() if like else (hint,), fix=fix)


def _is_spelled_right(name: str, meant: str, scope: SymbolScope) -> bool:
    """Tells whether a word by which two names differ is known: `same_side` is no slip for `same_size`."""
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
    if found is None or _is_built_in(scope, name):
        return False
    return all(kind_of(s) not in made for s in found[1])


def _is_built_in(scope: SymbolScope, name: str) -> bool:
    """Tells whether a callable is built in and holds of nothing."""
    found = scope.called(name)
    return found is not None and found[1][0].node is None and name not in ("fixed", "overlaps")


def declared_twice(resolver: Resolver, name: ast.Identifier, earlier: Symbol) -> None:
    first, array = Label(earlier.declarations[0].span, "declared here"), f"`{name.text}[0]`, `{name.text}[1]`"
    hint = f"give one of them another name, or give both an index to make an array: {array}"
    resolver.report("E0209", f"`{name.text}` is declared twice", name, secondary=(first,), hints=(hint,))


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
            message = f"the alias `{symbol.name}` stands for itself: {' → '.join(trail)}"
            hint = "let one of them name a function, shape, constraint or template"
            resolver.report("E0207", message, target, hints=(hint,))
            continue
        like = nearest(target.text, [n for n in scope.callable_names() if n != symbol.name], 2)
        message = f"there is no function, shape or constraint `{target.text}`" + did_you_mean(like)
        resolver.report("E0203", message, target, fix=respell(target, like))


def is_below(node: ast.Name, symbol: Symbol, scope: SymbolScope) -> bool:
    """Tells whether a name stands above the line that makes what it means."""
    if symbol.kind not in UNKNOWNS or symbol.node is None or symbol.is_array:
        return False
    if symbol.scope is None or symbol.scope.homes != scope.homes:
        return False
    here, place = node.span, symbol.node.span
    return here.source is place.source and here.start < place.end


def check_order(resolver: Resolver, node: ast.Name, symbol: Symbol, scope: SymbolScope) -> None:
    """Reports geometry and unknowns used above their line; validity judges those of other structures."""
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
    where = "in its own definition" if inside else "above the line that makes it"
    made = () if inside else (Label(symbol.declarations[0].span, "made here"),)
    message = f"`{symbol.name}` is used {where}"
    report("E0205", message, node, label="not there yet", secondary=made, hints=(hint,), fix=fix)


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
    """Returns the fix that writes the nearest name; it is sure if what is written is a slip for no other."""
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
