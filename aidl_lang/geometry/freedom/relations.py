"""The things against which a thing moves: those that constraints relate it to, and those beside it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from aidl_lang.building.model import Constraint, Model
from aidl_lang.building.wording import Wording
from aidl_lang.geometry.freedom.scene import WHOLE, Ints, Scene

_INDEX = re.compile(r"\[\d+\]")


class Relations:
    """The relations between the things of a model, as `scene` shows it."""

    def __init__(self, model: Model, scene: Scene) -> None:
        self.scene = scene
        stated = sorted((c for c in model.constraints if not c.is_inherent), key=lambda c: c.span.start)
        self.related = [found for c in stated if len(found := _related(c)) > 1]
        self.beside = {
            child.path: [other.path for other in s.children if other.kind not in ("hole", "drawing")]
            for s in model.root.walk()
            for child in s.children
        }

    def against(self, things: Sequence[str], moving: Ints) -> str:
        """Returns the path of the thing that is related to things and does not go along when these
        observables move, be it free itself or held: that of the first such constraint, in another array if
        there is one; for structures without such, the part beside them. "" if there is none.
        """
        flags = np.zeros(len(self.scene.places), dtype=np.bool_)
        flags[moving] = True
        known = self.scene.known
        beside = ((path, known[path]) for path in self._neighbours(things) if path in known)
        found = dict.fromkeys(path for path, thing in beside if not flags[self.scene.own(thing)].any())
        own = {pattern(thing) for thing in things}
        for path in found:
            if pattern(path) not in own:
                return path
        return next(iter(found), "")

    def _neighbours(self, things: Sequence[str]) -> Iterator[str]:
        for paths in self.related:
            inside = [path for path in paths if any(_is_in(path, thing) for thing in things)]
            for path in paths if inside else ():
                if not any(_is_in(path, thing) or _is_in(thing, path) for thing in things):
                    yield _beside(path, inside[0])
        if all((thing := self.scene.known.get(path)) is not None and thing.rank == WHOLE for path in things):
            yield from (path for path in self.beside.get(things[0], ()) if path not in things)


def _related(constraint: Constraint) -> tuple[str, ...]:
    """Returns the paths of the things that a constraint relates: structures by their boxes, else the holders
    of its unknowns; if these are all one thing, also the other things that it names, which have no unknowns.
    """
    boxes = {s.path for c in constraint.comparisons for s in c.boxes}
    mentioned = {u.holder.path for c in constraint.comparisons for u in c.spoken_of}
    # A frame is mentioned beside what lies in it.
    others = {
        path
        for path in mentioned
        if not any(_is_in(other, path) for other in mentioned | boxes if other != path)
    }
    found = boxes | others
    if len(found) < 2 and isinstance(constraint.wording, Wording):
        found |= {thing.path for thing in constraint.wording.named()}
    return tuple(sorted(found))


def _is_in(path: str, around: str) -> bool:
    return f"{path}.".startswith(f"{around}.")


def _beside(path: str, other: str) -> str:
    """Returns the holder of a path that stands beside the holder of the other: both lie in the same."""
    ends, others = path.split("."), other.split(".")
    common = next((i for i, (a, b) in enumerate(zip(ends, others, strict=False)) if a != b), len(ends))
    return ".".join(ends[: common + 1])


def pattern(path: str) -> str:
    """Returns a path without its indices: the members of an array have the same."""
    return _INDEX.sub("[]", path)
