"""Hover over keywords, attributes, the signs of comparisons, and numbers.

Each answer is Markdown with the place that it is about.
"""

from __future__ import annotations

from collections.abc import Iterator

from aidl_lang.checking.units import UNITS
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.kinds import kind_of
from aidl_lang.syntax.tokens import Token
from aidl_lang.tools.ide.describing import fenced, joined
from aidl_lang.tools.ide.guesses import guesses
from aidl_lang.tools.ide.hover.solved_values import solved_of
from aidl_lang.tools.ide.hover.telling import compared, number_text
from aidl_lang.tools.ide.hover.values import listed, not_solved, stated_at
from aidl_lang.tools.ide.nodes import around, token_at
from aidl_lang.tools.ide.view import View
from aidl_lang.tools.reference.collect import Entry, reference
from aidl_lang.tools.vocabulary import vocabulary

_GUIDE = "`aidl guide` tells the language in a few pages."
Description = tuple[str, Span]


def of_word(view: View, offset: int) -> Description | None:
    """Describes a keyword, a kind, or the sign of a comparison."""
    token = token_at(view, offset)
    if token is None:
        return None
    span = view.span(token.start, token.end)
    words = vocabulary()
    if token.kind in words.comparisons:
        text = _compared(view, token)
        return (text, span) if text else None
    word = token.text.strip("( \t")
    kind = kind_of(word)
    entry = reference().entries.get(kind or word)
    if entry is None or (token.kind == "NAME" and kind is None):
        return None
    return (_keyword(entry), view.span(token.start, token.start + len(word)))


def _keyword(entry: Entry) -> str:
    example = fenced(entry.doc.example) if entry.doc.example else ""
    forms = fenced("\n".join(o.form for o in entry.overloads))
    return joined([forms, entry.doc.line, entry.doc.text, example, _GUIDE])


def _compared(view: View, token: Token) -> str:
    """Returns both sides of a comparison, and how well it holds."""
    path = around(view.module, token.start)
    node = path[-1]
    if not isinstance(node, ast.Comparison):
        return ""
    solved = solved_of(view)
    if solved is None:
        return not_solved(view)
    sides = [(side.span.one_line, solved.values(side, path)) for side in node.operands]
    return joined([stated_at(view, node, path), listed(compared(solved, sides))])


def of_attribute(view: View, offset: int) -> Description | None:
    """Describes the attribute after an `@`."""
    path = reversed(around(view.module, offset))
    stated = (ast.attributes(n) for n in path if isinstance(n, ast.Structure | ast.Assign | ast.Allowing))
    before = (a for found in stated for a in found)
    node = next((a for a in before if a.span.start <= offset <= a.name.span.end), None)
    if node is None:
        return None
    name = node.name.text
    entry = reference().entries.get(f"@{'color' if name == 'colour' else name}")
    return (_keyword(entry), view.span(node.span.start, node.name.span.end)) if entry is not None else None


def of_number(view: View, start: int) -> Description | None:
    """Describes a number in mm or degrees, with its solved value."""
    path = around(view.module, start)
    node = path[-1]
    if not isinstance(node, ast.Number):
        return None
    blocks = list(_converted(node))
    for guess in guesses(view):
        if guess.span.start <= start < guess.span.end and guess.solved is not None:
            what = "kept" if guess.is_kept else "a first guess"
            became = number_text(guess.solved, None) + guess.behind
            many = f" and {len(guess.uses) - 1} more" if len(guess.uses) > 1 else ""
            change = f"solved to {became}" if guess.is_off(guess.solved) else f"stays {became}"
            blocks.append(f"`{guess.path}`{many}: {what}, {change}")
    return (joined(blocks), node.span) if blocks else None


def _converted(node: ast.Number) -> Iterator[str]:
    if node.unit is not None:
        factor, dimension = UNITS[node.unit]
        worth = number_text(node.value * factor, dimension)
        yield f"`{node.span.text}` = {worth}" if factor != 1.0 else f"{dimension}: {worth}"
