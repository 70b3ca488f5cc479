"""Makes a structure a template: it is drawn as before, and can be used again."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from textwrap import dedent, indent

from aidl_lang.checking.resolving.symbols import UNKNOWNS, Symbol, SymbolKind
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.actions.action import Action, drawn_alike, first_error
from aidl_lang.tools.ide.edits import above_comments, insert, line_start
from aidl_lang.tools.ide.meaning import Mention, free_name, mentions
from aidl_lang.tools.ide.nodes import around
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.ide.view import View, edited

_PASSED = frozenset({SymbolKind.PARAM, SymbolKind.LET, SymbolKind.LOOP, SymbolKind.ARGUMENT})
"""Symbols that can be passed to a template."""


def extractions(view: View, offset: int) -> Iterator[Action]:
    """Yields the action for the structure whose head contains the cursor, if it lies in another structure."""
    path = around(view.module, offset)
    inside = [node for node in path if isinstance(node, ast.Structure)]
    if len(inside) < 2 or inside[-1].parameters is not None or offset > inside[-1].body.span.start:
        return
    name = free_name(view, f"{inside[-1].name.text}_{inside[-1].kind_word.text}")
    title = f"Extract `{inside[-1].name.text}` to a template: `{name}`"
    yield Action(title, "refactor.extract", partial(_extracted, view, inside[-1], path[1], name))


def _extracted(view: View, node: ast.Structure, outermost: ast.Node, name: str) -> list[Edit]:
    passed = _passed(view, node)
    text = view.source.text
    body = _dedented(view, node)
    parameters = ", ".join(symbol.name for symbol in passed)
    template = f"{node.kind_word.text} {name}({parameters}) {body}\n\n"
    arguments = ", ".join(f"{symbol.name}: {symbol.name}" for symbol in passed)
    target = text[node.name.span.start : node.indices[-1].span.end] + "]" if node.indices else node.name.text
    placement = f" {node.placement.span.text}" if node.placement is not None else ""
    edits = [
        insert(view.source, above_comments(text, outermost.span.start), template),
        Edit(
            Span(view.source, node.kind_word.span.start, node.span.end),
            f"{target} = {name}({arguments}){placement}",
        ),
    ]
    after = edited(view, edits)
    if not drawn_alike(view, after):
        raise CannotError(f"`{node.name.text}` cannot be made a template as it is: {first_error(after)}")
    return edits


def _dedented(view: View, node: ast.Structure) -> str:
    """Returns the body of a structure indented for the file's level."""
    text = view.source.text
    start = line_start(text, node.kind_word.span.start)
    margin = text[start : node.kind_word.span.start]
    lines = node.body.span.text.split("\n")
    if len(lines) == 1 or margin.strip():
        return node.body.span.text
    inner = dedent("\n".join(lines[1:-1]))
    return "\n".join([lines[0], indent(inner, "    "), lines[-1].removeprefix(margin)])


def _passed(view: View, node: ast.Structure) -> list[Symbol]:
    """Returns the outer names that a structure's body uses. Raises CannotError for one that cannot be passed
    to a template.
    """
    found: dict[Symbol, None] = {}
    for mention in mentions(view):
        symbol = mention.symbol
        inside = node.body.span.start <= mention.span.start < node.body.span.end
        if (
            not inside
            or not isinstance(mention.node, ast.Name | ast.Call)
            or not _is_around(view, node, symbol)
        ):
            continue
        if symbol.kind in _PASSED:
            found[symbol] = None
        else:
            raise CannotError(_why_not(node, mention))
    return list(found)


def _is_around(view: View, node: ast.Structure, symbol: Symbol) -> bool:
    """True for a symbol declared in this file between the file's own level and the structure."""
    here = [d.span for d in symbol.declarations if d.span.source is view.source]
    outside = [s for s in here if not (node.span.start <= s.start < node.span.end)]
    return bool(outside) and symbol.owner is not None and not isinstance(symbol.owner, ast.Module)


def _why_not(node: ast.Structure, mention: Mention) -> str:
    what = "belongs to what is around it" if mention.symbol.kind in UNKNOWNS else "is defined around it"
    return f"`{node.name.text}` uses `{mention.symbol.name}`, which {what}"
