"""Classifies the tokens of a text by the tokens alone: in broken programs as well as in whole ones.

All colourers follow this: the Pygments lexer uses it, and the grammars for editors are tested against it.
What a name refers to is not asked. So a definition of the program's own that is called like one of the
library is taken for that one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import field
from functools import cache, cached_property
from typing import NamedTuple

from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.syntax.tables import END, UNKNOWN, Token, kind_of, tokenize
from aidl_lang.tools.vocabulary import vocabulary

_ESCAPE = re.compile(r"\\.", re.DOTALL)
_KEYWORD_CLASSES = {
    "declarations": "keyword.declaration",
    "demands": "keyword.demand",
    "modifiers": "keyword.modifier",
    "control": "keyword.control",
    "imports": "keyword.import",
    "clauses": "keyword.clause",
    "word_operators": "keyword.operator",
    "truths": "constant.truth",
    "comparisons": "operator.comparison",
    "arithmetic": "operator.arithmetic",
    "logic": "operator.logic",
    "ranges": "operator.range",
    "assignments": "operator.assignment",
    "brackets": "bracket",
    "punctuation": "punctuation",
    "attribute_signs": "attribute.sign",
}
_CALL_CLASSES = {
    **dict.fromkeys(("primitives", "shapes", "templates"), "call.shape"),
    **dict.fromkeys(("constraints", "relations"), "call.constraint"),
    **dict.fromkeys(("operations", "exactness", "built_in", "functions"), "call.function"),
}
CLASSES = (
    *"comment.line comment.documentation comment.block".split(),
    *_KEYWORD_CLASSES.values(),
    *"kind attribute name.structure name.template name.function name.definition name.parameter".split(),
    *"name.argument name.type name.member name.everywhere name.constant name.module name".split(),
    *"call.shape call.constraint call.function call.member call".split(),
    *"number unit string escape unknown".split(),
)
"""Every class that a piece may have; `.` leads from the general to the special.

