"""A picture of two versions drawn over each other: what is in both, in one of them only, and what moved.

Grey is in both. What is gone is orange, hatched, with dashed outlines; what is new is blue, with solid ones:
the two can be told apart without colours.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from aidl_lang.export import marks
from aidl_lang.export.comparison.changes import Comparison, StructureChange, Version
from aidl_lang.export.marks import Area, Curves, Group, Ink, Mark, Picture, Text, corners, polygon, widened
from aidl_lang.geometry.curves import Bounds, Line, Piece, Vec, larger_side, union_bounds
from aidl_lang.geometry.drawing import Stroke
from aidl_lang.geometry.network import Network, with_finer_chords
from aidl_lang.geometry.region import Face, Region, measure
from aidl_lang.geometry.sections import filled, trace_all, union

FILLS = {"both": "#cfd4db", "before": "#fbe3c0", "after": "#6db6e8"}
INKS = {"both": "#64748b", "before": "#c2500a", "after": "#0b3c5d"}
NAMES = {"both": "in both", "before": "only before", "after": "only after"}
MARGIN, LINE, DASH, HATCH, TEXT, HEAD, SHORTEST = 0.03, 0.0025, 0.012, 0.014, 0.022, 0.022, 0.02
"""Relative to the larger side of what is drawn; `SHORTEST` is that of an arrow."""
MOST_ARROWS = 100
"""More of them would hide the drawing: then there are none."""


def overlay(comparison: Comparison) -> Picture:
    """Draws a comparison."""
    before, after = comparison.before, comparison.after
    box = _box(before, after)
    size = larger_side(box) or 1.0
    shared = _shared_strokes(comparison)
    regions = parts([b.region for b in before.drawing.bodies], [b.region for b in after.drawing.bodies])
    groups = [Group(name, tuple(_filled(name, region, size))) for name, region in regions.items()]
    for name, version in (("before", before), ("after", after)):
        groups.append(Group(f"{name}-outlines", tuple(_outlined(name, version, shared, size))))
    groups.append(Group("moves", tuple(_arrows(comparison.structures, before, size))))
    legend, below = _legend(regions, box, size)
    return Picture(widened(union_bounds([box, below]), MARGIN * size), (*groups, Group("legend", legend)))


def parts(before: Sequence[Region], after: Sequence[Region]) -> dict[str, Region]:
    """Returns the exact regions covered in both versions, only before, only after."""
    pieces = [p for region in (*before, *after) for loop in region.loops for p in loop.pieces]
    if not pieces:
        return dict.fromkeys(FILLS, Region())

    def traced(network: Network) -> list[Region]:
        sections, number = [], 0
        for region in (*before, *after):
            sections.append(filled(network, [loop.pieces for loop in region.loops], number))
            number += sum(len(loop.pieces) for loop in region.loops)
        first, last = union(sections[: len(before)]), union(sections[len(before) :])
        wanted = [first & last, first - last, last - first]
        return [outline.region for outline in trace_all(network, wanted)]

    return dict(zip(FILLS, with_finer_chords(Network(pieces), traced), strict=True))


def _box(*versions: Version) -> Bounds:
    drawings = [v.drawing for v in versions]
    boxes = [d.box for d in drawings if d.bodies or d.strokes] + [p.box for d in drawings for p in d.plans]
    return union_bounds(boxes) if boxes else (0.0, 0.0, 10.0, 10.0)


def _ink(name: str, size: float) -> Ink:
    """Returns the ink of a version; dashed lines are thinner, so that they hide behind solid ones."""
    if name == "before":
        return Ink(INKS[name], 0.8 * LINE * size, (DASH * size, 0.7 * DASH * size), is_round=True)
    return Ink(INKS[name], LINE * size, is_round=True)


def _filled(name: str, region: Region, size: float) -> Iterator[Mark]:
    for face in region.faces:
        yield Area(face, FILLS[name], None, name)
        if name == "before" and (lines := _hatch(face, HATCH * size)):
            yield Curves(tuple(lines), Ink(INKS[name], LINE * size / 2, opacity=0.7), "hatch")


def _hatch(face: Face, step: float) -> list[Piece]:
    """Returns lines at 45° inside a face, at the same places in every face."""
    turn = np.array([[1.0, 1.0], [-1.0, 1.0]]) / math.sqrt(2)
    polygons = [polygon @ turn.T for polygon in face.polygons(step / 50)]
    start = np.concatenate(polygons)
    end = np.concatenate([np.roll(polygon, -1, axis=0) for polygon in polygons])
    lines: list[Piece] = []
    for k in range(math.ceil(start[:, 1].min() / step), math.floor(start[:, 1].max() / step) + 1):
        y = k * step
        crossed = (start[:, 1] > y) != (end[:, 1] > y)
        (x0, y0), (x1, y1) = start[crossed].T, end[crossed].T
        xs = np.sort(x0 + (y - y0) / (y1 - y0) * (x1 - x0))
        ends = (np.stack((xs, np.full(len(xs), y)), axis=1) @ turn).tolist()
        lines += [Line((p[0], p[1]), (q[0], q[1])) for p, q in zip(ends[::2], ends[1::2], strict=True)]
    return lines


def _outlined(name: str, version: Version, shared: set[Stroke], size: float) -> Iterator[Mark]:
    """Yields outlines of bodies, strokes and plans; strokes that are in both are drawn in grey."""
    ink = _ink(name, size)
    for body in version.drawing.bodies:
        for face in body.region.faces:
            yield Area(face, None, ink, f"outline-{name}")
    for stroke in version.drawing.strokes:
        yield Curves(stroke.pieces, _ink("both", size) if stroke in shared else ink, stroke.role)
    for plan in version.drawing.plans:
        yield marks.Frame(plan.box, ink.color, ink.width, ink.dash[0] if ink.dash else 0.0)


def _shared_strokes(comparison: Comparison) -> set[Stroke]:
    tolerance = 1e-6 * comparison.size
    known = {(s.path, s.geometry, s.role): s for s in comparison.before.drawing.strokes}
    found: set[Stroke] = set()
    for stroke in comparison.after.drawing.strokes:
        other = known.get((stroke.path, stroke.geometry, stroke.role))
        if other is not None and _coincide(stroke.pieces, other.pieces, tolerance):
            found |= {stroke, other}
    return found


def _coincide(a: Sequence[Piece], b: Sequence[Piece], tolerance: float) -> bool:
    return len(a) == len(b) and all(
        math.dist(p.point(t), q.point(t)) <= tolerance
        for p, q in zip(a, b, strict=True)
        for t in (0.0, 0.25, 0.5, 0.75, 1.0)
    )


def _arrows(changes: Iterable[StructureChange], before: Version, size: float) -> Iterator[Mark]:
    """Yields arrows between the old and new middles of things: centroids of regions, else of boxes."""
    ways = []
    for change in changes:
        region = before.drawing.regions.get(change.was or change.path)
        at = measure(region).centroid if region else change.middle
        if (
            change.move is not None
            and at is not None
            and math.dist(at, to := change.move(at)) > SHORTEST * size
        ):
            ways.append((at, to))
    if len(ways) <= MOST_ARROWS:
        for at, to in ways:
            yield from _arrow(at, to, size)


def _arrow(at: Vec, to: Vec, size: float) -> Iterator[Mark]:
    length = math.dist(at, to)
    head = min(HEAD * size, 0.5 * length)
    x, y = (to[0] - at[0]) / length, (to[1] - at[1]) / length
    ink = Ink(INKS["after"], LINE * size, is_round=True)
    yield Curves((Line(at, (to[0] - head * x, to[1] - head * y)),), ink, "move")
    yield Area(marks.arrowhead(to, (x, y), head, 0.7 * head), ink.color, None, "move")


def _legend(regions: dict[str, Region], box: Bounds, size: float) -> tuple[tuple[Mark, ...], Bounds]:
    """Returns one line for each kind of area that occurs, below the drawing, and the box of them all."""
    marks: list[Mark] = []
    text = TEXT * size
    left, top = box[0], box[1] - 2 * text
    right = left
    for name, region in regions.items():
        if not region:
            continue
        swatch = polygon(*corners((left, top - text, left + 2 * text, top)))
        marks += _filled(name, Region((swatch,)), size)
        marks.append(Area(swatch, None, _ink(name, size)))
        label = Text(
            (left + 2.6 * text, top - 0.85 * text), f"{NAMES[name]}: {region.area:.5g} mm²", text, INKS[name]
        )
        marks.append(label)
        top -= 1.6 * text
        right = max(right, label.box[2])
    return tuple(marks), (left, top + 0.6 * text, right, box[1]) if marks else box
