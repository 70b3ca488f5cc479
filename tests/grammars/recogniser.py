"""A reader of GBNF that works as llama.cpp does: it follows every way to read a text, by characters.

The notation is read by llguidance's parser for it, the characters by `re`.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

from llguidance import gbnf_to_lark as gbnf


class Stack:
    """What is to come: `top`, a node or a class of characters, then `below`. Each is made once."""

    def __init__(self, top: Any, below: Stack | None) -> None:
        self.top = top
        self.below = below


class Recogniser:
    """Texts of one grammar. A grammar with left recursion ends in a RecursionError."""

    def __init__(self, text: str) -> None:
        self.rules = gbnf.GrammarParser().parse(text)
        self.most = 0  # ways open at once so far
        self._stacks: dict[tuple[int, int], Stack] = {}
        self._repetitions: dict[tuple[int, int, int | None], Any] = {}
        self._classes: dict[str, str] = {}
        self._opened: dict[Stack, frozenset[Stack | None]] = {}

    def takes(self, text: str) -> bool:
        ways = self._open(self._push(gbnf.RuleRefNode("root"), None))
        for character in text:
            fitting = [way.below for way in ways if way is not None and _fits(way.top, character)]
            ways = frozenset().union(*map(self._open, fitting))
            self.most = max(self.most, len(ways))
        return None in ways

    def _push(self, top: Any, below: Stack | None) -> Stack:
        if isinstance(top, str):
            top = self._classes.setdefault(top, top)
        key = id(top), id(below)
        if key not in self._stacks:
            self._stacks[key] = Stack(top, below)
        return self._stacks[key]

    def _open(self, stack: Stack | None) -> frozenset[Stack | None]:
        """The stacks with a class of characters on top that one may become, and None where it may be done."""
        if stack is None or isinstance(stack.top, str):
            return frozenset([stack])
        if stack not in self._opened:
            self._opened[stack] = self._step(stack.top, stack.below)
        return self._opened[stack]

    def _step(self, node: Any, below: Stack | None) -> frozenset[Stack | None]:
        match node:
            case gbnf.LiteralNode():
                for character in reversed(_plain(node.value)):
                    below = self._push(f"[{re.escape(character)}]", below)
            case gbnf.RegexNode():
                below = self._push(node.rx, below)
            case gbnf.RuleRefNode():
                below = self._push(self.rules[node.name].alternatives, below)
            case gbnf.SequenceNode():
                for item in reversed(node.nodes):
                    below = self._push(item, below)
            case gbnf.AlternativeNode():
                return frozenset().union(*(self._open(self._push(item, below)) for item in node.alternatives))
            case gbnf.RepetitionNode():
                return self._repeated(node.node, node.min_times, node.max_times, below)
        return self._open(below)

    def _repeated(
        self, item: Any, low: int, high: int | None, below: Stack | None
    ) -> frozenset[Stack | None]:
        if high == 0:
            return self._open(below)
        less = id(item), max(low - 1, 0), None if high is None else high - 1
        rest = self._repetitions.setdefault(less, gbnf.RepetitionNode(item, *less[1:]))
        more = self._open(self._push(item, self._push(rest, below)))
        return more if low else more | self._open(below)


def _plain(text: str) -> str:
    return re.sub(r"\\(.)", lambda found: {"n": "\n", "t": "\t", "r": "\r"}.get(found[1], found[1]), text)


@cache
def _fits(members: str, character: str) -> bool:
    return re.fullmatch(members, character) is not None
