"""Hover: what a word means, its type, and what it came out as."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from aidl_lang import ast
from aidl_lang.checking.facts import Fact
from aidl_lang.ide.describing import (
    fenced,
    head,
    joined,
    label_of,
    of_callable,
    of_comment,
    of_entry,
    of_parameter,
)
from aidl_lang.ide.guesses import guesses
from aidl_lang.ide.meaning import Mention, chosen, mention_at
from aidl_lang.ide.nodes import around
from aidl_lang.ide.site import Spot, Where, spot_at
from aidl_lang.ide.solved_values import Solved, solved_of
from aidl_lang.ide.telling import compared, constraint_lines, lines, number_text
from aidl_lang.ide.view import View
from aidl_lang.kinds import kind_of
from aidl_lang.reference.collect import Entry, reference
from aidl_lang.resolving.symbols import Symbol, SymbolKind
from aidl_lang.source import Span
from aidl_lang.syntax.tokens import Token, tokenize
from aidl_lang.types import AnyType
from aidl_lang.units import UNITS
from aidl_lang.vocabulary import vocabulary

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
_GUIDE = "`aidl guide` tells the language in a few pages."
_STATED = ast.ExpressionStatement | ast.Equation | ast.Prefer


@dataclass(frozen=True)
class Hover:
    """`text` is Markdown, about what stands at `span`."""

    text: str
    span: Span


def hover(view: View, offset: int, end: int | None = None) -> Hover | None:
    """What is to be said of the word at an offset, or of the expression that is selected from there to `end`;
    None where there is nothing.
    """
    if end is not None and end > offset:
        return _of_selection(view, offset, end)
    spot = spot_at(view, offset)
    if spot.where is Where.COMMENT:
        return None
    if spot.where is Where.NUMBER and spot.token is not None:
        return _of_number(view, spot.token.start)
    if spot.where is Where.STRING:
        return None
    if (attribute := _of_attribute(view, spot)) is not None:
        return attribute
    mention = mention_at(view, offset)
    if mention is not None and mention.span.start <= offset <= mention.span.end:
        return _of_mention(view, mention)
    return _of_word(view, offset)


# --- Names -----------------------------------------------------------------------------------------


def _of_mention(view: View, mention: Mention) -> Hover | None:
    path = around(view.module, mention.span.start)
    node = mention.node
    if isinstance(node, ast.Argument):
        text = _of_named_argument(view, node, path, mention.symbol)
    elif isinstance(node, ast.Call):
        text = _of_call(view, node, path, mention.symbol)
    else:
        text = _of_name(view, mention, path)
    return Hover(text, mention.span) if text else None


def _of_name(view: View, mention: Mention, path: Sequence[ast.Node]) -> str:
    symbol = mention.symbol
    blocks = [_headed(view, mention), _doc(symbol)]
    if symbol.kind in _VALUES:
        blocks.append(_values(view, mention, path))
    elif mention.symbol.node is None:
        blocks.append(_of_public(symbol.name))
    return joined(blocks)


def _headed(view: View, mention: Mention) -> str:
    """The line that says what a name is: its definition, or its type."""
    symbol = mention.symbol
    fact = _fact(view, mention.node)
    kind = "" if fact is None or isinstance(fact.type, AnyType) else str(fact.type)
    match symbol.node:
        case None:
            return fenced(f"{symbol.name}: {kind}") if kind else ""
        case ast.For() | ast.Comprehension():
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
    """What a name came out as, in a list."""
    solved = solved_of(view)
    if solved is None:
        return _not_solved(view)
    node = _expression(mention)
    if node is None:
        return ""
    found = solved.values(node, _body_path(mention, path))
    told = lines(solved, _shown_name(node), found)
    if mention.symbol.kind is SymbolKind.PARAM and isinstance(mention.symbol.node, ast.Param):
        told = [line.replace(", exact (param)", ", param") for line in told]
    return joined([_listed(told), _range(mention.symbol), _failed(solved)])


def _listed(told: Sequence[str]) -> str:
    return "\n".join(f"- `{line}`" if "`" not in line else f"- {line}" for line in told)


def _shown_name(node: ast.Expression) -> str:
    return node.span.one_line if isinstance(node, ast.Member | ast.Index) else getattr(node, "text", "value")


def _expression(mention: Mention) -> ast.Expression | None:
    """What to read to get the value of a name: the name, or for a declaration a name like it."""
    match mention.node:
        case ast.Name() | ast.Member() as node:
            return node
        case ast.Identifier() as node:
            return ast.Name(node.text, span=node.span)
        case _:
            return None


def _body_path(mention: Mention, path: Sequence[ast.Node]) -> Sequence[ast.Node]:
    """The nodes around a name, as those see it that may use it: a declared structure belongs to what is around
    it, its parameters to what is in it.
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


