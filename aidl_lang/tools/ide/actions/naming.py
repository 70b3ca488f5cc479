"""Names a number: makes it a `param` with a range, which can be set from outside."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import pairwise

from aidl_lang.checking.calls import arguments
from aidl_lang.checking.units import UNITS
from aidl_lang.common.diagnostics import Edit
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.actions.action import Action, first_error
from aidl_lang.tools.ide.edits import above_comments, indent_at, insert
from aidl_lang.tools.ide.meaning import free_name
from aidl_lang.tools.ide.nodes import around
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.ide.view import View, edited

_SHORT = 2
"""Length of a name that says too little to be part of another."""


def namings(view: View, start: int, end: int) -> Iterator[Action]:
    """Yields the action for the number at a selection, if a `param` may replace it."""
    path = around(view.module, start)
    number = _number(path)
    if number is None or number.span.end < end or any(isinstance(node, ast.Param) for node in path):
        return
    name = free_name(view, _suggested(view, path))
    title = f"Name this number as a param: `{name}`"
    yield Action(title, "refactor.extract", partial(_named, view, path, number, name))


def _number(path: Sequence[ast.Node]) -> ast.Number | None:
    last = path[-1]
    return last if isinstance(last, ast.Number) else None


def _named(view: View, path: Sequence[ast.Node], number: ast.Number, name: str) -> list[Edit]:
    edits = [_declared(view, path, f"param {name} = {number.span.text}{_range(number)}")]
    edits.append(Edit(number.span, name))
    before, after = view.outcome, edited(view, edits)
    if before is not None and before.ok and not (after.outcome and after.outcome.ok):
        raise CannotError(f"as a param the number is exact, and then: {first_error(after)}")
    return edits


def _range(number: ast.Number) -> str:
    """Returns the range from half to twice the number; none for 0."""
    if not number.value:
        return ""
    low, high = (f"{number.value * factor:.3g}" for factor in (0.5, 2))
    if number.value.is_integer() and number.unit is None:  # it may count something
        low = str(max(1, int(number.value) // 2))
    unit = number.unit if number.unit and UNITS[number.unit][0] != 1.0 else ""
    return f" in {low}{unit}..{high}{unit}" if "e" not in low + high else ""


def _declared(view: View, path: Sequence[ast.Node], line: str) -> Edit:
    """Returns the edit that declares a param visible to the number: with the others of the innermost
    structure that is built once, else of the file.
    """
    text = view.source.text
    home: ast.Module | ast.Structure = view.module
    for node in path[1:]:
        if isinstance(node, ast.Structure) and node.parameters is None and not node.indices:
            home = node if node.body in path else home
            break
        if isinstance(node, ast.Structure | ast.ShapeDefinition | ast.ConstraintDefinition | ast.For):
            break
    statements = home.statements if isinstance(home, ast.Module) else home.body.statements
    inner = path[path.index(home) + 1 :]
    here = next(node for node in inner if node in statements)
    above = [s for s in statements if isinstance(s, ast.Param) and s.span.end <= here.span.start]
    if above:
        last = above[-1]
        return insert(view.source, last.span.end, f"\n{indent_at(text, last.span.start)}{line}")
    if isinstance(home, ast.Structure):
        first = statements[0].span.start
        between = text[home.body.span.start + 1 : first]
        if "\n" in between:
            indent = indent_at(text, first)
            return insert(view.source, home.body.span.start + 1, f"\n{indent}{line}\n")
        return insert(view.source, home.body.span.start + 1, f" {line};")
    return insert(view.source, above_comments(text, here.span.start), f"{line}\n\n")


def _suggested(view: View, path: Sequence[ast.Node]) -> str:
    """Suggests a name for a number by its use: `grip_height`, `hook_x`."""
    words: list[str] = []
    for outer, inner in pairwise(path):
        match outer:
            case ast.Structure(name=name):
                words = [name.text]
            case ast.Assign(name=name) if len(name.text) > _SHORT:
                words = [name.text]
            case ast.Argument(name=name) if name is not None:
                words = [*words[:1], name.text]
            case ast.Call() if (meant := _parameter(view, outer, inner)) is not None:
                words = [*words[:1], meant]
            case ast.Point(x=x):
                words = [*words[:1], "x" if inner is x else "y"]
            case ast.Let(name=name) | ast.Var(name=name):
                words = [name.text, "value"]
            case ast.Placement(rotated=rotated) if inner is rotated:
                words = [*words[:1], "angle"]
            case _:
                pass
    return "_".join(words) if len(words) > 1 else "_".join([*words, "size"])


def _parameter(view: View, call: ast.Call, inner: ast.Node) -> str | None:
    """Returns the parameter that a nameless argument fills."""
    fits = view.program.inference.fits.get(call)
    given = next((a for a in call.arguments if a is inner and a.name is None), None)
    if not fits or given is None:
        return None
    nodes = arguments(view.program.inference, call)
    return fits[0].parameter_of(nodes.index(given.value))
