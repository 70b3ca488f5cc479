"""Grammars as trees: the common form of all formats, and small operations on it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Text:
    """A fixed text."""

    text: str


@dataclass(frozen=True, slots=True)
class Chars:
    r"""One character: the inside of a class such as `A-Za-z_`; `\n`, `\t`, `\r`, `\\` are escaped."""

    members: str


@dataclass(frozen=True, slots=True)
class Name:
    """A rule or a terminal, by its name."""

    name: str


@dataclass(frozen=True, slots=True)
class Seq:
    """Items one after the other; without items, the empty text."""

    items: tuple[Node, ...] = ()


@dataclass(frozen=True, slots=True)
class Alt:
    """One of several."""

    items: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Repeat:
    """From `low` to `high` times; `high` is None without a limit."""

    item: Node
    low: int
    high: int | None


Node = Text | Chars | Name | Seq | Alt | Repeat
Rules = Mapping[str, Node]

EMPTY = Seq()


def seq(*items: Node) -> Node:
    flat: list[Node] = []
    for item in items:
        flat += item.items if isinstance(item, Seq) else (item,)
    return flat[0] if len(flat) == 1 else Seq(tuple(flat))


def alt(*items: Node) -> Node:
    """Returns a choice, each alternative listed once; an empty one makes the rest optional."""
    flat: dict[Node, None] = {}
    for item in items:
        flat.update(dict.fromkeys(item.items if isinstance(item, Alt) else (item,)))
    is_optional = EMPTY in flat
    flat.pop(EMPTY, None)
    if not flat:
        return EMPTY
    one = next(iter(flat)) if len(flat) == 1 else Alt(tuple(flat))
    return optional(one) if is_optional else one


def optional(item: Node) -> Node:
    return (
        repeat(item.item, 0, item.high) if isinstance(item, Repeat) and item.low < 2 else Repeat(item, 0, 1)
    )


def repeat(item: Node, low: int, high: int | None) -> Node:
    return item if (low, high) == (1, 1) else Repeat(item, low, high)


def parts(node: Node) -> tuple[Node, ...]:
    """Returns the children of a node."""
    if isinstance(node, Seq | Alt):
        return node.items
    return (node.item,) if isinstance(node, Repeat) else ()


def names(node: Node) -> Iterator[str]:
    """Yields the names in a node, in order."""
    if isinstance(node, Name):
        yield node.name
    for part in parts(node):
        yield from names(part)


def nullable_rules(rules: Rules) -> set[str]:
    """Returns the rules that may be empty."""
    found: set[str] = set()
    while more := {n for n, node in rules.items() if n not in found and nullable(node, found)}:
        found |= more
    return found


def nullable(node: Node, rules: Iterable[str]) -> bool:
    """Tells whether a node may be empty, given the rules that may."""
    match node:
        case Seq(items):
            return all(nullable(item, rules) for item in items)
        case Alt(items):
            return any(nullable(item, rules) for item in items)
        case Repeat(item, low, _):
            return low == 0 or nullable(item, rules)
        case Name(name):
            return name in rules
    return node == Text("")


def reachable(rules: Rules, start: str) -> dict[str, Node]:
    """Returns the rules that a start needs, each before those it names first."""
    found: dict[str, Node] = {}
    pending = [start]
    while pending:
        name = pending.pop()
        if name not in found and name in rules:
            found[name] = rules[name]
            pending += reversed(list(names(rules[name])))
    return found


def heads(node: Node, empty: set[str]) -> Iterator[Name | Text | Chars]:
    """Yields possible first tokens and rules of a node, given the rules that may be empty."""
    if isinstance(node, Name | Text | Chars):
        yield node
    for part in parts(node):
        yield from heads(part, empty)
        if isinstance(node, Seq) and not nullable(part, empty):
            break


def corners(name: str, rules: Rules, empty: set[str]) -> set[Name | Text | Chars]:
    """Returns all possible first rules and tokens of a rule, at any depth."""
    found: set[Name | Text | Chars] = set()
    pending = [name]
    while pending:
        for head in heads(rules[pending.pop()], empty):
            if head not in found:
                found.add(head)
                if isinstance(head, Name) and head.name in rules:
                    pending.append(head.name)
    return found


def left_recursive(rules: Rules) -> list[set[str]]:
    """Returns the groups of rules that may begin with each other."""
    empty = nullable_rules(rules)
    below = {n: {c.name for c in corners(n, rules, empty) if isinstance(c, Name)} for n in rules}
    groups: list[set[str]] = []
    for name, reached in below.items():
        if name in reached and not any(name in group for group in groups):
            groups.append({other for other in reached & rules.keys() if name in below[other]})
    return groups
