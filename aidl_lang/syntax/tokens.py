"""Text to tokens, by the terminals of the grammar.

Newlines and indentation are no tokens. What belongs to no token becomes one of kind UNKNOWN, which the parser
cannot accept and so reports.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cache
from typing import NamedTuple

from aidl_lang.ast import Comment
from aidl_lang.source import SourceFile, Span
from aidl_lang.syntax.tables import load_tables

END = "$END"
UNKNOWN = "?"


class Token(NamedTuple):
    """`kind` is the text itself for words and signs of the grammar, else the terminal's name."""

    kind: str
    text: str
    start: int
    end: int


@dataclass
class Tokens:
    """What a text consists of.

    `tokens` ends with one of kind END; `docs` holds `///` texts by the offset of the token they stand before;
    `spaced_calls` are the calls whose `(` does not touch the name, which is understood and reported.
    """

    tokens: list[Token] = field(default_factory=list)
    comments: list[Comment] = field(default_factory=list)
    docs: dict[int, str] = field(default_factory=dict)
    spaced_calls: list[Token] = field(default_factory=list)


def tokenize(source: SourceFile, start: int = 0, end: int | None = None) -> Tokens:
    """The tokens of a text or a part of it. Never fails: see UNKNOWN."""
    text, tables = source.text, load_tables()
    match = _scanner().match
    words, soft = tables.reserved | tables.soft_words, tables.soft_words
    result = Tokens()
    tokens = result.tokens
    doc: list[str] = []
    position, length = start, len(text) if end is None else end
    while position < length:
        if (found := match(text, position, length)) is None:
            stop = _unknown_end(text, position, length)
            tokens.append(Token(UNKNOWN, text[position:stop], position, stop))
            position = stop
            continue
        kind, stop, word = found.lastgroup or UNKNOWN, found.end(), found.group()
        if kind == "SPACE":
            position = stop
            continue
        if kind == "COMMENT":
            result.comments.append(Comment(Span(source, position, stop), word))
            if word.startswith("///") and not word.startswith("////") and begins_line(text, position):
                doc.append(word[3:].removeprefix(" ").rstrip())
            position = stop
            continue
        touches = tokens and tokens[-1].kind == "NUMBER" and tokens[-1].end == position
        if kind == "NAME":
            if word in words:
                kind = word
            # The grammar's CALL, read as what it is: a name that is not reserved, and the `(` that touches it.
            if kind == "NAME" or kind in soft:
                if text.startswith("(", stop):
                    kind, word, stop = "CALL", word + "(", stop + 1
                elif kind == "NAME" and (spaced := _BLANKS_AND_PARENTHESIS.match(text, stop, length)):
                    kind, word, stop = "CALL", word + "(", spaced.end()
                    result.spaced_calls.append(Token(kind, word, position, stop))
        elif kind == "SIGN":
            kind = word if not text.startswith("/*", position) else UNKNOWN
            if kind == UNKNOWN:
                word, stop = text[position:length], length  # a comment that is not closed
        elif kind == "NUMBER" and word[0] == "." and tokens and tokens[-1][::3] == ("..", position):
            kind, word, stop = ".", ".", position + 1  # `0...5` is no range that ends at .5
        if touches and kind in ("NAME", "CALL", "NUMBER"):
            kind, word, stop = UNKNOWN, word.rstrip("("), position + len(word.rstrip("("))
        if doc:
            result.docs[position] = "\n".join(doc)
            doc = []
        tokens.append(Token(kind, word, position, stop))
        position = stop
    tokens.append(Token(END, "", length, length))
    return result


def begins_line(text: str, offset: int) -> bool:
    """Whether only white space stands before an offset on its line."""
    return not text[text.rfind("\n", 0, offset) + 1 : offset].strip()


_BLANKS_AND_PARENTHESIS = re.compile(r"[ \t]+\(")


@cache
def _scanner() -> re.Pattern[str]:
    tables = load_tables()
    patterns = tables.patterns
    signs = sorted((s for s in tables.literals if not s.isidentifier()), key=lambda s: (-len(s), s))
    space, *comments = (patterns[name] for name in tables.ignored)
    named = {
        "SPACE": space,
        "COMMENT": "|".join(comments),
        "NAME": patterns["NAME"],
        "NUMBER": patterns["NUMBER"],
        "STRING": patterns["STRING"],
        "SIGN": "|".join(map(re.escape, signs)),
    }
    return re.compile("|".join(f"(?P<{name}>{pattern})" for name, pattern in named.items()))


def _unknown_end(text: str, start: int, length: int) -> int:
    """Where the stretch ends that begins no token: an open comment or string runs on, the rest is one character."""
    if text.startswith("/*", start):
        return length
    if text[start] in "\"'":
        end = text.find("\n", start, length)
        return length if end < 0 else end
    return start + 1
