"""Drawing sheets: parts on paper to a standard scale, with dimensions, a frame and a title block."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, groupby

from aidl_lang.common.prose import fixed
from aidl_lang.common.records import record
from aidl_lang.export import marks
from aidl_lang.export.dimension_marks import HEIGHT, Pen
from aidl_lang.export.dimensioning import Callout, dimensioned_to_scale
from aidl_lang.export.drafting import tables
from aidl_lang.export.drafting.contents import Content, View, contents
from aidl_lang.export.drafting.tables import BLACK, NARROW, SMALL, WIDE, WIDTH, Paper, Table
from aidl_lang.export.job import ExportError, Job
from aidl_lang.export.marks import Area, Curves, Group, Ink, Mark, Picture, Placing, Text, corners, widened
from aidl_lang.geometry.curves import Arc, Bounds, Circle, Line, Piece, Vec, union_bounds
from aidl_lang.geometry.dimensions import mirror_levels
from aidl_lang.geometry.dimensions.sketch import is_half_round
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.solved import SolvedStructure

# --- Views at their scale, as marks in mm on paper.

_BEYOND = 2.5
"""Centre lines reach so far beyond a circle, mm on paper."""
_CHAIN = (6.0, 1.0, 0.8, 1.0)
_SHORT = 8.0
"""Centre lines up to this length are whole, mm on paper."""
_LABEL = 8.0
_FREE = "Outline not dimensioned: as in the file"
"""Stands below parts that are made from a DXF, not by hand."""


@record()
class DrawnView:
    """A view on paper, its lower left corner in the origin; `left` is how many dimensions found no place."""

    width: float
    height: float
    groups: tuple[Group, ...]
    left: int

    def at(self, corner: Vec, number: int) -> tuple[Group, ...]:
        """Returns the groups moved to a place, under names of their own."""
        placing = Placing(1.0, corner)
        return tuple(
            replace(placing.group(group), name=f"view-{number}-{group.name}") for group in self.groups
        )


def drawn_view(view: View, factor: float, digits: float) -> DrawnView:
    """Draws a view. `factor`: millimetres on paper for one of the part; `digits`: height of the values."""
    pen = Pen(digits / HEIGHT / factor)
    signs = tuple(
        Text((x + reach, y + reach), hole.sign, SMALL / marks.CAPITAL / factor, BLACK)
        for hole in view.holes
        for (x, y), reach in [(hole.circle.center, 0.72 * hole.circle.radius + 0.8 / factor)]
    )
    callouts = [
        Callout(f"item-{number}", str(number), tuple(_spots(body.box, body.region.faces[0].outer.pieces)))
        for number, body in view.balloons
    ]
    callouts += [
        Callout(f"note-{number}", words, tuple(_spots(union_bounds([p.box for p in pieces]), pieces)))
        for number, (words, pieces) in enumerate(view.notes, 1)
    ]
    box, dimensions, left = dimensioned_to_scale(view.drawing, pen, view.wanted, callouts, signs)
    centers = tuple(_center_lines(view.drawing, factor))
    outlines = Group("outline", tuple(_outlines(view.drawing, factor)), {"class": "outline"})
    box = union_bounds([box, widened(view.drawing.box, (_BEYOND + 1) / factor)])
    words = [view.label] if view.label else []
    words += [_FREE] if view.free else []
    bottom = _LABEL if words else 0.0
    placing = Placing(factor, (-factor * box[0], bottom - factor * box[1]))
    box = union_bounds([box, *(sign.box for sign in signs)])
    signed = Group("holes", (*_datum(view, factor), *signs), {"class": "holes"})
    groups = [outlines, signed, Group("centers", centers, {"class": "center"}), *dimensions]
    placed = [placing.group(replace(g, marks=tuple(map(_black, g.marks)))) for g in groups if g.marks]
    width, height = factor * (box[2] - box[0]), factor * (box[3] - box[1]) + bottom
    if words:
        width = max(width, tables.width_of(". ".join(words), SMALL))
        label = tables.written(". ".join(words), (width / 2, 0.5), SMALL, "middle")
        placed.append(Group("label", (label,), {"class": "label"}))
    return DrawnView(width, height, tuple(placed), left)


def _spots(box: Bounds, pieces: Sequence[Piece]) -> Iterator[tuple[Vec, Vec]]:
    """Yields places on an outline with the way from there to the outside, about."""
    left, bottom, right, top = box
    for piece in pieces:
        for t in (0.5, 0.3, 0.7):
            tip = piece.point(t)
            for turn in (45, 135, -45, -135, 20, 160, 70, 110):
                way = math.cos(math.radians(turn)), math.sin(math.radians(turn))
                out = (tip[0] - (left + right) / 2) * way[0] + (tip[1] - (bottom + top) / 2) * way[1]
                if out > 0:
                    yield tip, way


def _datum(view: View, factor: float) -> Iterator[Mark]:
    """Yields the axes from whose origin holes are placed, if there is a table of them."""
    if view.holes:
        left, bottom, _, _ = view.drawing.box
        is_corner = abs(view.datum[0] - left) + abs(view.datum[1] - bottom) < 1e-6 * view.drawing.size
        size = SMALL / marks.CAPITAL / factor
        reach, aside = 9.0 / factor, 1.0 / factor
        for way, sign in (((1.0, 0.0), "X"), ((0.0, 1.0), "Y")):
            x, y = (left - 3 * aside, bottom - 3 * aside) if is_corner else view.datum
            end = x + reach * way[0], y + reach * way[1]
            yield Curves((Line((x, y), end),), Ink(BLACK, WIDE / factor), "datum")
            yield Text((end[0] + aside * way[0], end[1] + aside * way[1]), sign, size, BLACK, halo=False)


def _outlines(drawing: Drawing, factor: float) -> Iterator[Mark]:
    wide, narrow = Ink(BLACK, WIDE / factor), Ink(BLACK, NARROW / factor)
    for body in drawing.bodies:
        for face in body.region.faces:
            yield Area(face, "#ffffff", wide, "outline")
    for stroke in drawing.strokes:
        yield Curves(stroke.pieces, narrow, stroke.role)


def _center_lines(drawing: Drawing, factor: float) -> Iterator[Curves]:
    """Yields crosses at the centres of all that is round for half a turn or more."""
    largest: dict[tuple[int, int], Circle | Arc] = {}
    slack = 1e-6 * drawing.size
    on_part = [stroke.pieces[0] for stroke in drawing.strokes if len(stroke.pieces) == 1]
    rounds = [piece for body in drawing.bodies for piece in body.region.pieces if is_half_round(piece)]
    for piece in (*rounds, *(piece for piece in on_part if isinstance(piece, Circle))):
        if isinstance(piece, Arc | Circle):
            key = round(piece.center[0] / slack), round(piece.center[1] / slack)
            if key not in largest or largest[key].radius < piece.radius:
                largest[key] = piece
    for body in drawing.bodies if len(drawing.bodies) == 1 else ():
        left, bottom, right, top = widened(body.box, _BEYOND / factor)
        x, y = mirror_levels(body, slack)
        has_circle = any(
            isinstance(p, Circle) and 2 * p.radius >= 0.999 * (body.box[2] - body.box[0])
            for p in body.region.pieces
        )
        if x is not None and not has_circle:
            yield center_line((x, bottom), (x, top), factor)
        if y is not None and not has_circle:
            yield center_line((left, y), (right, y), factor)
    for piece in largest.values():
        (x, y), reach = piece.center, piece.radius + _BEYOND / factor
        yield center_line((x - reach, y), (x + reach, y), factor)
        yield center_line((x, y - reach), (x, y + reach), factor)


def center_line(start: Vec, end: Vec, factor: float) -> Curves:
    """Returns a chain line, or a whole one if it is short on paper."""
    is_short = factor * math.dist(start, end) <= _SHORT
    dash = None if is_short else tuple(part / factor for part in _CHAIN)
    pieces: tuple[Piece, ...] = (Line(start, end),)
    return Curves(pieces, Ink(BLACK, NARROW / factor, dash), "center")


def _black(mark: Mark) -> Mark:
    match mark:
        case Area(ink=None):
            return replace(mark, fill=BLACK)
        case Curves(ink=ink):
            return replace(mark, ink=replace(ink, color=BLACK))
        case Text():
            return replace(mark, color=BLACK)
    return mark


Scale = tuple[int, int]

_AIR, _BETWEEN = 6.0, 14.0
"""Free space inside the frame, and between views, mm."""
_LEAST = {"a4": 0.5, "letter": 0.5, "a3": 0.2, "tabloid": 0.2, "a2": 0.1, "a1": 0.05}
"""The smallest scale for which a paper is taken before a larger one is tried."""
_MANY = 24
"""A view with more dimensions than this is not made smaller to save paper."""
_LONGEST_TITLE = 32
"""Characters of a headline that serves as a title."""
_SIDE_BY_SIDE = 3
"""Holes in a row of their table."""
_LARGEST = 10.0
"""Enlargements go no further unless they are asked for."""


@record()
class Draft:
    """What is asked of drawing sheets; what is None is chosen by fit.

    date  as it is to be written: without one the sheet bears none, and the same program gives the same file
    """

    paper: str | None = None
    is_landscape: bool | None = None
    scale: Scale | None = None
    standard: str = "iso"
    date: str = ""


@record()
class _Laid:
    paper: Paper
    scale: Scale
    views: tuple[tuple[Vec, DrawnView], ...]


def drafted(job: Job, draft: Draft) -> list[Picture]:
    """Returns the drawing sheets of a model as pictures. Raises ExportError (E0970) if something has no place
    on the paper or at the scale that is asked for, or if nothing is drawn.
    """
    if not job.drawing.bodies and not job.drawing.strokes:
        raise ExportError("E0970", "nothing is drawn, so there is nothing to put on a sheet")
    sheets = contents(job.model, job.drawing)
    standard = tables.STANDARDS[draft.standard]
    pages = []
    for number, content in enumerate(sheets, 1):
        laid = _laid(content, draft, standard)
        title = _title(job, content, draft, laid, f"{number} of {len(sheets)}")
        pages.append(_page(content, laid, title, standard))
    return pages


def _laid(content: Content, draft: Draft, standard: tables.Standard) -> _Laid:
    """Returns the sheet on the smallest paper, at the largest scale, that hold everything."""
    choices = list(tables.papers(standard, draft.paper, draft.is_landscape))
    is_crowded = max(len(view.wanted) for view in content.views) > _MANY
    best: _Laid | None = None
    for name, ways in groupby(choices, key=lambda paper: paper.name):
        for paper in ways:
            laid = _fitted(content, draft, paper)
            if laid is not None and (best is None or _factor(laid.scale) > _factor(best.scale)):
                best = laid
        least = 1.0 if is_crowded and name in _LEAST else _LEAST.get(name, 0.0)
        if best is not None and _factor(best.scale) >= least:
            return best
    if best is None:
        where = "any paper" if draft.paper is None else f"{choices[0].label} paper"
        at = f" at {tables.scale_text(draft.scale)}" if draft.scale is not None else ""
        message = f"`{content.subject.path}` does not fit on {where}{at} with its dimensions"
        raise ExportError("E0970", message, "leave out `--scale` and `--paper` to have them chosen")
    return best


def _fitted(content: Content, draft: Draft, paper: Paper) -> _Laid | None:
    """Returns the sheet at the largest scale at which all views and dimensions have a place on a paper."""
    rooms = list(_rooms(content, paper))
    sizes = [
        (v.drawing.box[2] - v.drawing.box[0], v.drawing.box[3] - v.drawing.box[1]) for v in content.views
    ]
    for scale in (draft.scale,) if draft.scale is not None else tables.SCALES:
        factor = _factor(scale)
        if draft.scale is None and factor > _LARGEST:
            continue
        if not any(_arranged([(factor * w, factor * h) for w, h in sizes], room) for room in rooms):
            continue
        views = [drawn_view(view, factor, paper.digits) for view in content.views]
        for room in rooms:
            corners = _arranged([(v.width, v.height) for v in views], room)
            if corners is not None and not any(v.left for v in views):
                return _Laid(paper, scale, tuple(zip(corners, views, strict=True)))
    return None


def _factor(scale: Scale) -> float:
    return scale[0] / scale[1]


def _rooms(content: Content, paper: Paper) -> Iterator[Bounds]:
    """Yields the free parts of a sheet: above the title block and the tables on it, and beside them."""
    left, bottom, right, top = paper.frame
    stack = tables.TITLE_HEIGHT + sum(table.height for table in _tables(content))
    if top - bottom - stack > 2 * _AIR:
        yield left + _AIR, bottom + stack + _AIR, right - _AIR, top - _AIR
    if right - left - WIDTH > 2 * _AIR:
        yield left + _AIR, bottom + _AIR, right - WIDTH - _AIR, top - _AIR


def _arranged(sizes: Sequence[tuple[float, float]], room: Bounds) -> list[Vec] | None:
    """Returns the lower left corners of views in a row or a column amid a room; None without a place."""
    width, height = room[2] - room[0], room[3] - room[1]
    for axis in (0, 1):
        along = sum(size[axis] for size in sizes) + _BETWEEN * (len(sizes) - 1)
        across = max(size[1 - axis] for size in sizes)
        if along <= (width, height)[axis] and across <= (width, height)[1 - axis]:
            corners = []
            at = room[axis] + ((width, height)[axis] - along) / 2
            for size in sizes if axis == 0 else sizes[::-1]:
                aside = room[1 - axis] + ((width, height)[1 - axis] - size[1 - axis]) / 2
                corners.append((at, aside) if axis == 0 else (aside, at))
                at += size[axis] + _BETWEEN
            return corners if axis == 0 else corners[::-1]
    return None


def _tables(content: Content) -> list[Table]:
    found = [Table("notes", ("Notes",), tuple((line,) for line in content.lines))] if content.lines else []
    if content.items:
        rows = tuple(
            (str(item.number), item.name, str(item.count), item.style.material or "", item.size)
            for item in content.items
        )
        heads = ("Item", "Name", "Qty", "Material", "Size")
        found.append(Table("parts", heads, rows, frozenset({0, 2})))
    return found + [_table_of_holes(view) for view in content.views if view.holes]


def _table_of_holes(view: View) -> Table:
    """Returns the places of holes, from top to bottom and then further to the right."""
    count = -(-len(view.holes) // _SIDE_BY_SIDE)
    cells = [(hole.sign, fixed(hole.x, 2), fixed(hole.y, 2), hole.words) for hole in view.holes]
    cells += [("", "", "", "")] * (count * _SIDE_BY_SIDE - len(cells))
    rows = tuple(tuple(chain(*cells[row::count])) for row in range(count))
    return Table("holes", ("Hole", "X", "Y", "⌀") * _SIDE_BY_SIDE, rows, frozenset(range(4 * _SIDE_BY_SIDE)))


def _title(job: Job, content: Content, draft: Draft, laid: _Laid, sheet: str) -> dict[str, str]:
    root, subject = job.model.root, content.subject

    def said(name: str, of: SolvedStructure = root) -> str:
        return str(next(iter(of.attributes.get(name, ())), ""))

    title = said("title", subject) or _named(subject.doc, subject.name)
    if subject is not root:
        title = f"{said('title') or _plain(root.name)}: {title}"
    if content.count > 1:
        title = f"{title} ({content.count}×)"
    thickness = "" if content.style.thickness is None else f"{fixed(content.style.thickness, 3)} mm"
    return {
        "title": title,
        "number": said("number", subject) or said("number"),
        "revision": said("revision", subject) or said("revision"),
        "author": said("author"),
        "date": draft.date,
        "material": "see list" if content.items else content.style.material or "",
        "thickness": "see list" if content.items else thickness,
        "scale": tables.scale_text(laid.scale),
        "paper": laid.paper.label,
        "sheet": sheet,
        "unit": "mm, degrees",
    }


def _named(doc: str | None, name: str) -> str:
    """Returns what a part is called: the head of its documentation, up to a colon, else its name."""
    first = (doc or "").strip().partition("\n")[0]
    head = first.partition(":")[0].partition(". ")[0].rstrip(".").strip()
    return head if 0 < len(head) <= _LONGEST_TITLE else _plain(name)


def _plain(name: str) -> str:
    words = name.partition("[")[0].replace("_", " ")
    return words[:1].upper() + words[1:]


def _page(content: Content, laid: _Laid, title: Mapping[str, str], standard: tables.Standard) -> Picture:
    _, bottom, right, _ = laid.paper.frame
    frame = tables.outline(*corners(laid.paper.frame), width=2 * WIDE, role="frame")
    groups = [Group("frame", (frame,), {"class": "frame"})]
    for number, (corner, view) in enumerate(laid.views, 1):
        groups += view.at(corner, number)
    groups.append(tables.title_block(title, right - WIDTH, bottom, standard.is_first_angle))
    level = bottom + tables.TITLE_HEIGHT
    for table in _tables(content):
        groups.append(table.group(right - WIDTH, level))
        level += table.height
    return Picture(laid.paper.box, tuple(groups))
