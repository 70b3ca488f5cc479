"""Reads the grammar file as trees, as far as it uses Lark's notation."""

from __future__ import annotations

import re
from functools import cache

from aidl_dev.grammars.notation import EMPTY, Name, Node, Repeat, Text, alt, optional, seq
from aidl_lang.common.resources import resource

_TOKEN = re.compile(
    r"""\s+ | //[^\n]*
    | (?P<head> (?<![^\n]) [?!]* [A-Za-z_]\w* (?=\s*:) )
    | (?P<ignore> (?<![^\n]) %ignore [^\n]* )
    | (?P<alias> -> \s* \w+ )
    | (?P<text> "(?:[^"\\]|\\.)*" )
    | (?P<regex> /(?:[^/\\\n]|\\.)+/ )
    | (?P<name> [A-Za-z_]\w* )
    | (?P<sign> [:|()?*+] )""",
    re.VERBOSE,
)
_COUNTS: dict[str, tuple[int, int | None]] = {"?": (0, 1), "*": (0, None), "+": (1, None)}


@cache
def read_rules() -> dict[str, Node]:
    """Returns the rules of `grammar/aidl.lark` as trees."""
    definitions = _definitions(resource("grammar/aidl.lark").read_text("utf-8"))
    return {name: _Reader(found).alternatives() for name, found in definitions.items() if name.islower()}


def _definitions(text: str) -> dict[str, list[tuple[str, str]]]:
    """Returns the tokens after the colon of each definition. Raises ValueError for unknown notation."""
    found: dict[str, list[tuple[str, str]]] = {}
    current: list[tuple[str, str]] = []
    position = 0
    while position < len(text):
        token = _TOKEN.match(text, position)
        if token is None:
            raise ValueError(f"unknown notation in the grammar: {text[position : position + 40]!r}")
        position = token.end()
        if token.lastgroup == "head":
            current = found[token.group().lstrip("?!")] = []
        elif token.lastgroup and token.lastgroup not in ("ignore", "alias") and token.group() != ":":
            current.append((token.lastgroup, token.group()))
    return found


class _Reader:
    """Recursive descent over the tokens of one definition."""

    def __init__(self, tokens: list[tuple[str, str]]) -> None:
        self.tokens = tokens
        self.position = 0

    def _is_at(self, signs: str) -> bool:
        if self.position == len(self.tokens):
            return False
        kind, text = self.tokens[self.position]
        return kind == "sign" and text in signs

    def alternatives(self) -> Node:
        items = [self._sequence()]
        while self._is_at("|"):
            self.position += 1
            items.append(self._sequence())
        return alt(*items)

    def _sequence(self) -> Node:
        items: list[Node] = [EMPTY]
        while self.position < len(self.tokens) and not self._is_at("|)"):
            items.append(self._counted())
        return seq(*items)

    def _counted(self) -> Node:
        item = self._item()
        while self._is_at("?*+"):
            low, high = _COUNTS[self.tokens[self.position][1]]
            self.position += 1
            item = optional(item) if high == 1 else Repeat(item, low, high)
        return item

    def _item(self) -> Node:
        kind, text = self.tokens[self.position]
        self.position += 1
        if kind == "text":
            return Text(text[1:-1])
        if kind == "name":
            return Name(text)
        if text != "(":
            raise ValueError(f"a rule of the grammar holds {text!r}, which no export is made for")
        inner = self.alternatives()
        self.position += 1
        return inner
