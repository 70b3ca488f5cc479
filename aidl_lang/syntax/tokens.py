"""Text to tokens, by Lark's lexer.

Newlines and indentation are no tokens. Characters outside any token become one of kind UNKNOWN, which the
parser cannot accept and so reports.
"""

from __future__ import annotations

from dataclasses import field
from typing import cast

from lark import TextSlice
from lark.lexer import LexerState
from lark.lexer import Token as LarkToken

from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax.ast import Comment
from aidl_lang.syntax.tables import UNKNOWN as UNKNOWN
from aidl_lang.syntax.tables import load_tables

END = "$END"


class Token(LarkToken):
    """A token; `kind` is the text itself for words and signs of the grammar, else the terminal's name."""

    __slots__ = ("kind",)
    kind: str
    # Lark's own, under shorter names.
    text = cast(str, LarkToken.value)
    start = cast(int, LarkToken.start_pos)
    end = cast(int, LarkToken.end_pos)

    def __new__(cls, kind: str, text: str, start: int, end: int) -> Token:
        token = str.__new__(cls, text)
        token.kind, token.value, token.start_pos, token.end_pos = kind, text, start, end
        token.type = load_tables().types.get(kind, kind)
        token.line = token.column = token.end_line = token.end_column = None
        return token

    def but(self, kind: str, text: str) -> Token:
        """Returns another token in the place of this one."""
        return Token(kind, text, self.start, self.end)


@record(frozen=False)
class Tokens:
    """The tokens of a text.

    `tokens` ends with one of kind END; `docs` holds `///` texts by the offset of the token they stand before;
    `spaced_calls` are the calls whose `(` does not touch the name, which is understood and reported.
    """

    tokens: list[Token] = field(default_factory=list)
    comments: list[Comment] = field(default_factory=list)
    docs: dict[int, str] = field(default_factory=dict)
    spaced_calls: list[Token] = field(default_factory=list)


def tokenize(source: SourceFile, start: int = 0, end: int | None = None) -> Tokens:
    """Returns the tokens of a text or a part of it. Never fails: see UNKNOWN."""
    text, tables = source.text, load_tables()
    length = len(text) if end is None else end
    result = Tokens()
    tokens = result.tokens
    doc: list[str] = []
    state = LexerState(TextSlice(text, start, length))
    for found in tables.lark.parser.lexer.lex(state, None):
        kind, word, position = tables.kinds.get(found.type, found.type), found.value, found.start_pos
        if kind in tables.comments:
            _take_comment(source, position, word, result.comments, doc)
            continue
        token = Token(kind, word, position, position + len(word))
        if doc:
            result.docs[position] = "\n".join(doc)
            doc.clear()
        if tokens and tokens[-1].end == position and tokens[-1].kind in ("NUMBER", ".."):
            token = _touching(tokens, token)
            state.line_ctr.char_pos = token.end
        elif kind == "(" and tokens and tokens[-1].kind == "NAME":
            name = tokens[-1]
            if not text[name.end : position].strip(" \t"):
                tokens.pop()
                token = Token("CALL", name.text + "(", name.start, token.end)
                result.spaced_calls.append(token)
        tokens.append(token)
    tokens.append(Token(END, "", length, length))
    return result


def is_open_comment(token: Token) -> bool:
    """Tells whether a token is a comment that is not closed, which takes in the rest of the text."""
    return token.kind == UNKNOWN and token.text.startswith("/*")


def _take_comment(source: SourceFile, start: int, text: str, comments: list[Comment], doc: list[str]) -> None:
    comments.append(Comment(Span(source, start, start + len(text)), text))
    if text.startswith("///") and not text.startswith("////") and begins_line(source.text, start):
        doc.append(text[3:].removeprefix(" ").rstrip())


def _touching(tokens: list[Token], token: Token) -> Token:
    """Splits a token that touches a number or `..`: letters behind a number are meant as a unit."""
    before = tokens[-1]
    if before.kind == "NUMBER" and token.kind in ("NAME", "CALL", "NUMBER"):
        digits = before.text.rstrip(_LETTERS) if token.kind != "NUMBER" else before.text
        tokens[-1] = Token("NUMBER", digits, before.start, before.start + len(digits))
        text = before.text[len(digits) :] + token.text.rstrip("(")
        return Token(UNKNOWN, text, tokens[-1].end, tokens[-1].end + len(text))
    if before.kind == ".." and token.kind == "NUMBER" and token.text[0] == ".":
        return Token(".", ".", token.start, token.start + 1)  # `0...5` is no range that ends at .5
    return token


def begins_line(text: str, offset: int) -> bool:
    """Tells whether only white space stands before an offset on its line."""
    return not text[text.rfind("\n", 0, offset) + 1 : offset].strip()


_LETTERS = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ°"
