"""Compares two programs: things are matched, and the fate of each item of the earlier one is told."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from enum import StrEnum
from itertools import chain

from aidl_lang.common.records import record
from aidl_lang.syntax import ast
from aidl_lang.tools.llm.intent.inventory import (
    STATED,
    Inventory,
    Item,
    Key,
    Kind,
    Path,
    names_in,
    shape,
    translated,
    unnumbered,
)

# --- Matches the structures and geometries of two programs: by path, by name elsewhere, by content.

_MOST = 50
"""Most new structures compared with one that may have been renamed."""
_ALIKE = 0.5
"""Share of content that a renamed structure has to keep."""


class _Matching:
    def __init__(self, before: Inventory, after: Inventory) -> None:
        self.before, self.after = before, after
        self.found: dict[Path, Path] = {}
        self.taken: set[Path] = set()
        self.turns = {o.thing[:-1]: o for o in reversed(after.things.values()) if o.thing[-1].startswith("[")}
        self.new = [o for path, o in after.things.items() if path not in before.things]
        self.by_name: dict[Path, list[Item]] = {}
        self.by_home: dict[Path, list[Item]] = {}
        for other in self.new:
            self.by_name.setdefault(other.thing[len(other.home) :], []).append(other)
            self.by_home.setdefault(other.home, []).append(other)
        self.contents = _contents(before), _contents(after)

    def run(self) -> dict[Path, Path]:
        roots = _root(self.before), _root(self.after)
        if roots[0] and roots[1] and roots[0].thing not in self.after.things:
            self._take(roots[0], roots[1])
        for item in self.before.things.values():  # parents first
            if item.thing not in self.found:
                for way in (self._in_place, self._elsewhere, self._renamed):
                    if (other := way(item)) is not None:
                        self._take(item, other)
                        break
        return self.found

    def _take(self, item: Item, other: Item) -> None:
        self.found[item.thing] = other.thing
        self.taken.add(other.thing)

    def _home(self, item: Item) -> Path | None:
        return self.found.get(item.home) if item.home in self.before.things else item.home

    def _in_place(self, item: Item) -> Item | None:
        """Returns the thing of the same name in the same structure, with or without the index of a loop."""
        home = self._home(item)
        if home is None:
            return None
        path = (*home, *item.thing[len(item.home) :])
        name = path[: len(home) + 1]
        things = self.after.things
        return things.get(path) or things.get(name) or self.turns.get(name)

    def _elsewhere(self, item: Item) -> Item | None:
        """Returns the thing of the same name in another structure, if new there; geometry must be alike."""
        name = item.thing[len(item.home) :]
        candidates = self._free(item, self.by_name.get(name, ()))
        if item.kind is Kind.GEOMETRY:
            wanted = shape(translated(item.key, self.found))
            candidates = (o for o in candidates if o.word == item.word and o.shape == wanted)
        return next(candidates, None)

    def _renamed(self, item: Item) -> Item | None:
        """Returns the thing with like content under another name in the same structure."""
        home = self._home(item)
        siblings = self._free(item, self.by_home.get(home, ()) if home is not None else ())
        # none that has its name from a thing of the earlier program
        fresh = (o for o in siblings if (*item.home, *o.thing[len(o.home) :]) not in self.before.things)
        new = [o for o in fresh if o.word == item.word]
        if item.kind is Kind.STRUCTURE:
            likely = ((self._likeness(item, other), other) for other in new[:_MOST])
            share, best = max(likely, key=lambda each: each[0], default=(0.0, None))
            return best if share >= _ALIKE else None
        key = translated(item.key, self.found)
        here = (i for i in self.before.things.values() if i.home == item.home and i.kind is Kind.GEOMETRY)
        gone = [i for i in here if self._in_place(i) is None and i.word == item.word]
        equal = next((o for o in new if o.key == key), None)
        return equal or (new[0] if len(new) == len(gone) == 1 else None)

    def _free(self, item: Item, others: Iterable[Item]) -> Iterator[Item]:
        return (o for o in others if o.thing not in self.taken and o.kind is item.kind)

    def _likeness(self, item: Item, other: Item) -> float:
        """Returns the common share of two structures' contents, from 0 to 1."""
        a, b = self.contents[0][item.thing], self.contents[1][other.thing]
        return (a & b).total() / max(1, (a | b).total())


