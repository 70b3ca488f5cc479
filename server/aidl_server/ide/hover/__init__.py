"""Hover: the meaning of a word, its type, and its solved value."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from aidl_lang.checking.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import AnyType
from aidl_lang.checking.units import UNITS
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import Token, kind_of
from aidl_lang.tools.reference.collect import Entry, reference
from aidl_lang.tools.vocabulary import vocabulary
from aidl_server.ide.guesses import guesses
from aidl_server.ide.hover import solved_values
from aidl_server.ide.references import Mention, chosen, mention_at, parameter_node
from aidl_server.ide.signatures import (
    fenced,
    head,
    joined,
    label_of,
    of_callable,
    of_comment,
    of_doc,
    of_parameter,
    of_public,
    type_of,
)
from aidl_server.ide.site import around, spot_at, token_at
from aidl_server.ide.workspace import Solved, View

# --- Hover over keywords, attributes, the signs of comparisons, and numbers.
#
# Each answer is Markdown with the place that it is about.

_GUIDE = "`aidl guide` tells the language in a few pages."


@record()
class Hover:
    """`text` is Markdown, about what stands at `span`."""

    text: str
    span: Span


def of_word(view: View, offset: int) -> Hover | None:
    """Describes a keyword, a kind, or the sign of a comparison."""
    token = token_at(view, offset)
    if token is None:
        return None
    if token.kind in vocabulary().comparisons:
        text = _compared(view, token)
        return Hover(text, view.span(token.start, token.end)) if text else None
    word = token.text.strip("( \t")
    kind = kind_of(word)
    entry = reference().entries.get(kind or word)
    if entry is None or (token.kind == "NAME" and kind is None):
        return None
    return Hover(_keyword(entry), view.span(token.start, token.start + len(word)))


def _keyword(entry: Entry) -> str:
    forms = fenced("\n".join(o.form for o in entry.overloads))
    return joined([forms, of_doc(entry.doc), _GUIDE])


def _compared(view: View, token: Token) -> str:
    path = around(view.module, token.start)
    node = path[-1]
    if not isinstance(node, ast.Comparison):
        return ""
    solved = solved_values.solved_of(view)
    if solved is None:
        return not_solved(view)
    sides = [(side.span.one_line, solved.values(side, path)) for side in node.operands]
    return joined([stated_at(view, node, path), listed(solved_values.lines(solved, *sides))])


def of_attribute(view: View, offset: int) -> Hover | None:
    """Describes the attribute after an `@`."""
    path = reversed(around(view.module, offset))
    stated = (ast.attributes(n) for n in path if isinstance(n, ast.Structure | ast.Assign | ast.Allowing))
    before = (a for found in stated for a in found)
    node = next((a for a in before if a.span.start <= offset <= a.name.span.end), None)
    if node is None:
        return None
    name = node.name.text
    entry = reference().entries.get(f"@{'color' if name == 'colour' else name}")
    span = view.span(node.span.start, node.name.span.end)
    return Hover(_keyword(entry), span) if entry is not None else None


def of_number(view: View, start: int) -> Hover | None:
    """Describes a number in mm or degrees, with its solved value."""
    path = around(view.module, start)
    node = path[-1]
    if not isinstance(node, ast.Number):
        return None
    blocks = []
    if node.unit is not None:
        factor, dimension = UNITS[node.unit]
        worth = solved_values.number_text(node.value * factor, dimension)
        blocks.append(f"`{node.span.text}` = {worth}" if factor != 1.0 else f"{dimension}: {worth}")
    for guess in guesses(view):
        if guess.span.start <= start < guess.span.end and guess.solved is not None:
            what = "kept" if guess.is_kept else "a first guess"
            became = solved_values.number_text(guess.solved, None) + guess.behind
            many = f" and {len(guess.uses) - 1} more" if len(guess.uses) > 1 else ""
            change = f"solved to {became}" if guess.is_off(guess.solved) else f"stays {became}"
            blocks.append(f"`{guess.path}`{many}: {what}, {change}")
    return Hover(joined(blocks), node.span) if blocks else None


# --- The values shown on hovering, as lists in Markdown, or the reason why there are none.

_MAY_HOLD = ast.ExpressionStatement | ast.Equation | ast.Prefer | ast.Comparison | ast.Call | ast.Membership
_NEAREST = "*The constraints do not hold together: this is where the solver came nearest.*"


def listed(told: Sequence[str]) -> str:
    return "\n".join(f"- `{line}`" for line in told)


def not_solved(view: View) -> str:
    """Returns the reason for a missing value; "" while the text is being worked on for the first time."""
    if view.outcome is not None:
        return "*There is no value: the program has errors.*"
    return "" if view.drawn is None else "*The value is being worked out.*"


def failed(solved: Solved) -> str:
    return "" if solved.holds else _NEAREST


def stated_at(view: View, node: ast.Node, path: Sequence[ast.Node]) -> str:
    """Tells how well the constraint holds whose head is a call or a sign."""
    solved = solved_values.solved_of(view)
    if solved is None:
        return ""
    for each in reversed(path):
        if isinstance(each, _MAY_HOLD) and (told := solved_values.constraint_lines(solved, each.span)):
            return joined([*told, failed(solved)])
        if isinstance(each, ast.Block):
            break
    return ""


_VALUES = frozenset(SymbolKind) - {
    *(SymbolKind.FUNCTION, SymbolKind.SHAPE, SymbolKind.CONSTRAINT, SymbolKind.TEMPLATE),
    *(SymbolKind.ALIAS, SymbolKind.NAMESPACE, SymbolKind.WORD),
}
"""Kinds of names that have solved values."""


def hover(view: View, offset: int) -> Hover | None:
    if spot_at(view, offset).where in ("comment", "string"):
        return None
    token = token_at(view, offset)
    if token is not None and token.kind == "NUMBER":
        return of_number(view, token.start)
    return of_attribute(view, offset) or _of_name_at(view, offset) or of_word(view, offset)


def _of_name_at(view: View, offset: int) -> Hover | None:
    mention = mention_at(view, offset)
    if mention is None:
        return None
    path = around(view.module, mention.span.start)
    node, symbol = mention.node, mention.symbol
    if isinstance(node, ast.Argument):
        text = _of_named_argument(view, node, path, symbol)
    elif isinstance(node, ast.Call):
        text = _of_call(view, node, path, symbol)
    else:
        blocks = [_headed(view, mention), _doc(symbol)]
        if symbol.kind in _VALUES:
            blocks.append(_values(view, mention, path))
        elif symbol.node is None:
            blocks.append(of_public(symbol.name))
        text = joined(blocks)
    return Hover(text, mention.span) if text else None


def _headed(view: View, mention: Mention) -> str:
    """Returns the line that introduces a name: its definition, or its type."""
    symbol = mention.symbol
    fact = view.program.inference.facts.get(mention.node)
    kind = "" if fact is None or isinstance(fact.type, AnyType) else str(fact.type)
    match symbol.node:
        case None:
            return fenced(f"{symbol.name}: {kind}") if kind else ""
        case ast.For() | ast.ForArguments() | ast.Comprehension():
            return fenced(f"{symbol.name}  // {symbol.kind} of `{head(symbol.node)}`")
        case node:
            note = f"  // {kind}" if kind and not isinstance(node, ast.Structure) else ""
            return fenced(head(node) + note)


def _doc(symbol: Symbol) -> str:
    comment = next((doc for node in symbol.nodes if (doc := getattr(node, "doc", None))), None)
    if comment is not None:
        return of_comment(comment)
    entry = reference().entries.get(symbol.name) if symbol.node is None else None
    return joined([entry.doc.line, entry.doc.text]) if entry is not None and entry.sort == "word" else ""


def _values(view: View, mention: Mention, path: Sequence[ast.Node]) -> str:
    solved = solved_values.solved_of(view)
    if solved is None:
        return not_solved(view)
    node = mention.node
    if isinstance(node, ast.Identifier):  # of a declaration: a name like it
        node = ast.Name(node.text, span=node.span)
    if not isinstance(node, ast.Name | ast.Member):
        return ""
    found = solved.values(node, _body_path(mention, path))
    if mention.symbol.kind is SymbolKind.LOOP:
        found = [replace(each, label="") for each in found]  # it would repeat the value
    told = solved_values.lines(solved, (node.span.one_line, found))
    if isinstance(mention.symbol.node, ast.Param):
        told = [line.replace(", exact (param)", ", param") for line in told]
    return joined([listed(told), _range(mention.symbol), failed(solved)])


def _body_path(mention: Mention, path: Sequence[ast.Node]) -> Sequence[ast.Node]:
    """Returns the nodes around a name for its readers: an array is outside the loop, a variable in a turn."""
    symbol = mention.symbol
    if symbol.is_array and mention.is_declaration:
        return path[: next((n for n, node in enumerate(path) if isinstance(node, ast.For)), len(path))]
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


def _of_call(view: View, call: ast.Call, path: Sequence[ast.Node], symbol: Symbol) -> str:
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
    node = parameter_node(signature, symbol.name)
    kind = type_of(signature, symbol.name)
    shown = node.span.one_line if node is not None else f"{symbol.name}: {kind}"
    head_line = fenced(f"{signature.name}(… {shown} …)")
    return joined([head_line, of_parameter(signature, symbol.name), _given(view, argument, path)])


def _given(view: View, argument: ast.Argument, path: Sequence[ast.Node]) -> str:
    solved = solved_values.solved_of(view)
    made = next((n for n in reversed(path) if isinstance(n, ast.Assign)), None)
    if solved is None or made is None or argument.name is None:
        return ""
    if made.indices or not (isinstance(made.value, ast.Call) and argument in made.value.arguments):
        return ""
    name = ast.Name(made.name.text, span=made.name.span)
    field = ast.Member(name, argument.name, span=argument.name.span)
    found = solved.values(field, path[: path.index(made)])
    told = solved_values.lines(solved, (f"{made.name.text}.{argument.name.text}", found))
    return joined([listed(told), failed(solved)])