name.definition   given by `param`, `let`, `var`, `alias`, `for`, `import`, or by `=` in a block
name.parameter    of a definition; `name.argument` is one that is named in a call
name.everywhere   `origin` and the like; `name.constant` those of the library
call              of what the library has not; `call.member` the same behind a dot
unknown           what is no token
"""


class Piece(NamedTuple):
    """A part of the text without blanks, and its class."""

    start: int
    end: int
    kind: str


def classify(text: str) -> list[Piece]:
    """Returns the pieces of a text in order, without the blanks between them."""
    found = tokenize(SourceFile("", text))
    comments = (Piece(c.span.start, c.span.end, _comment_class(c.text)) for c in found.comments)
    return sorted([*_Reader(text, found.tokens).pieces(), *comments])


def _comment_class(text: str) -> str:
    if text.startswith("/*"):
        return "comment.block"
    return "comment.documentation" if re.match("///(?!/)", text) else "comment.line"


@cache
def fixed_classes() -> dict[str, str]:
    """Returns words and signs of the grammar with their classes."""
    words = vocabulary()
    return {word: kind for name, kind in _KEYWORD_CLASSES.items() for word in getattr(words, name)}


@cache
def called() -> dict[str, str]:
    """Returns callable names, with the class of the call."""
    return {name: _CALL_CLASSES[kind] for name, kind in vocabulary().named().items() if kind in _CALL_CLASSES}


@record(frozen=False)
class _Inside:
    """An open bracket. `role` is `parameters` of a definition, `arguments` of a call, `items` (a block of
    such), `block`, `constraints` (a block of them) or `group`; `header` is `names` before the variables of a
    `for`, or imported names, `values` after the `in` of a `for`, else nothing. `opens` is true behind a
    `for`, an `if` or an `else` among arguments.
    """

    role: str
    header: str = ""
    opens: bool = False


@record(frozen=False)
class _Reader:
    """Walks over the tokens once, with the open brackets."""

    text: str
    tokens: Sequence[Token]
    stack: list[_Inside] = field(default_factory=lambda: [_Inside("block")])
    opens: str = "block"
    """The role of the next `{`, except inside constraints."""

    def pieces(self) -> Iterator[Piece]:
        for place, token in enumerate(self.tokens):
            if token.kind != END:
                yield from self._token(place, token)
                self._track(place, token)

    def _token(self, place: int, token: Token) -> Iterator[Piece]:
        start, end = token.start, token.end
        if token.kind == "NUMBER":
            yield from self._number(token)
        elif token.kind == "STRING":
            yield from self._string(token)
        elif token.kind == "CALL":
            name = token.text.removesuffix("(").rstrip(" \t")
            yield Piece(start, start + len(name), self._call(place, name))
            yield Piece(end - 1, end, "bracket")
        elif token.kind in ("NAME", "as", "from", "then") and not self._is_keyword(place):
            yield Piece(start, end, self._name(place))
        elif token.kind == UNKNOWN:
            yield Piece(start, end, "unknown")
        else:
            yield Piece(start, end, fixed_classes()[token.kind])

    def _number(self, token: Token) -> Iterator[Piece]:
        unit = next((u for u in _units() if token.text.endswith(u)), "")
        middle = token.end - len(unit)
        yield Piece(token.start, middle, "number")
        if unit:
            yield Piece(middle, token.end, "unit")

    def _string(self, token: Token) -> Iterator[Piece]:
        place = token.start
        for escape in _ESCAPE.finditer(self.text, token.start, token.end):
            if place < escape.start():
                yield Piece(place, escape.start(), "string")
            yield Piece(escape.start(), escape.end(), "escape")
            place = escape.end()
        yield Piece(place, token.end, "string")

    # --- Names ------------------------------------------------------------------------------------

    def _kind(self, place: int) -> str:
        return self.tokens[place].kind if 0 <= place < len(self.tokens) else END

    def _is_keyword(self, place: int) -> bool:
        before, after = self._kind(place - 1), self._kind(place + 1)
        match self._kind(place):
            case "as":
                return before == "STRING" and after == "NAME"
            case "from":
                return self.stack[-1].header == "names" and after == "STRING"
            case "then":
                return before not in (".", ",") and after not in ("=", ":", ".", ",")
            case _:
                return False

    def _call(self, place: int, name: str) -> str:
        before = self._kind(place - 1)
        if before == "@":
            return "attribute"
        if before in ("fn", "shape", "constraint"):
            return "name.function"
        if before == "NAME" and self._is_kind(place - 1):
            return "name.template"
        return called().get(name) or ("call.member" if before == "." else "call")

    def _name(self, place: int) -> str:
        before, after = self._kind(place - 1), self._kind(place + 1)
        word, inside = self.tokens[place].text, self.stack[-1]
        if before in _ALONE:
            return _ALONE[before]
        if before == "NAME" and self._is_kind(place - 1):
            return "name.structure"
        if inside.role == "parameters" and before in ("CALL", ","):
            return "name.parameter"
        if inside.role == "parameters" and before == ":":
            return "name.type"
        if inside.role == "arguments" and before in ("CALL", ",") and after in (":", "="):
            return "name.argument"
        if inside.header == "names" or before == "as" or self._is_assigned(place):
            return "name.definition"
        if self._is_kind(place):
            return "kind"
        words = vocabulary()
        if after == "." and word in words.modules:
            return "name.module"
        if word in words.constants:
            return "name.constant"
        return "name.everywhere" if word in words.everywhere else "name"

    def _is_assigned(self, place: int) -> bool:
        """Tells whether `=` gives the name a value here: it begins a statement, outside constraints."""
        begins = self._kind(place - 1) in _BEFORE_STATEMENTS
        return begins and self.stack[-1].role == "block" and self._kind(self._after_index(place + 1)) == "="

    def _is_kind(self, place: int) -> bool:
        """Tells whether the word begins a structure: a name follows, then `{`, `at` or `rotated`."""
        if self._kind(place - 1) not in _BEFORE_STATEMENTS or self.stack[-1].role not in _BLOCKS:
            return False
        known = kind_of(self.tokens[place].text) is not None
        if self._kind(place + 1) == "CALL":
            return known and self._kind(self._closing[place + 1] + 1) in _BEHIND_STRUCTURE
        if self._kind(place + 1) != "NAME":
            return False
        after = self._kind(self._after_index(place + 2))
        if not known or kind_of(self.tokens[place + 1].text) is not None:
            return after in _BEHIND_STRUCTURE
        return after not in ("=", ".")  # its body may still have to be written

    def _after_index(self, place: int) -> int:
        while self._kind(place) == "[":
            place = self._closing[place] + 1
        return place

    @cached_property
    def _closing(self) -> dict[int, int]:
        """The places of brackets with those that close them, or cut them off."""
        found: dict[int, int] = {}
        opened: list[int] = []
        for place, token in enumerate(self.tokens):
            if token.kind in _OPENING:
                opened.append(place)
            elif token.kind in (")", "]") and opened:
                found[opened.pop()] = place
            elif token.kind in ("{", "}", END):
                found.update(dict.fromkeys(opened, place))
                opened.clear()
        return found

    # --- What is open -----------------------------------------------------------------------------

    def _track(self, place: int, token: Token) -> None:
        self._track_header(place, token.kind)
        match token.kind:
            case "CALL":
                before = self._kind(place - 1)
                is_template = before == "NAME" and self._is_kind(place - 1)
                is_head = before in ("fn", "shape", "constraint") or is_template
                self.stack.append(_Inside("parameters" if is_head else "arguments"))
            case "(" | "[":
                self.stack.append(_Inside("group"))
            case ")" | "]":
                if self.stack[-1].role not in _BLOCKS:
                    self.stack.pop()
            case "{" if self.stack[-1].opens:
                self.stack[-1].header, self.stack[-1].opens = "", False
                self.stack.append(_Inside("items"))
            case "{":
                while self.stack[-1].role not in _BLOCKS:
                    self.stack.pop()
                self.stack[-1].header = ""
                nested = self.stack[-1].role == "constraints"
                self.stack.append(_Inside("constraints" if nested else self.opens))
                self.opens = "block"
            case "}":
                while self.stack[-1].role not in (*_BLOCKS, "items"):
                    self.stack.pop()
                if len(self.stack) > 1:
                    self.stack.pop()

    def _track_header(self, place: int, kind: str) -> None:
        inside = self.stack[-1]
        if inside.role in ("arguments", "items"):
            begins = kind in ("for", "if", "else")
            inside.opens = begins or (
                inside.opens and (kind not in ("then", ",") or inside.header == "values")
            )
        if kind in ("for", "import"):
            inside.header = "names"
        elif kind == "in" and inside.header == "names":
            inside.header = "values"
        elif kind == "," and inside.header == "values":
            inside.header = "names"
        elif inside.header == "names" and kind not in ("NAME", ","):
            inside.header = ""
        if kind == "constraint" or (kind == "constrain" and self._kind(place + 1) in ("{", "for", "if")):
            self.opens = "constraints"
        elif kind == "then":
            self.opens = "block"  # `constrain if a then b else c` is one expression


_BLOCKS = ("block", "constraints")
_OPENING = ("CALL", "(", "[")
_BEHIND_STRUCTURE = ("{", "at", "rotated")
_BEFORE_STATEMENTS = frozenset(
    (END, UNKNOWN, *"{ } ; ) ] NAME NUMBER STRING true false True False todo construction template".split())
)
"""Tokens after which a statement may begin."""

_ALONE = {"@": "attribute", ".": "name.member"} | dict.fromkeys(
    ("param", "var", "let", "alias"), "name.definition"
)
"""Classes of a name after these tokens."""


@cache
def _units() -> tuple[str, ...]:
    """Returns units, the longest first, so that `mm` is not taken for `m`."""
    return tuple(sorted(vocabulary().units, key=len, reverse=True))
