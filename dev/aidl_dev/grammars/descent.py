"""Rules for engines that read from left to right without a table: no left recursion, few ways open at a time.

GBNF engines follow every way a text may be read at once. A rule that begins with itself never ends there,
and each level of brackets at which two alternatives begin alike doubles the work. So left recursion becomes
repetition, and alternatives that begin with the same rule share it.
"""

from __future__ import annotations

from aidl_dev.grammars.notation import (
    EMPTY,
    Alt,
    Name,
    Node,
    Repeat,
    Rules,
    Seq,
    alt,
    left_recursive,
    optional,
    repeat,
    seq,
)


def from_left_to_right(rules: Rules) -> dict[str, Node]:
    """Returns the same language in rules without left recursion, with common beginnings shared."""
    result = dict(rules)
    choices: set[str] = set()
    for members in left_recursive(rules):
        group = _Group(rules, members)
        result = {name: group.joined(node) for name, node in result.items()} | group.rules
        choices |= group.choices
    shared = _Sharing(result, (frozenset(rules) | choices) - {"gap", "new_line"})
    return {name: shared.node(node) for name, node in result.items()}


class _Group:
    """A group of mutually left-recursive rules.

    What they hold is a walk: from a beginning that is in no rule of the group (`base`), over what may
    follow each rule that is complete (`steps`), to the rule that was wanted. `rules` are the new ones: for
    each old rule its beginnings, and behind these one rule for each place on the walk, which may be empty
    at its end; `choices` are those to any of several rules.
    """

    def __init__(self, rules: Rules, group: set[str]) -> None:
        self.group = group
        self.bases: dict[str, Node] = {}
        self.steps: dict[str, list[tuple[str, Node]]] = {name: [] for name in sorted(group)}
        for name in self.steps:
            begun, base = self._split(rules[name])
            if base is not None:
                self.bases[name] = base
            for first, rest in begun:
                self.steps[first].append((name, rest))
        self.choices: set[str] = set()
        self.rules: dict[str, Node] = {}
        for name in self.steps:
            self.rules[name] = self._walk(frozenset([name]))

    def _split(self, node: Node) -> tuple[list[tuple[str, Node]], Node | None]:
        """Splits the alternatives into those that begin with a rule of the group, each with its rest, and the
        others.
        """
        match node:
            case Name(name) if name in self.group:
                return [(name, EMPTY)], None
            case Alt(items):
                begun, others = zip(*map(self._split, items), strict=True)
                bases = [base for base in others if base is not None]
                return [one for some in begun for one in some], alt(*bases) if bases else None
            case Repeat(item, 0, 1):
                some, base = self._split(item)
                return some, EMPTY if base is None else optional(base)
            case Seq(items) if items:
                some, base = self._split(items[0])
                rest = seq(*items[1:])
                return [(name, seq(one, rest)) for name, one in some], None if base is None else seq(
                    base, rest
                )
        return [], node

    def joined(self, node: Node) -> Node:
        """Replaces a choice of rules of the group by one rule, so that they are walked together."""
        match node:
            case Alt(items) if all(isinstance(item, Name) and item.name in self.group for item in items):
                targets = frozenset(item.name for item in items if isinstance(item, Name))
                title = _one_name(targets)
                if title not in self.rules:
                    self.rules[title] = self._walk(targets)
                    self.choices.add(title)
                return Name(title)
            case Alt(items):
                return alt(*map(self.joined, items))
            case Seq(items):
                return seq(*map(self.joined, items))
            case Repeat(item, low, high):
                return repeat(self.joined(item), low, high)
        return node

    def _reaches(self, name: str, targets: frozenset[str]) -> bool:
        seen, pending = set(), [name]
        while pending:
            if (one := pending.pop()) not in seen:
                seen.add(one)
                pending += [after for after, _ in self.steps[one]]
        return not targets.isdisjoint(seen)

    def _walk(self, targets: frozenset[str]) -> Node:
        starts = [n for n in self.bases if self._reaches(n, targets)]
        return alt(*(seq(self.bases[name], self._rest(name, targets)) for name in starts))

    def _rest(self, name: str, targets: frozenset[str]) -> Node:
        """Returns what may follow a complete rule, up to one of the targets."""
        steps = [(after, node) for after, node in self.steps[name] if self._reaches(after, targets)]
        if all(after == name for after, _ in steps) and name in targets:
            return Repeat(alt(*(node for _, node in steps)), 0, None) if steps else EMPTY
        title = f"{name}_to_{_one_name(targets)}"
        if title not in self.rules:
            self.rules[title] = EMPTY  # so that it is not begun again
            ways = [seq(node, self._rest(after, targets)) for after, node in steps]
            self.rules[title] = alt(*ways, *([EMPTY] if name in targets else []))
        return Name(title)


