"""Lines of `constrain { }` that begin with a sign, and the question if one begins a constraint of its own.

Newlines mean nothing to the grammar, so `-` goes on with the line above. If it touches its operand, and the
line compares, people read it as the next constraint.
"""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.syntax.tokens import END, Token, begins_line
from aidl_lang.syntax.words import STATEMENT_WORDS

_COMPARING = frozenset({"==", "<=", ">=", "<", ">", "!=", "=", "in"})
_ENDING = STATEMENT_WORDS | {END, ";", ",", "{", "}", "and", "or", "&&", "||", "else"}
_FARTHEST = 500
"""Tokens to look at: nobody writes longer sums by hand."""
_OPERANDS = frozenset({"NAME", "NUMBER", "STRING"})


def begins_with_sign(text: str, tokens: Sequence[Token], position: int) -> bool:
    """Tells whether a token is a `-` that begins a line, touches its operand and stands before a
    comparison.
    """
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
