"""Hover: the meaning of a word, its type, and its solved value."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from aidl_lang.checking.facts import Fact
from aidl_lang.checking.resolving.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import AnyType
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.describing import (
    fenced,
    head,
    joined,
    label_of,
    of_callable,
    of_comment,
    of_parameter,
    of_public,
)
from aidl_lang.tools.ide.hover.solved_values import solved_of
from aidl_lang.tools.ide.hover.telling import lines
from aidl_lang.tools.ide.hover.values import failed, listed, not_solved, stated_at
from aidl_lang.tools.ide.hover.words import Description, of_attribute, of_number, of_word
from aidl_lang.tools.ide.meaning import Mention, chosen, mention_at, parameter_node
from aidl_lang.tools.ide.nodes import around, token_at
from aidl_lang.tools.ide.site import Where, spot_at
from aidl_lang.tools.ide.view import View
from aidl_lang.tools.reference.collect import reference

_VALUES = frozenset(
    (
        SymbolKind.PARAM,
        SymbolKind.LET,
        SymbolKind.VAR,
        SymbolKind.LOOP,
        SymbolKind.ARGUMENT,
        SymbolKind.GEOMETRY,
        SymbolKind.STRUCTURE,
        SymbolKind.FIELD,
        SymbolKind.BUILTIN,
    )
)


@record()
class Hover:
    """`text` is Markdown, about what stands at `span`."""

    text: str
    span: Span


def hover(view: View, offset: int, end: int | None = None) -> Hover | None:
    """Returns the hover for the word at an offset, or for the expression selected from there to `end`; None
    for anything else.
    """
    if end is not None and end > offset:
        return _of_selection(view, offset, end)
    spot = spot_at(view, offset)
    if spot.where in (Where.COMMENT, Where.STRING):
        return None
    token = token_at(view, offset)
    if token is not None and token.kind == "NUMBER":
        told = of_number(view, token.start)
    else:
        told = of_attribute(view, offset) or _of_name_at(view, offset) or of_word(view, offset)
    return Hover(*told) if told is not None else None


# --- Names -----------------------------------------------------------------------------------------


def _of_name_at(view: View, offset: int) -> Description | None:
    mention = mention_at(view, offset)
    if mention is None:
        return None
    path = around(view.module, mention.span.start)
    node = mention.node
    if isinstance(node, ast.Argument):
        text = _of_named_argument(view, node, path, mention.symbol)
    elif isinstance(node, ast.Call):
        text = _of_call(view, node, path, mention.symbol)
    else:
        text = _of_name(view, mention, path)
    return (text, mention.span) if text else None


def _of_name(view: View, mention: Mention, path: Sequence[ast.Node]) -> str:
    symbol = mention.symbol
    blocks = [_headed(view, mention), _doc(symbol)]
    if symbol.kind in _VALUES:
        blocks.append(_values(view, mention, path))
    elif mention.symbol.node is None:
        blocks.append(of_public(symbol.name))
    return joined(blocks)


def _headed(view: View, mention: Mention) -> str:
    """Returns the line that introduces a name: its definition, or its type."""
    symbol = mention.symbol
    fact = _fact(view, mention.node)
    kind = "" if fact is None or isinstance(fact.type, AnyType) else str(fact.type)
    match symbol.node:
        case None:
            return fenced(f"{symbol.name}: {kind}") if kind else ""
        case ast.For() | ast.ForArguments() | ast.Comprehension():
            return fenced(f"{symbol.name}  // {symbol.kind} of `{head(symbol.node)}`")
        case node:
            note = f"  // {kind}" if kind and not isinstance(node, ast.Structure) else ""
            return fenced(head(node) + note)


def _fact(view: View, node: ast.Node) -> Fact | None:
    return view.program.inference.facts.get(node)


def _doc(symbol: Symbol) -> str:
    comments = [doc for node in symbol.nodes if (doc := getattr(node, "doc", None))]
    if comments:
        return of_comment(comments[0])
    if symbol.node is None:
        entry = reference().entries.get(symbol.name)
        return joined([entry.doc.line, entry.doc.text]) if entry is not None and entry.sort == "word" else ""
    return ""


def _values(view: View, mention: Mention, path: Sequence[ast.Node]) -> str:
    """Returns the solved values of a name as a list."""
    solved = solved_of(view)
    if solved is None:
        return not_solved(view)
    node = _expression(mention)
    if node is None:
        return ""
    found = solved.values(node, _body_path(mention, path))
    if mention.symbol.kind is SymbolKind.LOOP:
        found = [replace(each, label="") for each in found]  # it would repeat the value
    told = lines(solved, _shown_name(node), found)
    if mention.symbol.kind is SymbolKind.PARAM and isinstance(mention.symbol.node, ast.Param):
        told = [line.replace(", exact (param)", ", param") for line in told]
    return joined([listed(told), _range(mention.symbol), failed(solved)])


def _shown_name(node: ast.Expression) -> str:
    return node.span.one_line if isinstance(node, ast.Member | ast.Index) else getattr(node, "text", "value")


def _expression(mention: Mention) -> ast.Expression | None:
    """Returns the expression to evaluate for a name: the name itself, or for a declaration a name like it."""
    match mention.node:
        case ast.Name() | ast.Member() as node:
            return node
        case ast.Identifier() as node:
            return ast.Name(node.text, span=node.span)
        case _:
            return None


def _body_path(mention: Mention, path: Sequence[ast.Node]) -> Sequence[ast.Node]:
    """Returns the nodes around a name as its readers see them: the members of an array belong outside the
    loop, and its variable to the turns of it.
    """
    symbol = mention.symbol
    if symbol.is_array and mention.is_declaration:
        loops = [n for n, node in enumerate(path) if isinstance(node, ast.For)]
        return path[: loops[0]] if loops else path
    if isinstance(mention.node, ast.Identifier) and isinstance(symbol.node, ast.For):
        loop = next((n for n, node in enumerate(path) if node is symbol.node), len(path) - 1)
        return [*path[: loop + 1], symbol.node.body]
    return path


def _range(symbol: Symbol) -> str:
    node = symbol.node
    if not isinstance(node, ast.Param) or node.domain is None:
        return ""
    step = f", in steps of {node.step.span.one_line}" if node.step is not None else ""
    return f"May be set to {node.domain.span.one_line}{step}."


# --- Calls -----------------------------------------------------------------------------------------


def _of_call(view: View, call: ast.Call, path: Sequence[ast.Node], symbol: Symbol) -> str:
    """Describes a call: its form first, then the name."""
    candidates = view.resolution.candidates.get(call, ())
    if not candidates:
        return ""
    meant = chosen(view, call)
    blocks = [fenced(label_of(meant).text)] if meant is not None and len(candidates) > 1 else []
    if symbol.kind is SymbolKind.ALIAS and symbol.node is not None:
        blocks.append(fenced(head(symbol.node)))
    blocks.append(stated_at(view, call, path))
    blocks.append(of_callable(symbol.name, candidates))
    return joined(dict.fromkeys(blocks))


def _of_named_argument(view: View, argument: ast.Argument, path: Sequence[ast.Node], symbol: Symbol) -> str:
    call = next((n for n in reversed(path) if isinstance(n, ast.Call) and argument in n.arguments), None)
    signature = chosen(view, call) if call is not None else None
    if signature is None:
        return ""
    kind = next((k for name, k, _ in signature.parameters if name == symbol.name), None)
    node = parameter_node(signature, symbol.name)
    shown = node.span.one_line if node is not None else f"{symbol.name}: {kind}"
    head_line = fenced(f"{signature.name}(… {shown} …)")
    return joined([head_line, of_parameter(signature, symbol.name), _given(view, argument, path)])


def _given(view: View, argument: ast.Argument, path: Sequence[ast.Node]) -> str:
    """Describes a parameter's value; for the geometry made of it, the solved one."""
    solved = solved_of(view)
    made = next((n for n in reversed(path) if isinstance(n, ast.Assign)), None)
    if solved is None or made is None or argument.name is None:
        return ""
    if made.indices or not _is_made(made, argument):
        return ""
    name = ast.Name(made.name.text, span=made.name.span)
    field = ast.Member(name, argument.name, span=argument.name.span)
    found = solved.values(field, path[: path.index(made)])
    told = lines(solved, f"{made.name.text}.{argument.name.text}", found)
    return joined([listed(told), failed(solved)])


def _is_made(made: ast.Assign, argument: ast.Argument) -> bool:
    return isinstance(made.value, ast.Call) and argument in made.value.arguments


# --- Selections -----------------------------------------------------------------------------------


def _of_selection(view: View, start: int, end: int) -> Hover | None:
    """Returns the hover for the selected expression, ignoring blanks around it."""
    text = view.source.text[start:end]
    start, end = start + len(text) - len(text.lstrip()), end - len(text) + len(text.rstrip())
    path = around(view.module, start)
    solved = solved_of(view)
    for number, node in enumerate(path):
        fits = (node.span.start, node.span.end) == (start, end)
        if fits and isinstance(node, ast.Expression) and solved is not None:
            told = lines(solved, node.span.one_line, solved.values(node, path[:number]))
            return Hover(listed(told), node.span) if told else None
    return None
