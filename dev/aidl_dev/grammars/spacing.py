"""Writes white space into the rules: what `%ignore` and longest matches do for the parser.

Engines for constrained decoding differ in how they read `%ignore`, or have none, and not all of them take the
longest match. So each token is given the white space that may stand before it, by the token before that:

| before | a word or a number | `(` | other signs |
|---|---|---|---|
| a sign, or the beginning (FREE) | any | any | any |
| a keyword or a number (WORD) | some | some | any |
| a name (NAME) | some | a new line | any |

A name and a `(` would be a call, and one with blanks between them is taken for a slip. Where rules end in
different ways, the stricter row holds for what follows. A list of statements, though, is followed up to
each way it ends, so that `;` and `,` need no white space behind them.
"""

from __future__ import annotations

from collections.abc import Iterable

from aidl_dev.grammars.notation import (
    EMPTY,
    Alt,
    Name,
    Node,
    Repeat,
    Rules,
    Seq,
    Text,
    alt,
    corners,
    heads,
    left_recursive,
    nullable,
    nullable_rules,
    optional,
    repeat,
    seq,
)

FREE, WORD, NAME = range(3)
_AFTER = ("", "_after_word", "_after_name")
_ENDING = ("_ending_free", "_ending_in_word", "_ending_in_name")
_TERMINALS = {
    "NAME": NAME,
    "NUMBER": WORD,
    "CALL": FREE,
    "STRING": FREE,
}  # and what they count as to the next
_RULES_INSTEAD = {"NUMBER": "number"}


def spaced(rules: Rules, start: str) -> dict[str, Node]:
    """Returns the rules that `start` needs, with white space before their tokens."""
    weaver = _Weaver(rules)
    weaver.name_for(start, FREE)
    while weaver.pending:
        name, before = weaver.pending.pop()
        ways = weaver.ways(rules[name], before)
        if name in weaver.lists:
            weaver.done |= {weaver.list_title(name, after): node for after, node in ways.items()}
        else:
            weaver.done[name + _AFTER[before]] = alt(*ways.values())
    return weaver.done


class _Weaver:
    """Facts about the rules, those woven so far, and those requested."""

    def __init__(self, rules: Rules) -> None:
        self.rules = rules
        self.done: dict[str, Node] = {}
        self.pending: list[tuple[str, int]] = []
        self.asked: set[tuple[str, int]] = set()
        self.nullable = nullable_rules(rules)
        self.firsts = {name: self._first_kinds(name) for name in rules}
        self.lists = {n for group in left_recursive(rules) if group & self.nullable for n in group}
        self.ends = dict.fromkeys(rules, FREE)
        while (ends := {n: self.end(node) for n, node in rules.items()}) != self.ends:
            self.ends = ends
        self.list_ends: dict[str, set[int]] = {name: set() for name in self.lists}
        while (found := {n: set(self.ways(rules[n], FREE)) for n in self.lists}) != self.list_ends:
            self.list_ends = found
        self.pending.clear()
        self.asked.clear()

    def _first_kinds(self, name: str) -> set[str]:
        first = corners(name, self.rules, self.nullable)
        return {
            _kind(token) for token in first if not isinstance(token, Name) or token.name not in self.rules
        }

    def end(self, node: Node) -> int:
        """Returns the class of the last token, the strictest of the possible ones."""
        match node:
            case Text(text):
                return WORD if text.isidentifier() else FREE
            case Name(name):
                return self.ends[name] if name in self.rules else _TERMINALS[name]
            case Seq(items):
                strictest = FREE
                for item in reversed(items):
                    strictest = max(strictest, self.end(item))
                    if not nullable(item, self.nullable):
                        break
                return strictest
            case Alt(items):
                return max(map(self.end, items))
            case Repeat(item, _, _):
                return self.end(item)
        raise TypeError(node)

    def ways(self, node: Node, before: int) -> dict[int, Node]:
        """Returns the node after a token of class `before`, by the class of its own last token."""
        match node:
            case Name(name) if name in self.lists:
                self.name_for(name, before)
                return {after: Name(self.list_title(name, after)) for after in sorted(self.list_ends[name])}
            case Seq(items):
                ways: dict[int, Node] = {before: EMPTY}
                for item in items:
                    if self._begins_with_sign(item):
                        ways = {FREE: alt(*ways.values())}
                    ways = _union(
                        (after, seq(left, right))
                        for middle, left in ways.items()
                        for after, right in self.ways(item, middle).items()
                    )
                return ways
            case Alt(items):
                return _union(way for item in items for way in self.ways(item, before).items())
            case Repeat(item, low, high):
                inner = before if high == 1 else max(before, self.end(item))
                found = [(after, repeat(way, 1, high)) for after, way in self.ways(item, inner).items()]
                return _union(found if low else [(before, EMPTY), *found])
        return self._one(node, before)

    def _begins_with_sign(self, node: Node) -> bool:
        """True if the token before a node does not matter."""
        first = set(heads(node, self.nullable))
        kinds = [
            self.firsts[n.name] if isinstance(n, Name) and n.name in self.rules else {_kind(n)} for n in first
        ]
        return not nullable(node, self.nullable) and all(kind == {"sign"} for kind in kinds)

    def _one(self, node: Node, before: int) -> dict[int, Node]:
        """Returns the ways of a rule or a token."""
        if isinstance(node, Name) and node.name in self.rules:
            after = max(self.ends[node.name], before if node.name in self.nullable else FREE)
            return {after: Name(self.name_for(node.name, before))}
        return {self.end(node): seq(_gap(before, _kind(node)), _token(node))}

    def name_for(self, name: str, before: int) -> str:
        """Returns the name of a rule after a token of class `before`, made on first use."""
        firsts = self.firsts[name]
        if before == NAME and "(" not in firsts:
            before = WORD
        if before == WORD and firsts == {"sign"}:
            before = FREE
        if (name, before) not in self.asked:
            self.asked.add((name, before))
            self.pending.append((name, before))
        return name + _AFTER[before]

    def list_title(self, name: str, after: int) -> str:
        return name + _ENDING[after]


def _union(ways: Iterable[tuple[int, Node]]) -> dict[int, Node]:
    found: dict[int, Node] = {}
    for after, node in ways:
        found[after] = alt(found[after], node) if after in found else node
    return found


def _kind(token: Node) -> str:
    """Returns the class of a token for the one before it."""
    match token:
        case Text(text):
            return "word" if text.isidentifier() else "(" if text == "(" else "sign"
        case Name(name):
            return "sign" if name == "STRING" else "word"
    raise TypeError(token)


def _gap(before: int, kind: str) -> Node:
    if kind == "sign" or before == FREE:
        return optional(Name("gap"))
    return Name("new_line" if before == NAME and kind == "(" else "gap")


def _token(token: Node) -> Node:
    return Name(_RULES_INSTEAD.get(token.name, token.name)) if isinstance(token, Name) else token
