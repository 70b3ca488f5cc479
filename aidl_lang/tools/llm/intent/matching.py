"""Matches the structures and geometries of two programs: by path, by name elsewhere, by content."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable

from aidl_lang.tools.llm.intent.inventory import Inventory, Item, Kind, Path, shape, translated

_MOST = 50
"""Most new structures compared with one that may have been renamed."""
_ALIKE = 0.5
"""Share of content that a renamed structure has to keep."""


def match_things(before: Inventory, after: Inventory) -> dict[Path, Path]:
    """Returns the new path of each thing that is found again."""
    return _Matching(before, after).run()


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
        """Returns the present path of the structure that holds a thing."""
        return self.found.get(item.home) if item.home in self.before.things else item.home

    def _in_place(self, item: Item) -> Item | None:
        """Returns the thing of the same name in the same structure; an index may have come or gone with a
        loop.
        """
        home = self._home(item)
        if home is None:
            return None
        path = (*home, *item.thing[len(item.home) :])
        name = path[: len(home) + 1]
        things = self.after.things
        return things.get(path) or things.get(name) or self.turns.get(name)

    def _elsewhere(self, item: Item) -> Item | None:
        """Returns the thing of the same name in another structure, if that is new there; geometry also has to
        be alike.
        """
        name = item.thing[len(item.home) :]
        candidates = self._free(item, self.by_name.get(name, ()))
        if item.kind is Kind.GEOMETRY:
            candidates = (o for o in candidates if o.word == item.word and o.shape == self._shape(item))
        return next(iter(candidates), None)

    def _renamed(self, item: Item) -> Item | None:
        """Returns the thing with like content under another name in the same structure."""
        home = self._home(item)
        siblings = self._free(item, self.by_home.get(home, ()) if home is not None else ())
        new = [o for o in siblings if o.word == item.word and not self._has_counterpart(o, item.home)]
        if item.kind is Kind.STRUCTURE:
            return _best(new, lambda other: self._likeness(item, other))
        key = translated(item.key, self.found)
        gone = [o for o in self._unfound(item.home) if o.word == item.word]
        equal = next((o for o in new if o.key == key), None)
        return equal or (new[0] if len(new) == len(gone) == 1 else None)

    def _free(self, item: Item, others: Iterable[Item]) -> Iterable[Item]:
        return (o for o in others if o.thing not in self.taken and o.kind is item.kind)

    def _has_counterpart(self, other: Item, home: Path) -> bool:
        """True if a thing of the later program has its name from one of the earlier."""
        return (*home, *other.thing[len(other.home) :]) in self.before.things

    def _unfound(self, home: Path) -> Iterable[Item]:
        geometry = (i for i in self.before.things.values() if i.home == home and i.kind is Kind.GEOMETRY)
        return (i for i in geometry if self._in_place(i) is None)

    def _shape(self, item: Item) -> object:
        return shape(translated(item.key, self.found))

    def _likeness(self, item: Item, other: Item) -> float:
        """Returns the common share of two structures' contents, from 0 to 1."""
        a, b = self.contents[0][item.thing], self.contents[1][other.thing]
        return (a & b).total() / max(1, (a | b).total())


def _best(items: list[Item], likeness: Callable[[Item], float]) -> Item | None:
    best = max(items[:_MOST], key=likeness, default=None)
    return best if best is not None and likeness(best) >= _ALIKE else None


def _root(inventory: Inventory) -> Item | None:
    """Returns the structure that is drawn: the last outermost one that is no template."""
    return next(
        (
            i
            for i in reversed(inventory.items)
            if i.kind is Kind.STRUCTURE and not i.home and getattr(i.node, "parameters", None) is None
        ),
        None,
    )


def _contents(inventory: Inventory) -> dict[Path, Counter[object]]:
    """Returns the content of each structure, in words that do not depend on the names in it, and these
    names.
    """
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
