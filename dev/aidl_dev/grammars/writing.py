"""Writes trees as text, in the notation of each format."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass

from aidl_dev.grammars.notation import Alt, Chars, Name, Node, Repeat, Rules, Seq, Text

_SHORT = 80  # alternatives up to this length share a line
_SIGNS = {(0, 1): "?", (0, None): "*", (1, None): "+"}


@dataclass(frozen=True)
class Notation:
    """The notation of one format. `counted` writes the bounds of a repetition."""

    defines: str
    between: str  # alternatives that are too long for one line
    name: Callable[[str], str]
    text: Callable[[str], str]
    chars: Callable[[str], str]
    counted: Callable[[int, int | None], str]

    def definitions(self, rules: Rules) -> str:
        """Returns one definition below the other."""
        return "".join(f"{self.name(n)}{self.defines} {self._choice(node)}\n" for n, node in rules.items())

    def _choice(self, node: Node) -> str:
        if not isinstance(node, Alt):
            return self._item(node)
        items = [self._item(item) for item in node.items]
        return (" | " if sum(map(len, items)) < _SHORT else self.between).join(items)

    def _item(self, node: Node) -> str:
        match node:
            case Text(text):
                return self.text(text)
            case Chars(members):
                return self.chars(members)
            case Name(name):
                return self.name(name)
            case Seq(items):
                return " ".join(map(self._item, items))
            case Repeat(item, low, high):
                inner = f"({self._choice(item)})" if isinstance(item, Seq | Repeat) else self._item(item)
                return inner + (_SIGNS.get((low, high)) or self.counted(low, high))
            case Alt():
                return f"({self._choice(node)})"


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _name_in_gbnf(name: str) -> str:
    """Returns a name of letters, digits and dashes, which all GBNF readers take."""
    return "root" if name == "start" else ("in" if name.startswith("_") else "") + name.replace("_", "-")


def _chars_in_w3c(members: str) -> str:
    for escape, plain in (("\\n", "#xA"), ("\\r", "#xD"), ("\\t", "#x9"), ("\\\\", "#x5C")):
        members = members.replace(escape, plain)
    return f"[{members}]"


LARK = Notation(
    ":", "\n    | ", str, _quoted, lambda members: f"/[{members}]/", lambda low, high: f"~{low}..{high}"
)
GBNF = Notation(
    " ::=",
    " | ",
    _name_in_gbnf,
    _quoted,
    lambda members: f"[{members}]",
    lambda low, high: f"{{{low},{high}}}",
)
# W3C EBNF has no bounds: they are dropped.
W3C = Notation(
    " ::=",
    "\n    | ",
    lambda name: name.lstrip("_") if name != "_arguments" else "argument_list",
    lambda text: f"'{text}'" if '"' in text else f'"{text}"',
    _chars_in_w3c,
    lambda low, high: "+" if low else "*",
)