def _root(inventory: Inventory) -> Item | None:
    """Returns the structure that is drawn: the last outermost one that is no template."""
    outermost = (i for i in reversed(inventory.items) if i.kind is Kind.STRUCTURE and not i.home)
    return next((i for i in outermost if getattr(i.node, "parameters", None) is None), None)


def _contents(inventory: Inventory) -> dict[Path, Counter[object]]:
    """Returns the content of each structure in words that do not depend on its names, and these names."""
    contents = {item.thing: Counter[object]() for item in inventory.things.values()}
    for item in inventory.items:
        for path in (item.home[:k] for k in range(1, len(item.home) + 1)):
            if path not in contents:
                continue
            inner = {t: ("here",) * len(t[len(path) :]) for t in item.things if t[: len(path)] == path}
            contents[path][item.kind, item.home[len(path) :], translated(item.key, inner)] += 1
            if item.kind in (Kind.GEOMETRY, Kind.STRUCTURE):
                contents[path]["name", item.thing[len(path) :]] += 1
                contents[path]["word", item.word] += 1
    return contents


class Fate(StrEnum):
    KEPT = "kept"  # perhaps with another number, name, maker, loop around it, or in another structure
    REWRITTEN = "rewritten"  # another statement about the same things
    FEWER = "fewer"  # a loop or a list makes less of them
    WEAKENED = "weakened"  # it was asked for, and is wished for or only checked
    GONE = "gone"


@record()
class Changes:
    """The changes from one program to the next.

    paths  things of the earlier program → their paths in the later one
    fates  items of the earlier program → their fates, and their counterparts in the later one (None if gone)
    """

    before: Inventory
    after: Inventory
    paths: Mapping[Path, Path]
    fates: Mapping[Item, tuple[Fate, Item | None]]


def compare(before: Inventory, after: Inventory) -> Changes:
    """Pairs the items of one program with those of the next."""
    paths = _Matching(before, after).run()
    statements = _Statements(before, after, paths)
    statements.pair()
    fates: dict[Item, tuple[Fate, Item | None]] = {}
    for item in before.items:
        if item.kind in STATED:
            fates[item] = statements.fates.get(item, (Fate.GONE, None))
        elif item.kind is Kind.PARAM:
            fates[item] = _of_param(item, after, paths)
        else:
            fates[item] = _of_thing(item, before, after, paths)
    return Changes(before, after, paths, fates)


def _of_thing(
    item: Item, before: Inventory, after: Inventory, paths: Mapping[Path, Path]
) -> tuple[Fate, Item | None]:
    path = paths.get(item.thing)
    if path is None:
        return Fate.GONE, None
    other = after.things[path]
    return (Fate.FEWER if _are_fewer(item, before, other, after) else Fate.KEPT), other


def _are_fewer(item: Item, before: Inventory, other: Item, after: Inventory) -> bool:
    """True if the number of something per holder has shrunk, and no param decides over it."""
    many, few = before.count(item), after.count(other)
    if not 0 < few < many or item.thing[-1].startswith("["):
        return False
    homes = before.counts[unnumbered(item.home)], after.counts[unnumbered(other.home)]
    return homes[0] <= homes[1] and not (_decides(item) & before.knobs or _decides(other) & after.knobs)


def _decides(item: Item) -> frozenset[str]:
    """Returns the names in what decides the number of something."""
    made: Key = ()
    match item.node:
        case ast.Assign(indices=(), value=ast.Comprehension()):
            made = (item.key[1], item.key[3])
        case ast.Assign(indices=(), value=ast.Call()):
            made = item.key
    return names_in((item.context, made))


