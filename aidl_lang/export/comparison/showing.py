"""A comparison as text, one block for each structure, and as a picture of both versions over each other."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import groupby
from typing import TypeVar

import numpy as np

from aidl_lang.common.prose import first_few
from aidl_lang.common.render import escape
from aidl_lang.export import marks
from aidl_lang.export.comparison.changes import (
    Comparison,
    ContactChange,
    Fields,
    GeometryChange,
    Move,
    Sort,
    StructureChange,
    Value,
    Version,
)
from aidl_lang.export.marks import Area, Curves, Group, Ink, Mark, Picture, Text, corners, polygon, widened
from aidl_lang.geometry.boolean import Contact, combined
from aidl_lang.geometry.curves import Bounds, Line, Piece, Vec, larger_side, union_bounds
from aidl_lang.geometry.drawing import Stroke
from aidl_lang.geometry.region import Face, Region, measure
from aidl_lang.geometry.sections import Section, union

# --- As text.

EQUAL = "no difference"
_T = TypeVar("_T", StructureChange, GeometryChange)
_MARKS: dict[Sort, str] = {"changed": " ", "appeared": "+", "vanished": "-"}
_WIDEST = 32
"""Columns that paths get at most."""
_MOST_CONTACTS = 12
_MOST = 6
"""Most fields of one geometry, and most names of a list, that are reported."""
_DIGITS = (5, 7, 9, 12)
_ROUNDING, _NOTHING, _HARDLY = 1e-7, 1e-9, 1e-6
"""Values shown as 0: of points relative to the larger coordinate, of shifts relative to the drawing."""
_MAIN_SIZES = ("width", "height", "area")
_MEMBER = re.compile(r"(.*)\[(-?\d+)\]")


def text(comparison: Comparison) -> str:
    """Returns the whole comparison as text, without a line break at its end."""
    if comparison.is_equal:
        return EQUAL
    root = comparison.after.model.root.path
    told = _gathered(comparison.structures, lambda s: s.path, lambda s: _structure(s, comparison.size))
    blocks = [(_MARKS[sort], path, lines) for sort, path, lines in told]
    contacts = list(_contacts(comparison.contacts, root))
    others = [("contacts", contacts), ("free to move", list(_freedom(comparison, root)))]
    if comparison.status[0] != comparison.status[1]:
        others.append(("status", ["{} → {}".format(*comparison.status)]))
    blocks += [(" ", name, lines) for name, lines in others if lines]
    width = min(max(len(path) for _, path, _ in blocks), _WIDEST)
    return escape("\n".join(line for block in blocks for line in _laid_out(*block, width)))


def _laid_out(mark: str, path: str, lines: Sequence[str], width: int) -> Iterator[str]:
    for i, line in enumerate(lines):
        beginning = f"{mark} {path:<{width}}" if i == 0 else " " * (width + 2)
        yield f"{beginning}  {line}"


def _gathered(
    changes: Iterable[_T], name: Callable[[_T], str], lines: Callable[[_T], list[str]]
) -> Iterator[tuple[Sort, str, list[str]]]:
    """Yields each change with its lines; members of an array with the same lines as one."""
    told = [(c, name(c), lines(c)) for c in changes]

    def alike(entry: tuple[_T, str, list[str]]) -> object:
        change, path, lines = entry
        member = _MEMBER.fullmatch(path)
        if member is None:
            return path
        return change.sort, member[1], "moved" if _is_shift(change) else lines

    for _, group in groupby(told, alike):
        same = list(group)
        change, first, words = same[0]
        if len(same) > 1:
            array, numbers = first.rpartition("[")[0], [path.rpartition("[")[2][:-1] for _, path, _ in same]
            first = f"{array}[{_ranges(list(map(int, numbers)))}]"
            if words != same[-1][2]:
                words = [f"{words[0]} … {same[-1][2][0].removeprefix('moved by ')}"]
        yield change.sort, first, words


def _ranges(numbers: list[int]) -> str:
    """Returns `0..3, 7` for 0, 1, 2, 3, 7."""
    by_offset = groupby(enumerate(numbers), key=lambda pair: pair[1] - pair[0])
    runs = [[number for _, number in run] for _, run in by_offset]
    return ", ".join(str(r[0]) if len(r) == 1 else f"{r[0]}..{r[-1]}" for r in runs)


def _is_shift(change: StructureChange | GeometryChange) -> bool:
    move = change.move
    if move is None or move.turn or move.mirrored or change.was:
        return False
    if isinstance(change, GeometryChange):
        return not change.fields
    return not (change.sizes or change.params or change.settings or change.geometry)


# --- Structures ------------------------------------------------------------------------------------


def _structure(s: StructureChange, size: float) -> list[str]:
    if s.sort != "changed":
        return [f"{s.sort}: {s.kind}{_dimensions(s.sizes, 1 if s.sort == 'appeared' else 0)}"]
    lines = []
    if s.was:
        lines.append(f"was {s.was}, in the same shape")
    if s.move:
        lines.append(_move(s.move, s.middle, size))
    if s.sizes:
        lines.append(_sizes(s.sizes))
    if s.params:
        lines.append(f"params: {_fields(s.params)}")
    lines += [_setting(*field) for field in s.settings.items()]
    for sort, name, words in _gathered(s.geometry, lambda g: g.name, lambda g: [_geometry(g, s, size)]):
        lines.append(f"{name}{':' if sort == 'changed' else ''} {words[0]}")
    return lines


def _dimensions(sizes: Fields, side: int) -> str:
    values = {name: pair[side] for name, pair in sizes.items()}
    said = f", {_value(values['width'])} × {_value(values['height'])}" if "width" in values else ""
    return said + (f", area {_value(values['area'])} mm²" if "area" in values else "")


def _sizes(sizes: Fields) -> str:
    """Returns width, height and area; perimeter and centroid if only they differ."""
    words = []
    main = {name: pair for name, pair in sizes.items() if name in _MAIN_SIZES}
    for name, (a, b) in (main or sizes).items():
        if isinstance(a, float) and isinstance(b, float):
            sign, by = "+" if b > a else "−", abs(b - a)
            more = f" ({sign}{_number(by)})" if name in ("width", "height") else ""
            if name == "area":
                more = f" mm² ({sign}{100 * by / abs(a):.3g} %)" if a else " mm²"
            words.append(f"{name} {_pair(a, b)}{more}")
        else:
            words.append(_field(name, a, b))
    return f"{_verdict(sizes)}: {', '.join(words)}"


def _verdict(sizes: Fields) -> str:
    signs = {
        b > a
        for name, (a, b) in sizes.items()
        if name in _MAIN_SIZES and isinstance(a, float) and isinstance(b, float)
    }
    return "grew" if signs == {True} else "shrank" if signs == {False} else "changed"


def _setting(name: str, pair: tuple[Value, Value]) -> str:
    a, b = pair
    if name == "kind":
        return f"a {b} now, was a {a}"
    if b is None:
        return f"no {name} any more" if a is True else f"no {name} any more, was {_value(a)}"
    if a is None:
        return f"{name} added" if b is True else f"{name} added: {_value(b)}"
    return f"{name} {_pair(a, b)}"


# --- Geometry --------------------------------------------------------------------------------------


def _geometry(g: GeometryChange, around: StructureChange, size: float) -> str:
    if g.sort != "changed":
        return f"{g.sort}: {g.type}"
    words = [f"was {g.was}, in the same shape"] if g.was else []
    if g.move:
        words.append(_move(g.move, around.middle, size))
    if g.fields:
        words.append(_fields(g.fields))
    elif g.is_outline_changed:
        words.append("outline changed")
    return ", ".join(words) or "stayed"


def _fields(fields: Fields) -> str:
    words = [_field(name, a, b) for name, (a, b) in fields.items()]
    more = len(words) - _MOST
    return ", ".join(words if more <= 1 else [*words[:_MOST], f"and {more} more"])


def _field(name: str, a: Value, b: Value) -> str:
    if a is None:
        return f"{name} {_value(b)} (new)"
    return f"{name} {_value(a)} (gone)" if b is None else f"{name} {_pair(a, b)}"


# --- Motions ---------------------------------------------------------------------------------------


def _move(move: Move, middle: Vec | None, size: float) -> str:
    """Describes a motion: a turn about a point nearby by that alone, else with the shift of the middle."""
    at = middle or (0.0, 0.0)
    to = move(at)
    steps = (to[0] - at[0], to[1] - at[1])
    shift = _value(tuple(0.0 if abs(step) <= _HARDLY * size else step for step in steps))
    if move.mirrored:
        line = (move.turn / 2 + 90) % 180
        return f"mirrored about a line at {_number(line)}°, its middle moved by {shift}"
    if not move.turn:
        return "stayed" if not (move.dx or move.dy) else f"moved by {shift}"
    about = move.fixed_point
    if max(abs(about[0] - at[0]), abs(about[1] - at[1])) > size:
        return f"turned by {_number(move.turn)}°, its middle moved by {shift}"
    return f"turned by {_number(move.turn)}° about {_value(about)}"


# --- The whole -------------------------------------------------------------------------------------


def _contacts(changes: Sequence[ContactChange], root: str) -> Iterator[str]:
    """Yields lines on contacts, new kinds first; changed gaps only as far as there is room."""
    kinds = {id(c): len({lie.relation if lie else "apart" for lie in (c.before, c.after)}) for c in changes}
    ranked = sorted(changes, key=lambda c: -kinds[id(c)])
    most = max(_MOST_CONTACTS, sum(kind > 1 for kind in kinds.values()))
    for change in ranked[:most]:
        a, b = (path.removeprefix(f"{root}.") for path in (change.a, change.b))
        yield f"{a} and {b}: {_lie(change.before)} → {_lie(change.after)}"
    if len(ranked) > most:
        yield f"and {len(ranked) - most} more gaps"


def _lie(contact: Contact | None) -> str:
    if contact is None:
        return "far apart"
    if contact.gap is not None and contact.relation == "apart":
        return f"{_number(contact.gap)} apart"
    return f"overlapping by {_number(contact.area)} mm²" if contact.area is not None else contact.relation


def _freedom(comparison: Comparison, root: str) -> Iterator[str]:
    a, b = comparison.degrees
    if a != b:
        yield f"{_value(a)} → {_value(b)} degrees of freedom"
    for name, paths in (("now", comparison.freed), ("no longer", comparison.held)):
        short = [path.removeprefix(f"{root}.") for path in paths]
        if short:
            yield f"{name}: {first_few(short, _MOST, ', and {} more')}"


# --- Numbers ---------------------------------------------------------------------------------------


def _pair(a: Value, b: Value) -> str:
    shown = [(_value(a, digits), _value(b, digits)) for digits in _DIGITS]
    return " → ".join(next((p for p in shown if p[0] != p[1]), shown[-1]))


def _value(value: Value, digits: int = _DIGITS[0]) -> str:
    if isinstance(value, tuple):
        numbers = [abs(v) for v in value if isinstance(v, float)]
        rounding = _ROUNDING * max(numbers, default=0.0)
        shown = (0.0 if isinstance(v, float) and abs(v) <= rounding else v for v in value)
        return f"({', '.join(_value(v, digits) for v in shown)})"
    if value is None:
        return "none"
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else _number(value, digits)


def _number(value: float, digits: int = _DIGITS[0]) -> str:
    return "0" if abs(value) < _NOTHING else f"{float(f'{value:.{digits}g}'):.12g}"


# --- A picture of two versions drawn over each other: what is in both, in one of them only, and what moved.
#
# Grey is in both. What is gone is orange, hatched, with dashed outlines; what is new is blue, with solid
# ones: the two can be told apart without colours.

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

    def areas(*sections: Section) -> Sequence[Section]:
        first, last = union(sections[: len(before)]), union(sections[len(before) :])
        return first & last, first - last, last - first

    return dict(zip(FILLS, combined([*before, *after], areas), strict=True))


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
    high = TEXT * size
    left, top = box[0], box[1] - 2 * high
    right = left
    for name, region in regions.items():
        if not region:
            continue
        swatch = polygon(*corners((left, top - high, left + 2 * high, top)))
        marks += _filled(name, Region((swatch,)), size)
        marks.append(Area(swatch, None, _ink(name, size)))
        label = Text(
            (left + 2.6 * high, top - 0.85 * high), f"{NAMES[name]}: {region.area:.5g} mm²", high, INKS[name]
        )
        marks.append(label)
        top -= 1.6 * high
        right = max(right, label.box[2])
    return tuple(marks), (left, top + 0.6 * high, right, box[1]) if marks else box