def _not_solved(view: View) -> str:
    """Why there is no value; nothing while the text is being worked on for the first time."""
    if view.outcome is not None:
        return "*There is no value: the program has errors.*"
    return "" if view.drawn is None else "*The value is being worked out.*"


def _failed(solved: Solved) -> str:
    model = solved.outcome.model
    if model is None or model.status == "solved":
        return ""
    return "*The constraints do not hold together: this is where the solver came nearest.*"


# --- Calls -----------------------------------------------------------------------------------------


def _of_call(view: View, call: ast.Call, path: Sequence[ast.Node], symbol: Symbol) -> str:
    """What a call means: its form first, then all that is said of the name."""
    candidates = view.resolution.candidates.get(call, ())
    if not candidates:
        return ""
    meant = chosen(view, call)
    blocks = [fenced(label_of(meant).text)] if meant is not None and len(candidates) > 1 else []
    if symbol.kind is SymbolKind.ALIAS and symbol.node is not None:
        blocks.append(fenced(head(symbol.node)))
    blocks.append(_stated_at(view, call, path))
    blocks.append(of_callable(symbol.name, candidates))
    return joined(dict.fromkeys(blocks))


def _of_named_argument(
    view: View, argument: ast.Argument, path: Sequence[ast.Node], symbol: Symbol
) -> str:
    call = next((n for n in reversed(path) if isinstance(n, ast.Call) and argument in n.arguments), None)
    signature = chosen(view, call) if call is not None else None
    if signature is None:
        return ""
    kind = next((k for name, k, _ in signature.parameters if name == symbol.name), None)
    node = next((p for p in (signature.node.parameters or ()) if p.name.text == symbol.name), None) if (
        signature.node is not None
    ) else None
    shown = node.span.one_line if node is not None else f"{symbol.name}: {kind}"
    return joined(
        [fenced(f"{signature.name}(… {shown} …)"), of_parameter(signature, symbol.name), _given(view, argument, path)]
    )


def _given(view: View, argument: ast.Argument, path: Sequence[ast.Node]) -> str:
    """What is given for a parameter; of the geometry that is made of it, what became of it."""
    solved = solved_of(view)
    made = next((n for n in reversed(path) if isinstance(n, ast.Assign)), None)
    if solved is None or made is None or argument.name is None or made.indices or not _is_made(made, argument):
        return ""
    name = ast.Name(made.name.text, span=made.name.span)
    field = ast.Member(name, argument.name, span=argument.name.span)
    found = solved.values(field, path[: path.index(made)])
    return joined([_listed(lines(solved, f"{made.name.text}.{argument.name.text}", found)), _failed(solved)])


def _is_made(made: ast.Assign, argument: ast.Argument) -> bool:
    return isinstance(made.value, ast.Call) and argument in made.value.arguments


def _stated_at(view: View, node: ast.Node, path: Sequence[ast.Node]) -> str:
    """How well the constraint holds that a call or a sign is the head of."""
    solved = solved_of(view)
    if solved is None:
        return ""
    for each in reversed(path):
        if isinstance(each, _STATED | ast.Comparison | ast.Call | ast.Membership):
            if told := constraint_lines(solved, each.span):
                return joined([*(f"This constraint {line}." for line in told), _failed(solved)])
        if isinstance(each, ast.Block):
            break
    return ""


