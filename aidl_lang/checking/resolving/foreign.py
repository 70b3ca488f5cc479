"""Names of other languages and programs, with their counterparts here."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.names import fold
from aidl_lang.syntax import ast

_Node = TypeVar("_Node", bound=ast.Node)


def _words(*lines: str) -> frozenset[str]:
    return frozenset(fold(word) for line in lines for word in line.split())


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

_INSTEAD: Mapping[str, str] = {
    fold(word): instead
    for words, instead in (
        ("solid part body component module", "solid base { … }"),
        ("hole cut pocket", "hole bore { rim = circle(radius: 3) }"),
        ("assembly group compound", "assembly frame { … }"),
        ("drawing sketch workplane", "drawing plan { … }"),
    )
    for word in words.split()
}
"""Kinds of structures called like functions, and how a structure is written."""

_CALLS: Mapping[str, str] = {
    fold(word): hint
    for words, hint in (
        ("int trunc", "whole numbers come from `floor(x)`, `ceil(x)` or `round(x)`"),
        ("float number double", "numbers need no conversion"),
        ("pow power", "powers are written `x ^ 2`"),
        ("mod fmod", "the remainder is written `a % b`"),
        ("list array tuple", "lists are written `[1, 2, 3]`, or `[i * 10 for i in 0..3]`"),
        (
            "require ensure check",
            "what must hold is written `constrain …`, or `assert …` to check it at the end",
        ),
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
            "points become one by `coincident(a.end, b.start)`, "
            "parts lie against each other by `touching(a, b)`",
        ),
    )
    for word in words.split()
}

_VALUES: Mapping[str, str] = {
    fold(word): hint
    for words, hint in (
        ("null none nil undefined nan", "every name has a value; leave an argument out to take its default"),
        ("new", "things are made without `new`: `c = circle(radius: 5)`"),
        ("lambda function", "functions are defined as `fn f(x) = 2 * x`"),
        ("inf infinity", "give a number that is large enough, or leave the bound out"),
        ("e euler", "write the number: `2.718281828`"),
        ("is equals", "equality is written `a == b`"),
        ("between", "a range is written `x in 3..5`"),
        (
            "model sketch doc part cq b3d wp workplane canvas",
            "constraints and geometry are written without it",
        ),
    )
    for word in words.split()
}


_ROUND = "round corners are geometry: `rounded_rectangle(radius: 5, …)`, or `fillet(outline, 5)`"
ATTRIBUTES_MEANT: Mapping[str, tuple[str, str]] = {
    **dict.fromkeys(("fill", "fillcolor", "background", "paint"), ("color", "")),
    **dict.fromkeys(("strokewidth", "linewidth"), ("stroke", "")),
    **dict.fromkeys(("cornerradius", "radius", "rounded", "borderradius", "fillet"), ("", _ROUND)),
    **dict.fromkeys(("extrude", "depth"), ("thickness", "")),
}
"""Attributes of other languages, folded: the attribute that is meant, or a hint if it is none."""


def value_hint(name: str) -> str | None:
    """Returns the hint for a name that is a value in other languages."""
    return _VALUES.get(fold(name))


def without_idle(module: ast.Module, modules: Sequence[ast.Module]) -> tuple[ast.Module, list[Diagnostic]]:
    """Returns a file without statements such as `solve()` and `show(base)`, and a note on each; calls of
    functions that one of the files defines stay.
    """
    notes: list[Diagnostic] = []

    @functools.cache
    def defined() -> set[str]:
        nodes = (node for each in modules for node in ast.walk(each))
        return {fold(node.name.text) for node in nodes if isinstance(node, ast.Callable | ast.Alias)}

    def is_idle(node: ast.Node) -> bool:
        if not (isinstance(node, ast.ExpressionStatement) and isinstance(call := node.value, ast.Call)):
            return False
        word = fold(call.callee.text)
        return word in IDLE and isinstance(call.receiver, ast.Name | None) and word not in defined()

    def kept(node: _Node) -> _Node:
        changes: dict[str, Any] = {}
        for field in _BODIES:
            inner = getattr(node, field, None)
            if isinstance(inner, ast.Block):
                changes[field] = kept(inner)
            elif field == "statements" and inner is not None:
                notes.extend(_idle(s) for s in inner if is_idle(s))
                changes[field] = tuple(kept(s) for s in inner if not is_idle(s))
        same = all(getattr(node, field) == value for field, value in changes.items())
        return node if same else replace(node, **changes)

    return kept(module), notes


_BODIES = ("statements", "body", "then", "otherwise", "items")


def _idle(node: ast.ExpressionStatement) -> Diagnostic:
    assert isinstance(node.value, ast.Call)
    return Diagnostic(
        "N0504",
        f"`{node.value.callee.text}(…)` has nothing to do: compiling solves, draws and writes",
        node.span,
        hints=("the output is named on the command line: `aidl compile plate.aidl -o plate.svg`",),
        fix=Fix("remove it", (Edit(node.span.with_separator, ""),), is_sure=True),
    )


def call_answer(node: ast.Call) -> tuple[str, str, str] | None:
    """Returns code, headline and hint for a call of a function that other languages have."""
    name, word = node.callee.text, fold(node.callee.text)
    if word in _SOLIDS:
        return (
            "E0349",
            f"there is no `{name}`: AIDL draws in two dimensions",
            "draw the outline; how thick a part is says `@thickness(10mm)` before its `solid`",
        )
    if (form := _INSTEAD.get(word)) is not None:
        return "E0203", f"`{name}` is not called: a structure is written `{form}`", ""
    if (hint := _CALLS.get(word)) is not None:
        return "E0203", f"there is no function, shape or constraint `{name}`", hint
    return None
