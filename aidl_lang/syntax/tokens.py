"""Text to tokens, by the terminals of the grammar.

Newlines and indentation are no tokens. Characters outside any token become one of kind UNKNOWN, which the
parser cannot accept and so reports.
"""

from __future__ import annotations

import re
from dataclasses import field
from functools import cache
from typing import NamedTuple

from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax.ast import Comment
from aidl_lang.syntax.tables import load_tables

END = "$END"
UNKNOWN = "?"


class Token(NamedTuple):
    """A token; `kind` is the text itself for words and signs of the grammar, else the terminal's name."""

    kind: str
    text: str
    start: int
    end: int


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
    match, words, soft = _scanner().match, tables.reserved | tables.soft_words, tables.soft_words
    result = Tokens()
    tokens = result.tokens
    doc: list[str] = []
    position, length = start, len(text) if end is None else end
    while position < length and (found := match(text, position, length)) is not None:
        kind = found.lastgroup
        if kind is None:
            position = found.end()  # the end of the blanks
            if position == length:
                break
            token = _unknown(text, position, length)
        else:
            position, after = found.span(kind)
            word = text[position:after]
            if kind == "COMMENT":
                _take_comment(source, position, word, result.comments, doc)
                position = after
                continue
            if kind == "SIGN" or (kind == "NAME" and word in words):
                kind = word
            token = Token(kind, word, position, after)
            if kind == "NAME" or kind in soft:
                token = _call_or_name(text, token, length, result)
            elif kind == "/" and text.startswith("/*", position):  # a comment that is not closed
                token = Token(UNKNOWN, text[position:length], position, length)
        if tokens and tokens[-1].end == position and tokens[-1].kind in ("NUMBER", ".."):
            token = _touching(tokens, token)
        if doc:
            result.docs[position] = "\n".join(doc)
            doc.clear()
        tokens.append(token)
        position = token.end
    tokens.append(Token(END, "", length, length))
    return result


def is_open_comment(token: Token) -> bool:
    """Tells whether a token is a comment that is not closed, which takes in the rest of the text."""
    return token.kind == UNKNOWN and token.text.startswith("/*")


def _take_comment(source: SourceFile, start: int, text: str, comments: list[Comment], doc: list[str]) -> None:
    comments.append(Comment(Span(source, start, start + len(text)), text))
    if text.startswith("///") and not text.startswith("////") and begins_line(source.text, start):
        doc.append(text[3:].removeprefix(" ").rstrip())


def _call_or_name(text: str, name: Token, length: int, result: Tokens) -> Token:
    """Returns the grammar's CALL: a name that is not reserved, with the `(` that touches it; else the
    name.
    """
    if text.startswith("(", name.end):
        return Token("CALL", name.text + "(", name.start, name.end + 1)
    if name.kind == "NAME" and (spaced := _BLANKS_AND_PARENTHESIS.match(text, name.end, length)):
        call = Token("CALL", name.text + "(", name.start, spaced.end())
        result.spaced_calls.append(call)
        return call
    return name


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
_BLANKS_AND_PARENTHESIS = re.compile(r"[ \t]+\(")


@cache
def _scanner() -> re.Pattern[str]:
    """Returns the pattern for blanks, and the comment or token behind them if one begins there."""
    tables = load_tables()
    patterns = tables.patterns
    signs = sorted((s for s in tables.literals if not s.isidentifier()), key=lambda s: (-len(s), s))
    space, *comments = (patterns[name] for name in tables.ignored)
    named = {
        "COMMENT": "|".join(comments),
        "NAME": patterns["NAME"],
        "NUMBER": patterns["NUMBER"],
        "STRING": patterns["STRING"],
        "SIGN": "|".join(map(re.escape, signs)),
    }
    some = "|".join(f"(?P<{name}>{pattern})" for name, pattern in named.items())
    return re.compile(f"(?:{space})?(?:{some})?")


def _unknown(text: str, start: int, length: int) -> Token:
    """Returns characters that begin no token: an open string, up to the end of its line, or one character."""
    end = start + 1
    if text[start] in "\"'":
        end = text.find("\n", start, length)
        end = length if end < 0 else end
    return Token(UNKNOWN, text[start:end], start, end)
