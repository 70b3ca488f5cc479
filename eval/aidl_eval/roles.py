"""Binds roles to structures, else to geometry, of a program that chose its own names.

A name is taken apart at underscores, capitals and digits; indices and plurals count for nothing. What it is
called after is its last word: `front_wheel` is a wheel and `wheel_hub` a hub; `leg_left` and `lid_assembly`
are told by the word before. A template or shape that something is made by names it as well.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from itertools import chain
from typing import TypeAlias

from aidl_eval.things import Group, Origins, Part, Thing, drawn, names, outlines
from aidl_eval.whole import NEAR
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.intersect import near_pairs
from aidl_lang.geometry.network import Joined
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure

Words: TypeAlias = tuple[str, ...]
RankedThing: TypeAlias = tuple[int, Thing]
"""A thing with the rank of the word in its name."""

_PLACES = frozenset(
    re.findall(
        r"\w+",
        """left right front back rear top bottom upper lower inner outer middle center centre main large small
        big near far first second third one two l r a b c d fl fr bl br rl rr tl tr""",
    )
)
_GENERIC = frozenset(
    re.findall(
        r"\w+",
        "assembly group part piece shape outline profile unit set section component element body system",
    )
)
_LOCAL = frozenset(
    re.findall(r"\w+", "edge side corner rim tip start end glyph letter segment chord flat floor")
)
"""Names of shapes for their edges and points."""

_BETWEEN = frozenset(("of", "for", "in", "on", "at", "to"))
"""A ring of an eye is a ring."""

_MANY = 200
"""Most parts of a name that are looked at."""


@dataclass(frozen=True)
class Role:
    """`words` are its possible names, in the singular: groups of equal rank, the best first; `others` are
    names to exclude (`steering wheel`); `of` are the names of its parts, if nothing has its own. `many` if
    all found things are meant.
    """

    name: str
    words: tuple[tuple[Words, ...], ...]
    others: tuple[Words, ...] = ()
    of: tuple[Words, ...] = ()
    many: bool = False

    @staticmethod
    def read(name: str, note: str, *, many: bool) -> Role:
        """Parses `wheel, tyre / tire, rim; not steering wheel; of spoke, hub`. Raises ValueError."""
        meant, *more = note.split(";")
        groups = tuple(tuple(map(_phrase, group.split("/"))) for group in meant.split(","))
        role = Role(name, groups, many=many)
        for part in more:
            kind, _, words = part.strip().partition(" ")
            phrases = tuple(map(_phrase, re.split("[,/]", words)))
            if kind not in ("not", "of") or not all(phrases):
                raise ValueError(f"`{part.strip()}` is neither `not …` nor `of …`")
            role = replace(role, others=phrases) if kind == "not" else replace(role, of=phrases)
        return role

    def rank(self, names: Iterable[str]) -> int | None:
        """Returns the rank of the word that one of the names ends in; None for no such word."""
        tails = [tail for name in names for tail in _tails(_words(name))]
        if any(_ends(tail, other) for tail in tails for other in self.others):
            return None
        found = (k for k, group in enumerate(self.words) for w in group if any(_ends(t, w) for t in tails))
        return next(found, None)

    def key(self, name: str) -> Words | None:
        """Returns a name up to the role in it and, for one of many, its place: `front_wheel` of
        `front_wheel_rim`.
        """
        words = _words(name)
        for word in chain(*self.words):
            for k in range(len(words) - len(word) + 1):
                end = k + len(word)
                if words[k:end] == word and not any(_ends(words[:end], other) for other in self.others):
                    if not self.many:
                        return tuple(w for w in words[:end] if w not in _PLACES)
                    index = tuple(re.findall(r"\d+", name))
                    return (*words[:end], *(w for w in words[end:] if w in _PLACES), *index)
        return None


def bind(
    roles: Iterable[Role], model: SolvedModel, drawing: Drawing, made: Origins
) -> dict[str, list[Thing]]:
    """Returns the things of each role. A part does not include those of other roles: a mug's body is drawn
    with its handle inside it, and is measured without.
    """
    program = _Program(model.root, drawing, made)
    bound = {role.name: _bound(role, program) for role in roles}
    taken = {name: {path for thing in things for path in thing.paths} for name, things in bound.items()}
    solid: set[str] = set()
    for path, structure in program.structures.items():
        if structure.kind != "hole":
            solid |= {path, *(outline.shown.path for outline in program.outlines(path))}
    found: dict[str, list[Thing]] = {}
    for name, things in bound.items():
        others = {path for other, paths in taken.items() if other != name for path in paths} & solid
        found[name] = [thing.without(others) for thing in things]
    return found


def _bound(role: Role, program: _Program) -> list[Thing]:
    """Returns the things named by the words of a role, else its parts, else the root itself."""
    if things := _Search(role, program).things():
        return things if role.many else [program.joined(things)]
    if role.of and (things := _Search(replace(role, words=(role.of,), many=True), program).things()):
        return things if role.many else [_together(things)]
    named_so = not role.many and role.rank([program.root.name]) is not None
    return [_thing(program.root)] if named_so else []


def _together(things: Iterable[Thing]) -> Thing:
    things = list(things)
    return replace(things[0], groups=tuple(chain(*(thing.groups for thing in things))))


class _Program:
    """The data that all searches use."""

    def __init__(self, root: SolvedStructure, drawing: Drawing, made: Origins) -> None:
        self.root, self.drawing, self.made = root, drawing, made
        self.outlines = cache(lambda path: tuple(outlines(self.structures[path])))
        self.structures = {s.path: s for s in root.walk()}

    def joined(self, things: list[Thing]) -> Thing:
        """Joins the first thing with those of the same name that it touches, one by one: the upper and the
        lower arm of a lamp, the bands of a tower.
        """
        like = [t for t in things[:_MANY] if _alike(t.path) == _alike(things[0].path)]
        boxes = [(thing, box) for thing in like if (box := thing.bounds()) is not None]
        if not boxes or boxes[0][0] is not things[0]:
            return things[0]
        near = Joined()
        for pair in near_pairs([box for _, box in boxes], NEAR * self.drawing.size):
            near.join(*pair)
        return _together(boxes[k][0] for k in near.groups(range(len(boxes)))[0])

    def seen(self, thing: Thing, structure: SolvedStructure) -> Thing:
        """Returns the geometry of a structure, marked if it is hidden."""
        return thing.buried(self.drawing.regions.get(structure.path), self.drawing)


@dataclass(frozen=True)
class _Search:
    """Searches the parts named by the words of a role."""

    role: Role
    program: _Program

    def things(self) -> list[Thing]:
        """Returns things by the end of the name, outermost first: structures below the root, else geometry;
        else those with the word within their name; else parts of shapes.
        """
        root = self.program.root
        found = list(self._structures(root)) or list(self._geometry(root))
        if not found and (things := list(self._fragments(root))):
            return things
        found = found or list(self._shape_parts(root))
        best = min((rank for rank, _ in found), default=None)
        return [thing for rank, thing in found if rank == best]

    def _rank(self, part: Part) -> int | None:
        return self.role.rank(names(part, self.program.made))

    def _structures(self, around: SolvedStructure) -> Iterator[RankedThing]:
        for child in around.structures:
            if (rank := self._rank(child)) is None:
                yield from self._structures(child)
            else:
                yield from ((rank, thing) for thing in self._members(child))

    def _members(self, found: SolvedStructure) -> Iterator[Thing]:
        """Yields the members of a structure named in the plural, or as a group."""
        last = re.split(r"[_\d\W]+", found.name.casefold().strip("_]0123456789["))[-1]
        is_member = found.name.endswith("]")  # `drivers[0]` is one of them
        is_group = self.role.many and not is_member and (_singular(last) != last or last in _GENERIC)
        inner = [thing for _, thing in self._structures(found)] if is_group else []
        if len(inner) > 1:
            yield from inner
            return
        parts = found.structures if len(found.structures) > 1 else drawn(found)
        if is_group and not inner and len(parts) > 1:
            yield from map(_thing, parts)
        else:
            yield _thing(found)

    def _geometry(self, root: SolvedStructure) -> Iterator[RankedThing]:
        """Yields visible geometry, or hidden if there is none."""
        found: list[tuple[int, Thing, SolvedStructure]] = []
        for structure in root.walk():
            known: set[str] = set()
            for outline in self.program.outlines(structure.path):
                rank = self._rank(outline.known)
                if rank is not None and known.isdisjoint(outline.around):
                    known.add(outline.shown.path)
                    found.append((rank, _thing(outline.shown), structure))
        things = [
            (rank, self.program.seen(thing, structure) if len(found) <= _MANY else thing)
            for rank, thing, structure in found
        ]
        yield from [(rank, thing) for rank, thing in things if not thing.is_buried] or things

    def _fragments(self, root: SolvedStructure) -> Iterator[Thing]:
        """Yields parts of parts that are not drawn as one: `wheel_rim` and `wheel_hub` are a wheel."""
        children = ((s, child.name, child, None) for s in root.walk() for child in s.structures)
        shapes = (
            (s, outline.known.name, outline.shown, outline.copy_in)
            for s in root.walk()
            for outline in self.program.outlines(s.path)
        )
        for parts in (children, shapes):
            groups: dict[tuple[str, Words, str | None], Group] = {}
            for structure, name, part, copy_in in parts:
                if (key := self.role.key(name)) is not None:
                    place = structure.path, key, copy_in
                    groups[place] = (*groups.get(place, ()), part)
            if groups:
                yield from (Thing((group,)) for group in groups.values())
                return

    def _shape_parts(self, root: SolvedStructure) -> Iterator[RankedThing]:
        """Yields named edges and outlines of shapes, except those that any shape has."""
        shapes = (outline.shown for s in root.walk() for outline in self.program.outlines(s.path))
        for part in (part for shape in shapes for part in shape.walk() if part is not shape):
            is_named = not set(_words(part.name)) <= _PLACES | _GENERIC | _LOCAL
            if is_named and not part.construction and (rank := self.role.rank([part.name])) is not None:
                yield rank, replace(_thing(part), spans=True)


def _thing(part: Part) -> Thing:
    return Thing(((part,),))


# --- Words ---------------------------------------------------------------------------------------


def _words(name: str) -> Words:
    parts = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", re.sub(r"\[.*", "", name))
    return tuple(map(_singular, re.findall(r"[^\W\d_]+", parts.casefold())))


def _phrase(text: str) -> Words:
    return tuple(map(_singular, text.split()))


def _singular(word: str) -> str:
    if word.endswith("ies") and len(word) > 4:
        return word[:-3] + "y"
    if word.endswith(("ches", "shes", "xes", "sses")):
        return word[:-2]
    return word[:-1] if word.endswith("s") and not word.endswith(("ss", "us", "is")) else word


def _tails(words: Words) -> Iterator[Words]:
    """Yields the name up to an `of` in it, and the rest without words for places or for being a part."""
    words = words[: next((k for k, word in enumerate(words) if k and word in _BETWEEN), len(words))]
    yield words
    while len(words) > 1 and words[-1] in _PLACES | _GENERIC:
        yield (words := words[:-1])


def _ends(words: Words, tail: Words) -> bool:
    return bool(tail) and words[-len(tail) :] == tail


def _alike(path: str) -> tuple[Words, ...]:
    return tuple(tuple(w for w in _words(name) if w not in _PLACES) for name in path.split("."))