def _of_param(item: Item, after: Inventory, paths: Mapping[Path, Path]) -> tuple[Fate, Item | None]:
    """Returns the fate of a param: it keeps its name, or is recognised by its words wherever it stands."""
    params = [i for i in after.items if i.kind is Kind.PARAM]
    home = paths.get(item.home, item.home)
    name = item.thing[-1]
    ways = (
        (o for o in params if o.thing == (*home, name)),
        (o for o in params if o.thing[-1] == name),
        (o for o in params if o.home == home and o.key[2:] == item.key[2:]),
    )
    other = next(chain(*ways), None)
    return (Fate.GONE if other is None else Fate.KEPT), other


_Marks = Callable[[Item], Iterable[object]]
_SAME: tuple[_Marks, _Marks] = (lambda one: [(one.key, one.context)], lambda one: [(one.home, one.text)])
_ALIKE_BUT: tuple[_Marks, _Marks] = (lambda one: [one.key], lambda one: [one.shape])
"""Marks of statements that are the same, and of those with another number or loop around them."""


class _Statements:
    """Pairs statements once, the surest first; a relation may stand for several equations on its things."""

    def __init__(self, before: Inventory, after: Inventory, paths: Mapping[Path, Path]) -> None:
        self.fates: dict[Item, tuple[Fate, Item | None]] = {}
        self.open = [
            (i, replace(i, key=translated(i.key, paths), home=paths.get(i.home, i.home)))
            for i in before.items
            if i.kind in STATED
        ]
        """The statements without a counterpart, each also as it would read in the later program."""
        self.free = [i for i in after.items if i.kind in STATED]

    def pair(self) -> None:
        for ways in (_SAME, _ALIKE_BUT):
            for sign in (0, -1, 1):  # as strong, weaker, stronger
                for marks in ways:
                    self._phase(Fate.WEAKENED if sign < 0 else Fate.KEPT, (sign,), marks)
        self._phase(Fate.REWRITTEN, (0, 1), lambda one: one.things, _about)
        self._phase(Fate.WEAKENED, (-1,), lambda one: one.things, _about)

    def _phase(self, fate: Fate, signs: tuple[int, ...], marks: _Marks, about: _Marks | None = None) -> None:
        """Pairs items that share a mark, and differ so in strength; with `about` if one says the other."""
        marked: dict[object, list[Item]] = {}
        for other in self.free:
            for mark in (about or marks)(other):
                marked.setdefault(mark, []).append(other)
        left: list[tuple[Item, Item]] = []
        spent: set[Item] = set()

        def fits(read: Item, other: Item) -> bool:
            a, b = strength(other), strength(read)
            return (a > b) - (a < b) in signs and (about is None or _says_instead(read, other))

        for item, read in self.open:
            near = (other for mark in marks(read) for other in marked.get(mark, ()))
            found = next((other for other in near if other not in spent and fits(read, other)), None)
            if found is None:
                left.append((item, read))
                continue
            self.fates[item] = fate, found
            if not (fate is Fate.REWRITTEN and found.key[:1] == ("call",)):
                spent.add(found)
        self.open = left
        self.free = [o for o in self.free if o not in spent]


def strength(item: Item) -> int:
    """Returns the strength of an item: constraints over wishes over asserts."""
    return 0 if item.kind is Kind.ASSERT else 1 if item.wish else 2


def _about(one: Item) -> Iterable[Path]:
    """Yields the things that an item speaks of; a turn may be meant for all that holds the thing turned."""
    yield from one.things
    if one.kind is Kind.ROTATION:
        yield from {thing[:n] for thing in one.things for n in range(1, len(thing))}


def _says_instead(read: Item, other: Item) -> bool:
    """True if a new statement refers to the same things, from the same structure or one around it. A
    statement that was wrong may be replaced by one about any of them; a turn is replaced by a turn.
    """
    if read.kind is Kind.ASSERT:
        return other.kind is Kind.ASSERT and read.things == other.things and bool(read.things)
    if read.home[: len(other.home)] != other.home and not other.thing:
        return False
    if read.wrong:
        if other.kind is Kind.ROTATION and any(o[: len(t)] == t for t in read.things for o in other.things):
            return True  # what is in a structure was turned in its place
        return bool(read.things & other.things) and other.kind is not Kind.ASSERT
    if read.kind in (Kind.ROTATION, Kind.OPERATION) and other.kind is not read.kind:
        return False
    return bool(read.things) and read.things <= other.things