def _one_name(targets: frozenset[str]) -> str:
    """Returns the name of a rule, or of the choice between several whose names begin alike."""
    shortest = min(targets, key=lambda name: (len(name), name))
    return shortest if len(targets) == 1 else f"{shortest}_or_other"


_DEEPEST = 3  # rules to look into for a common beginning


class _Sharing:
    """Shares common beginnings; `open` are the rules that may be expanded for that."""

    def __init__(self, rules: Rules, open: frozenset[str]) -> None:
        self.rules = rules
        self.open = open

    def node(self, node: Node) -> Node:
        match node:
            case Seq(items):
                return seq(*map(self.node, items))
            case Repeat(item, 0, 1):
                return self._choice([EMPTY, *_alternatives(item)])
            case Repeat(item, low, high):
                return repeat(self.node(item), low, high)
            case Alt(items):
                return self._choice(list(items))
        return node

    def _choice(self, items: list[Node]) -> Node:
        while (opened := self._opened(items)) != items:
            items = opened
        by_first: dict[Node, list[Node]] = {}
        for item in items:
            first, rest = _first(item)
            by_first.setdefault(first, []).append(rest)
        return alt(
            *(
                seq(self.node(first), self._choice(rests) if len(rests) > 1 else self.node(rests[0]))
                for first, rests in by_first.items()
            )
        )

    def _opened(self, items: list[Node]) -> list[Node]:
        """Expands the alternatives with one beginning, if that helps to share it."""
        firsts = [_first(item)[0] for item in items]
        below = [self._below(first) for first in firsts]
        pairs = [(i, j) for i in range(len(items)) for j in range(len(items)) if firsts[i] != firsts[j]]
        helps = [
            *(i for i, _ in pairs if _is_choice(firsts[i])),
            *(i for i, j in pairs if firsts[j] in below[i]),
            *(i for i, j in pairs if below[i] & below[j]),
        ]
        for i in helps[:1]:
            first, rest = _first(items[i])
            stands_for = self.rules[first.name] if isinstance(first, Name) else first
            return items[:i] + [seq(one, rest) for one in _alternatives(stands_for)] + items[i + 1 :]
        return items

    def _below(self, node: Node) -> set[Node]:
        """Returns the rules that a rule may begin with, to a small depth."""
        found: set[Node] = set()
        level: set[Node] = {node}
        for _ in range(_DEEPEST):
            level = {
                first
                for one in level
                if isinstance(one, Name) and one.name in self.open
                for alternative in _alternatives(self.rules[one.name])
                for first in [_first(alternative)[0]]
                if isinstance(first, Name) and first.name in self.open
            }
            found |= level
        return found


def _is_choice(node: Node) -> bool:
    """True for a beginning that is a choice; white space is not, since all have it alike."""
    return isinstance(node, Alt) or (isinstance(node, Repeat) and node.high == 1 and node.item != Name("gap"))


def _alternatives(node: Node) -> list[Node]:
    if isinstance(node, Alt):
        return list(node.items)
    if isinstance(node, Repeat) and (node.low, node.high) == (0, 1):
        return [EMPTY, *_alternatives(node.item)]
    return [node]


def _first(node: Node) -> tuple[Node, Node]:
    if isinstance(node, Seq) and node.items:
        return node.items[0], seq(*node.items[1:])
    return node, EMPTY