def _of_public(name: str) -> str:
    entry = reference().entries.get(name)
    return of_entry(entry) if entry is not None else ""


# --- Words, signs and numbers ----------------------------------------------------------------------


def _of_word(view: View, offset: int) -> Hover | None:
    """A keyword, a kind, or the sign of a comparison."""
    token = _token_at(view, offset)
    if token is None:
        return None
    span = view.span(token.start, token.end)
    words = vocabulary()
    if token.kind in words.comparisons:
        text = _compared(view, token)
        return Hover(text, span) if text else None
    word = token.text.strip("( \t")
    kind = kind_of(word)
    entry = reference().entries.get(kind or word)
    if entry is None or (token.kind == "NAME" and kind is None):
        return None
    return Hover(_keyword(entry), view.span(token.start, token.start + len(word)))


def _keyword(entry: Entry) -> str:
    example = fenced(entry.doc.example) if entry.doc.example else ""
    forms = fenced("\n".join(o.form for o in entry.overloads))
    return joined([forms, entry.doc.line, entry.doc.text, example, _GUIDE])


def _token_at(view: View, offset: int) -> Token | None:
    touching = None
    for token in tokenize(view.source).tokens:
        if token.start <= offset < token.end:
            return token
        if token.end == offset:
            touching = token
    return touching


def _compared(view: View, token: Token) -> str:
    """Both sides of a comparison, and how well it holds."""
    path = around(view.module, token.start)
    node = path[-1]
    if not isinstance(node, ast.Comparison):
        return ""
    solved = solved_of(view)
    if solved is None:
        return _not_solved(view)
    sides = [(side.span.one_line, solved.values(side, path)) for side in node.operands]
    return joined([_stated_at(view, node, path), _listed(compared(solved, sides))])


def _of_attribute(view: View, spot: Spot) -> Hover | None:
    if spot.before is None or spot.before.kind != "@":
        return None
    name = view.source.text[spot.start : spot.end]
    entry = reference().entries.get(f"@{'color' if name == 'colour' else name}")
    return Hover(_keyword(entry), view.span(spot.before.start, spot.end)) if entry is not None else None


def _of_number(view: View, start: int) -> Hover | None:
    """A number in mm or degrees, and what the solver made of it."""
    path = around(view.module, start)
    node = path[-1]
    if not isinstance(node, ast.Number):
        return None
    blocks = list(_converted(node))
    for guess in guesses(view):
        if guess.span.start <= start < guess.span.end and guess.solved is not None:
            unit = f" {guess.measure}" if guess.measure else ""
            what = "kept" if guess.is_kept else "a first guess"
            became = number_text(guess.solved, None) + unit
            many = f" and {len(guess.uses) - 1} more" if len(guess.uses) > 1 else ""
            change = f"solved to {became}" if guess.is_off(guess.solved) else f"stays {became}"
            blocks.append(f"`{guess.path}`{many}: {what}, {change}")
    return Hover(joined(blocks), node.span) if blocks else None


def _converted(node: ast.Number) -> Iterator[str]:
    if node.unit is not None:
        factor, dimension = UNITS[node.unit]
        worth = number_text(node.value * factor, dimension)
        yield f"`{node.span.text}` = {worth}" if factor != 1.0 else f"{dimension}: {worth}"


def _of_selection(view: View, start: int, end: int) -> Hover | None:
    """The value of the expression that is selected, blanks around it aside."""
    text = view.source.text[start:end]
    start, end = start + len(text) - len(text.lstrip()), end - len(text) + len(text.rstrip())
    path = around(view.module, start)
    solved = solved_of(view)
    for number, node in enumerate(path):
        fits = (node.span.start, node.span.end) == (start, end)
        if fits and isinstance(node, ast.Expression) and solved is not None:  # type: ignore[arg-type,misc]
            told = lines(solved, node.span.one_line, solved.values(node, path[:number]))
            return Hover(_listed(told), node.span) if told else None
    return None
