"""What a word means in a program that chose its own names: roles bound to structures, else to geometry.

A name is taken apart at underscores, capitals and digits; indices and plurals count for nothing. What it is
called after is its last word: `front_wheel` is a wheel and `wheel_hub` a hub; `leg_left` and `lid_assembly`
are told by the word before. A template or shape that something is made by names it as well.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cache
from itertools import chain
from typing import TypeAlias

from aidl_lang.common.records import record
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.nearness import near_pairs
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from aidl_lang.tools.evaluation.things import Group, Origins, Part, Thing, drawn, names, outlines
from aidl_lang.tools.evaluation.whole import NEAR

Words: TypeAlias = tuple[str, ...]
RankedThing: TypeAlias = tuple[int, Thing]
"""A thing, and which of the words it is called by."""

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
"""What shapes call their edges and points."""

_BETWEEN = frozenset(("of", "for", "in", "on", "at", "to"))
"""A ring of an eye is a ring."""

_MANY = 200
"""How many of a name are looked at."""


@record()
class Role:
    """`words` are what it may be called, in the singular: groups of words that count alike, the best first;
    `others` what is called so and is not meant (`steering wheel`); `of` what it is made of where nothing is
    called by its words. `many` when all that are found are meant.
    """

    name: str
    words: tuple[tuple[Words, ...], ...]
    others: tuple[Words, ...] = ()
    of: tuple[Words, ...] = ()
    many: bool = False

    @staticmethod
    def read(name: str, note: str, *, many: bool) -> Role:
        """From `wheel, tyre / tire, rim; not steering wheel; of spoke, hub`. Raises ValueError."""
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
        """Which of its words one of the names ends in; None when none does."""
        tails = [tail for name in names for tail in _tails(_words(name))]
        if any(_ends(tail, other) for tail in tails for other in self.others):
            return None
        found = (k for k, group in enumerate(self.words) for w in group if any(_ends(t, w) for t in tails))
        return next(found, None)

    def key(self, name: str) -> Words | None:
        """A name up to the role in it and, for one of many, where that is: `front_wheel` of
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
    """What each role means. A part does not include what other roles mean: a mug's body is drawn with its
    handle inside it, and is measured without.
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
    """What is called by the words of a role, else what it is made of, else the root itself."""
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
    """What all searches look at."""

    def __init__(self, root: SolvedStructure, drawing: Drawing, made: Origins) -> None:
        self.root, self.drawing, self.made = root, drawing, made
        self.outlines = cache(lambda path: tuple(outlines(self.structures[path])))
        self.structures = {s.path: s for s in root.walk()}

    def joined(self, things: list[Thing]) -> Thing:
        """The first, with those of the same name that it holds together with, one by one: the upper and the
        lower arm of a lamp, the bands of a tower.
        """
        like = [t for t in things[:_MANY] if _alike(t.path) == _alike(things[0].path)]
        boxes = [(thing, box) for thing in like if (box := thing.bounds()) is not None]
        if not boxes or boxes[0][0] is not things[0]:
            return things[0]
        pairs = list(near_pairs([box for _, box in boxes], NEAR * self.drawing.size))
        near, before = {0}, 0
        while len(near) > before:
            before = len(near)
            near |= {k for pair in pairs if near & set(pair) for k in pair}
        return _together(boxes[k][0] for k in sorted(near))

    def seen(self, thing: Thing, structure: SolvedStructure) -> Thing:
        """Geometry of a structure, with whether it is to be seen."""
        return thing.buried(self.drawing.regions.get(structure.path), self.drawing)


@record()
class _Search:
    """The parts that are called by the words of a role."""

    role: Role
    program: _Program

    def things(self) -> list[Thing]:
        """By the end of the name, outermost first: structures below the root, else geometry; else what has
        the word within its name; else parts of shapes.
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
        """What is named in the plural, or as a group, stands for what is in it."""
        last = re.split(r"[_\d\W]+", found.name.casefold().strip("_]0123456789["))[-1]
        is_group = self.role.many and (_singular(last) != last or last in _GENERIC)
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
        """What is to be seen, if anything is."""
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
        """Parts of parts that are not drawn as one: `wheel_rim` and `wheel_hub` are a wheel."""
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
        """Edges and outlines that shapes have names for, but for those of any shape."""
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
    """The name up to an `of` in it, and what is left of that without the words that say where or that it is
    a part.
    """
    words = words[: next((k for k, word in enumerate(words) if k and word in _BETWEEN), len(words))]
    yield words
    while len(words) > 1 and words[-1] in _PLACES | _GENERIC:
        yield (words := words[:-1])


def _ends(words: Words, tail: Words) -> bool:
    return bool(tail) and words[-len(tail) :] == tail


def _alike(path: str) -> tuple[Words, ...]:
    """A path without indices and places."""
    return tuple(tuple(w for w in _words(name) if w not in _PLACES) for name in path.split("."))
