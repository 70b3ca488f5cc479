"""What a word means in a program that chose its own names: roles bound to structures, else to geometry.

A name is taken apart at underscores, capitals and digits; indices and plurals count for nothing. What it is
called after is its last word: `front_wheel` is a wheel and `wheel_hub` a hub; `leg_left` and `lid_assembly`
are told by the word before. A template or shape that something is made by names it as well.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, replace
from typing import TypeAlias

from aidl_lang import ast
from aidl_lang.geometry.drawing import Drawing, draw
from aidl_lang.geometry.evaluate import Bounds, bounds
from aidl_lang.geometry.measures import region_bounds
from aidl_lang.geometry.network import union_bounds
from aidl_lang.geometry.region import Region
from aidl_lang.solved import Box, Frame, SolvedGeometry, SolvedModel, SolvedStructure
from aidl_lang.source import Span

Words: TypeAlias = tuple[str, ...]
Place: TypeAlias = tuple[str, int, int]
Origins: TypeAlias = Mapping[Place, tuple[str, ...]]
"""The names that a value was made by, by its place in the program."""

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


@dataclass(frozen=True)
class Role:
    """`words` are what it may be called, in the singular: groups of words that count alike, the best first;
    `others` what is called so and is not meant (`steering wheel`). `many` when all that are found are meant.
    """

    name: str
    words: tuple[tuple[Words, ...], ...]
    others: tuple[Words, ...] = ()
    many: bool = False

    @staticmethod
    def read(name: str, note: str, *, many: bool) -> Role:
        """From `wheel, tyre / tire, rim; not steering wheel`."""
        meant, _, others = note.partition("; not ")
        groups = (tuple(map(_phrase, group.split("/"))) for group in meant.split(","))
        return Role(name, tuple(groups), tuple(map(_phrase, others.split(","))), many)

    def rank(self, names: Iterable[str]) -> int | None:
        """Which of its words one of the names ends in; None when none does."""
        tails = [tail for name in names for tail in _tails(_words(name))]
        if any(_ends(tail, other) for tail in tails for other in self.others):
            return None
        found = (k for k, group in enumerate(self.words) for w in group if any(_ends(t, w) for t in tails))
        return next(found, None)

    def key(self, name: str) -> Words | None:
        """A name up to the role in it and where that is: `front_wheel` of `front_wheel_rim`."""
        words = _words(name)
        for word in (word for group in self.words for word in group):
            for k in range(len(words) - len(word) + 1):
                end = k + len(word)
                if words[k:end] == word and not any(_ends(words[:end], other) for other in self.others):
                    index = tuple(re.findall(r"\d+", name))
                    return (*words[:end], *(w for w in words[end:] if w in _PLACES), *index)
        return None


@dataclass(frozen=True)
class Thing:
    """What a role is bound to: structures or geometry that together are one part."""

    path: str
    of: tuple[SolvedStructure | SolvedGeometry, ...]

    def region(self, drawing: Drawing) -> Region:
        """What it covers in the drawing; empty for what is only strokes."""
        match self.of:
            case (SolvedStructure(path=path),) if path in drawing.regions:
                return drawing.regions[path]
        geometry = tuple(part for part in self.of if isinstance(part, SolvedGeometry))
        solids = tuple(part for part in self.of if isinstance(part, SolvedStructure))
        nowhere = Frame(0.0, 0.0, 0.0)
        alone = SolvedStructure(
            "it", "it", "solid", "top", nowhere, {}, {}, geometry, solids, None, False, 0, None
        )
        return draw(SolvedModel("solved", alone, (), 0, (), ()))[0].regions.get("it", Region())

    def box(self, region: Callable[[], Region]) -> Box | None:
        """Of its curves; of its region where it has none before that is worked out."""
        boxes = [box for part in self.of for box in _boxes(part)]
        if not boxes and (found := region()):
            boxes = [region_bounds(found)]
        return Box(*union_bounds(boxes)) if boxes else None

    def without(self, others: Set[str]) -> Thing:
        """Itself less the structures at these paths inside it, where something else is left."""
        kept = tuple(left for part in self.of for left in _less(part, others))
        return replace(self, of=kept) if kept else self


def _boxes(part: SolvedStructure | SolvedGeometry) -> Iterator[Bounds]:
    if isinstance(part, SolvedGeometry):
        yield from map(bounds, part.curves())
    elif (box := part.box) is not None:
        yield box.left, box.bottom, box.right, box.top


def _less(
    part: SolvedStructure | SolvedGeometry, others: Set[str]
) -> Iterator[SolvedStructure | SolvedGeometry]:
    if isinstance(part, SolvedGeometry) or not any(s is not part and s.path in others for s in part.walk()):
        yield part
        return
    yield from part.drawn
    for child in part.structures:
        if child.path not in others:
            yield from _less(child, others)


def origins(module: ast.Module) -> Origins:
    """The template or shape that each value was made by, and what it was copied from."""
    return {
        _place(node.span): tuple(_makers(node.value))
        for node in ast.walk(module)
        if isinstance(node, ast.Assign)
    }


def _place(span: Span) -> Place:
    return span.source.name, span.start, span.end


def _makers(value: ast.Node | None) -> Iterator[str]:
    while isinstance(value, ast.Call):
        yield value.callee.text
        value = next((a.value for a in value.arguments if a.name is None), None)
    if isinstance(value, ast.Name):
        yield value.text


def bind(roles: Iterable[Role], root: SolvedStructure, made: Origins) -> dict[str, list[Thing]]:
    """What each role means. A part does not include what other roles mean: a mug's body is drawn with its
    handle inside it, and is measured without.
    """
    bound = {role.name: _bound(role, root, made) for role in roles}
    taken = {name: {thing.path for thing in things} for name, things in bound.items()}
    solid = {s.path for s in root.walk() if s.kind != "hole"}
    found: dict[str, list[Thing]] = {}
    for name, things in bound.items():
        others = {path for other, paths in taken.items() if other != name for path in paths} & solid
        found[name] = [thing.without(others) for thing in things]
    return found


def _bound(role: Role, root: SolvedStructure, made: Origins) -> list[Thing]:
    """The parts that a role means, outermost first: structures below the root, else geometry, else what has
    the word within its name, else the root itself.
    """
    search = _Search(role, made)
    found = list(search.structures(root)) or list(search.geometry(root))
    if found:
        best = min(rank for rank, _ in found)
        things = [thing for rank, thing in found if rank == best]
    else:
        things = list(search.fragments(root))
    if not things and not role.many and role.rank([root.name]) is not None:
        things = [_thing(root)]
    return things if role.many else things[:1]


@dataclass(frozen=True)
class _Search:
    role: Role
    made: Origins

    def _names(self, of: SolvedStructure | SolvedGeometry) -> tuple[str, ...]:
        return (of.name, *(self.made.get(_place(of.span), ()) if of.span is not None else ()))

    def structures(self, around: SolvedStructure) -> Iterator[tuple[int, Thing]]:
        for child in around.structures:
            if (rank := self.role.rank(self._names(child))) is None:
                yield from self.structures(child)
            else:
                yield from ((rank, thing) for thing in self._members(child))

    def _members(self, found: SolvedStructure) -> Iterator[Thing]:
        """What is named in the plural, or as a group, stands for what is in it."""
        last = re.split(r"[_\d\W]+", found.name.casefold().strip("_]0123456789["))[-1]
        is_group = self.role.many and (_singular(last) != last or last in _GENERIC)
        inner = [thing for _, thing in self.structures(found)] if is_group else []
        if len(inner) > 1:
            yield from inner
            return
        parts = found.structures if len(found.structures) > 1 else _drawn(found)
        if is_group and not inner and len(parts) > 1:
            yield from map(_thing, parts)
        else:
            yield _thing(found)

    def geometry(self, root: SolvedStructure) -> Iterator[tuple[int, Thing]]:
        for structure in root.walk():
            for geometry in _drawn(structure):
                if (rank := self.role.rank(self._names(geometry))) is not None:
                    yield rank, _thing(geometry)

    def fragments(self, root: SolvedStructure) -> Iterator[Thing]:
        """Parts of parts that are not drawn as one: `wheel_rim` and `wheel_hub` are a wheel."""
        for parts_of in (lambda s: s.structures, _drawn):
            groups: dict[tuple[str, Words], Thing] = {}
            for structure in root.walk():
                for part in parts_of(structure):
                    if (key := self.role.key(part.name)) is not None:
                        known = groups.get((structure.path, key), Thing(part.path, ()))
                        groups[structure.path, key] = replace(known, of=(*known.of, part))
            if groups:
                yield from groups.values()
                return


def _thing(part: SolvedStructure | SolvedGeometry) -> Thing:
    return Thing(part.path, (part,))


def _drawn(structure: SolvedStructure) -> tuple[SolvedGeometry, ...]:
    return tuple(g for g in structure.drawn if not g.construction and g.type != "point")


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
    """The name, and what is left of it without the words that say where or that it is a part."""
    yield words
    while len(words) > 1 and words[-1] in _PLACES | _GENERIC:
        yield (words := words[:-1])


def _ends(words: Words, tail: Words) -> bool:
    return bool(tail) and words[-len(tail) :] == tail
