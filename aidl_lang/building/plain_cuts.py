"""Ready-made cuts that are written in a hole: there they are circles, without depth or thread."""

from __future__ import annotations

import re

from aidl_lang.building.scopes import Scope
from aidl_lang.building.state import Interpreter
from aidl_lang.checking.builtins import CUTS
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast

_CODE = "W0504"
_LOST = {
    "depth": "nothing is sunk, and all of it is cut through",
    "thread": "no drawing sheet tells of its thread",
}
"""By attribute of a cut, what is missing where its circle stands alone."""
_PLACED_IN = ("solid", "assembly")
"""Kinds of structures in which the name of a cut means a whole hole."""


def tell_plain_cuts(it: Interpreter, hole: ast.Structure, scope: Scope, around: str) -> None:
    """Tells of cuts in a hole that are deep or have a thread where they are placed in a solid. `around`
    is the kind of the structure that the hole is in.
    """
    if hole.span.source in it.library_sources or any(a.name.text in _LOST for a in hole.attributes):
        return
    nodes = list(ast.walk(hole.body))
    inner = [node.span for node in nodes if isinstance(node, ast.Structure)]
    for statement in nodes:
        if not isinstance(statement, ast.Assign) or any(map(statement.span.overlaps, inner)):
            continue
        for call in ast.walk(statement.value):
            if not isinstance(call, ast.Call) or it.spelled(call.callee) not in CUTS:
                continue
            found = scope.candidates(it.spelled(call.callee))
            templates = [c.signature.node for c in found if c.signature.standard]
            placed = next((node for node in templates if isinstance(node, ast.Structure)), None)
            if placed is not None and found[0].signature.standard:
                _tell(it, call, hole, placed, _fix(hole, statement, placed) if around in _PLACED_IN else None)


def _tell(
    it: Interpreter, call: ast.Call, hole: ast.Structure, placed: ast.Structure, fix: Fix | None
) -> None:
    stated = (node.name.text for node in ast.walk(placed) if isinstance(node, ast.Attribute))
    said = next((name for name in stated if name in _LOST), None)
    if said is None or any(d.code == _CODE and d.span == call.span for d in it.diagnostics):
        return
    name = hole.name.text
    hints = (
        f"in the solid itself it is a whole one: `{name} = {call.callee.text}(…) at (x, y)`, without `hole`",
        f"or say it of this hole: `@{said}(…) hole {name} {{ … }}`",
    )
    it.report(
        _CODE, f"in a `hole`, `{call.callee.text}` is a bare circle: {_LOST[said]}", call, "", hints, fix
    )


def _fix(hole: ast.Structure, statement: ast.Assign, placed: ast.Structure) -> Fix | None:
    """Returns the edit that puts a cut in the place of a hole with nothing else in it; None if something else
    may be lost, or what is in the hole is named elsewhere, as in `hole.rim`, and the cut has nothing of that
    name.
    """
    source, inside, name = hole.span.source, hole.body.span.text, statement.name.text
    members = {node.name.text for node in placed.body.statements if isinstance(node, ast.Assign)}
    is_named = re.search(rf"\.\s*{re.escape(name)}\b", source.text) is not None and name not in members
    is_alone = inside.strip("{;} \t\n") == statement.span.text.strip("; \t\n")
    if is_named or not is_alone or not isinstance(statement.value, ast.Call):
        return None
    if hole.parameters is not None or hole.placement is not None or hole.attributes:
        return None
    head = Span(source, hole.name.span.start, hole.body.span.start).text.strip()
    made = Span(source, statement.value.span.start, statement.span.end).text.rstrip("; \t\n")
    title = f"make `{hole.name.text}` a whole one, in place of the hole"
    return Fix(title, (Edit(hole.span, f"{head} = {made}"),), is_sure=True)
