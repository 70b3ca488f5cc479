"""The motions that are left, in words: those of the solver, taken apart into simple ones.

The solver tells for each part of the model which velocities are possible for what is drawn. Here simple
velocities are tried in turn (`telling`): of points, geometry, structures and of all that keeps together in
every motion, the smallest first, a slide along an axis or another direction, and a turn; then changes of
single parameters, then growth. Each that is possible and new is told; what is left over is told as things
that move together. That the whole drawing can move as one is known beforehand, so nothing is told of it.
`bending` follows each a little further, `relations` finds against what a thing moves, `wording` makes the
report.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

from aidl_lang.building.expression import quoted
from aidl_lang.common.prose import counted, listed
from aidl_lang.common.records import record
from aidl_lang.geometry.freedom.scene import pattern
from aidl_lang.geometry.freedom.telling import motions
from aidl_lang.geometry.solved import Motion, SolvedModel

__all__ = ["motions", "report"]


# --- The report on what can still move: a line for each group of things that moves against the rest.

_NAMED = 3
"""The most things named in one line."""
_RUN = 3
"""Number of members of an array from which on the first and the last stand for all."""


@record()
class _Line:
    """The motions of things, each of them (`groups` of one thing or more) by itself."""

    groups: tuple[tuple[str, ...], ...]
    words: str
    kinds: frozenset[str]
    against: str


def report(model: SolvedModel, most: int | None = None) -> list[str]:
    """Returns sentences on what can still move against the rest, the most interesting first: "`receiver` can
    slide along x against `base`". Of more than `most` lines, those are left out whose kind of motion is among
    the lines before them. Counts the lines left out, and degrees of freedom beyond the motions listed.
    """
    lines = list(_lines(model.motions))
    shown = lines if most is None or len(lines) <= most else list(_chosen(lines, most))
    told = [_sentence(line, model.root.path) for line in shown]
    if left := len(lines) - len(shown):
        told.append(f"… and {left} more like {'this' if len(shown) == 1 else 'these'}")
    if (untold := (model.degrees or 0) - len(model.ways)) > 0:
        told.append(f"… and {counted(untold, 'more degree')} of freedom, not told apart")
    return told


def _chosen(lines: Sequence[_Line], most: int) -> Iterator[_Line]:
    """Yields the first of each kind, and as many others as there is room for; in their order."""
    kinds: dict[frozenset[str], _Line] = {}
    for line in lines:
        kinds.setdefault(line.kinds, line)
    room = most - 1 - len(kinds)
    for line in lines:
        if kinds[line.kinds] is line:
            yield line
        elif room > 0:
            room -= 1
            yield line


def _lines(motions: Iterable[Motion]) -> Iterator[_Line]:
    """Yields one line for all motions of the same things; alike members of an array share one."""
    told: dict[tuple[str, ...], list[Motion]] = {}
    for motion in motions:
        told.setdefault(motion.things, []).append(motion)
    alike: dict[object, list[_Line]] = {}
    for things, ways in told.items():
        against = next((way.against for way in ways if way.against), "")
        line = _Line((things,), _words(ways), frozenset(way.kind for way in ways), against)
        alike.setdefault((tuple(map(pattern, things)), line.words), []).append(line)
    for members in alike.values():
        first = members[0]
        same = first.against if all(line.against == first.against for line in members) else ""
        yield _Line(tuple(line.groups[0] for line in members), first.words, first.kinds, same)


def _words(ways: Sequence[Motion]) -> str:
    slides = [way.words.removeprefix("slide along ") for way in ways if way.kind == "slide"]
    others = [way.words for way in ways if way.kind != "slide"]
    repeated = [
        f"{words} in {count} ways" if (count := others.count(words)) > 1 else words
        for words in dict.fromkeys(others)
    ]
    slides.sort(key=lambda way: (way.startswith("a curve"), way))
    return listed([f"slide along {listed(slides)}"] * bool(slides) + repeated)


def _sentence(line: _Line, root: str) -> str:
    things = list(dict.fromkeys(thing for group in line.groups for thing in group))
    each = " each" if len(line.groups) > 1 else ""
    together = " together" if not each and len(things) > 1 and not line.words.endswith("together") else ""
    against = f" against {_name(line.against, root)}" if line.against and not line.kinds <= _ALONE else ""
    return f"{_named(things, root)} can{each}{together} {line.words}{against}"


_ALONE = frozenset({"grow", "change", "together"})
"""Motions that are told without a word on what is around."""


def _named(paths: Sequence[str], root: str) -> str:
    names: list[str] = []
    rest = len(paths)
    for run in _runs(paths):
        if len(names) == _NAMED and rest > len(run):
            break
        if len(run) >= _RUN:
            names.append(f"{_name(run[0], root)} … {_name(run[-1], root)}")
        else:
            names += [_name(path, root) for path in run]
        rest -= len(run)
    return listed([*names, f"{rest} more"] if rest else names)


def _runs(paths: Sequence[str]) -> Iterator[list[str]]:
    """Yields members of one array that stand side by side, and all other things by themselves."""
    for key, run in groupby(paths, key=lambda path: pattern(path) if "[" in path else path):
        found = list(run)
        if key in found or len(found) < _RUN:
            yield from ([path] for path in found)
        else:
            yield found


def _name(path: str, root: str) -> str:
    return quoted(path.removeprefix(f"{root}."))
