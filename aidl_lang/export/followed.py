"""What a cutter follows, as marks of a picture: outlines and engraved areas in the order of a profile."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from aidl_lang.export.cuts import Outline, outlines
from aidl_lang.export.marks import Area, Curves, Group, Ink, Mark
from aidl_lang.export.profiles import CUTS, FILL, Profile
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.region import Face, Loop
from aidl_lang.geometry.solved import SolvedModel


def followed_groups(model: SolvedModel, drawing: Drawing, profile: Profile) -> Iterator[Group]:
    """Yields a group for each run of outlines with one operation and one structure."""
    kinds = {s.path: s.kind for s in model.root.walk()}
    found = [outline for outline in outlines(model, drawing, profile) if outline.operation]
    used: dict[str, int] = {}
    for (path, operation, layer), run in groupby(
        found, key=lambda o: (o.path, o.operation, _layer(o, profile))
    ):
        name = f"{path}:{operation}"
        used[name] = count = used.get(name, 0) + 1
        attributes = {"data-kind": kinds[path], "data-path": path, "data-operation": operation}
        if layer is not None:
            attributes["data-layer"] = layer
        yield Group(name if count == 1 else f"{name}-{count}", tuple(_marks(list(run), profile)), attributes)


def _layer(outline: Outline, profile: Profile) -> str | None:
    """Returns the layer of an outline, where the profile or the program says one."""
    return profile.look(outline.style.layer, outline.operation).layer or outline.style.layer


def _marks(run: Sequence[Outline], profile: Profile) -> Iterator[Mark]:
    for area, bounding in groupby(run, key=lambda o: o.area):
        if area:
            first, *others = bounding
            loops = tuple(_loop(outline) for outline in others)
            yield Area(Face(_loop(first), loops), profile.color(first), None, FILL)
            continue
        for outline in bounding:
            width = profile.look(outline.style.layer, outline.operation).width
            ink = Ink(profile.color(outline), width)
            role = "cut" if outline.operation in CUTS else outline.operation
            if outline.closed:
                yield Area(Face(_loop(outline)), None, ink, role)
            else:
                yield Curves(outline.pieces, ink, role)


def _loop(outline: Outline) -> Loop:
    return Loop(outline.pieces, outline.clockwise)
