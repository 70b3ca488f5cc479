"""Warnings on programs that parse and yet may mean something else, and lines that begin with a sign."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import END, STATEMENT_WORDS, Token, begins_line

# --- Lines of `constrain { }` that begin with a sign, and the question if one begins a constraint of its
# own.
#
# Newlines mean nothing to the grammar, so `-` goes on with the line above. If it touches its operand, and
# the line compares, people read it as the next constraint.

_COMPARING = frozenset({"==", "<=", ">=", "<", ">", "!=", "=", "in"})
_ENDING = STATEMENT_WORDS | {END, ";", ",", "{", "}", "and", "or", "&&", "||", "else"}
_FARTHEST = 500
"""Tokens to look at: nobody writes longer sums by hand."""
_OPERANDS = frozenset({"NAME", "NUMBER", "STRING"})


def begins_with_sign(text: str, tokens: Sequence[Token], position: int) -> bool:
    """Tells whether a token is a `-` that begins a line, touches its operand and precedes a comparison."""
    if not _is_sign(text, tokens, position):
        return False
    depth, after_operand = 0, False
    for place in range(position + 1, min(len(tokens), position + _FARTHEST)):
        kind = tokens[place].kind
        if depth == 0:
            if kind in _COMPARING:
                return True
            begins_operand = kind in _OPERANDS or kind in ("CALL", "(")
            if kind in _ENDING or (after_operand and begins_operand) or _is_sign(text, tokens, place):
                return False
        depth += (kind in ("(", "[", "CALL")) - (kind in (")", "]"))
        if depth < 0:
            return False
        after_operand = kind in _OPERANDS or kind in (")", "]")
    return False


def _is_sign(text: str, tokens: Sequence[Token], position: int) -> bool:
    token = tokens[position]
    return token.kind == "-" and tokens[position + 1].start == token.end and begins_line(text, token.start)


_MOST_PLACES, _LONGEST = 100, 2000  # beyond this many lines and characters nobody wrote it by hand


class _Parsed(Protocol):
    @property
    def module(self) -> ast.Module: ...
    @property
    def diagnostics(self) -> list[Diagnostic]: ...


def lines_joined_by_sign(
    module: ast.Module, tokens: Sequence[Token], read: Callable[[SourceFile], _Parsed]
) -> list[Diagnostic]:
    """Returns W0101 for each line that begins with a sign if it and what is above read as statements."""
    source, text = module.source, module.source.text
    signs = (t.start for t in tokens if t.kind in "+-" and begins_line(text, t.start))
    places = [start for start in signs if text[:start].strip()]
    if not places:
        return []
    found = []
    leaves = list(_leaves(module.statements))
    for place in places[:_MOST_PLACES]:
        leaf = next((s for s in leaves if s.span.start < place < s.span.end), None)
        if leaf is None or leaf.span.end - leaf.span.start > _LONGEST:
            continue
        above, below = text[leaf.span.start : place], text[place : leaf.span.end].lstrip("+")
        inside = isinstance(leaf, ast.ExpressionStatement | ast.Equation)
        if _whole(f"constrain {{ {above}\n}}" if inside else above, read) and _says_something(below, read):
            found.append(_warning(source, place, "" if inside and text[place] == "+" else "constrain "))
    return found


def _leaves(statements: Sequence[ast.Statement]) -> list[ast.Node]:
    """Returns the statements that hold no others, at any depth."""
    leaves: list[ast.Node] = []
    stack: list[ast.Node] = list(statements)
    while stack:
        node = stack.pop()
        blocks = [child for child in ast.children(node) if isinstance(child, ast.Block)]
        if not blocks or (isinstance(node, ast.Constrain) and not node.braces):
            leaves.append(node)
        else:
            stack += [statement for block in blocks for statement in block.statements]
    return leaves


def _whole(text: str, read: Callable[[SourceFile], _Parsed]) -> bool:
    parsed = read(SourceFile("", text))
    return not parsed.diagnostics and len(parsed.module.statements) == 1


def _says_something(text: str, read: Callable[[SourceFile], _Parsed]) -> bool:
    """Tells whether an expression would constrain anything by itself."""
    parsed = read(SourceFile("", f"constrain {text}\n"))
    if parsed.diagnostics or len(parsed.module.statements) != 1:
        return False
    statement = parsed.module.statements[0]
    if not isinstance(statement, ast.Constrain) or len(statement.items.statements) != 1:
        return False
    item = statement.items.statements[0]
    return isinstance(item, ast.Equation) or (
        isinstance(item, ast.ExpressionStatement) and isinstance(item.value, ast.Comparison | ast.Membership)
    )


def _warning(source: SourceFile, place: int, begun: str) -> Diagnostic:
    sign = Span(source, place, place + 1)
    begun += sign.text.strip("+")
    before = len(source.text[:place].rstrip())
    message = f"a line that begins with `{sign.text}` continues the line above"
    label = f"this {'subtracts from' if sign.text == '-' else 'adds to'} the expression above"
    hint = "if it was meant as a statement of its own, end the line above with `;`"
    fix = Fix("end the line above with `;`", (Edit(Span(source, before, before), ";"), Edit(sign, begun)))
    return Diagnostic("W0101", message, sign, label, hints=(hint,), fix=fix)
