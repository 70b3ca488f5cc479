"""Drawing sheets: parts on paper to a standard scale, with dimensions, a frame and a title block."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain, groupby

from aidl_lang.common.prose import fixed
from aidl_lang.common.records import record
from aidl_lang.export import ExportError, Job
from aidl_lang.export.drafting.contents import Content, View, contents
from aidl_lang.export.drafting.tables import (
    SCALES,
    STANDARDS,
    TITLE_HEIGHT,
    WIDE,
    WIDTH,
    Paper,
    Standard,
    Table,
    Title,
    lines,
    papers,
    scale_text,
    title_block,
)
from aidl_lang.export.drafting.views import DrawnView, drawn_view
from aidl_lang.export.marks import Group, Picture
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.solved import SolvedStructure

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
    """A sheet on which everything has a place."""

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
    standard = STANDARDS[draft.standard]
    pages = []
    for number, content in enumerate(sheets, 1):
        laid = _laid(content, draft, standard)
        title = _title(job, content, draft, laid, f"{number} of {len(sheets)}")
        pages.append(_page(content, laid, title, standard))
    return pages


def _laid(content: Content, draft: Draft, standard: Standard) -> _Laid:
    """Returns the sheet on the smallest paper, at the largest scale, that hold everything."""
    choices = list(papers(standard, draft.paper, draft.is_landscape))
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
        at = f" at {scale_text(draft.scale)}" if draft.scale is not None else ""
        raise ExportError(
            "E0970",
            f"`{content.subject.path}` does not fit on {where}{at} with its dimensions",
            "leave out `--scale` and `--paper` to have them chosen",
        )
    return best


def _fitted(content: Content, draft: Draft, paper: Paper) -> _Laid | None:
    """Returns the sheet at the largest scale at which all views and dimensions have a place on a paper."""
    rooms = list(_rooms(content, paper))
    sizes = [
        (v.drawing.box[2] - v.drawing.box[0], v.drawing.box[3] - v.drawing.box[1]) for v in content.views
    ]
    for scale in (draft.scale,) if draft.scale is not None else SCALES:
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
    stack = TITLE_HEIGHT + sum(table.height for table in _tables(content))
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
    """Returns the tables of a sheet, the lowest first."""
    found = [Table("notes", ("Notes",), tuple((line,) for line in content.lines))] if content.lines else []
    found += [_list_of_parts(content)] if content.items else []
    return found + [_table_of_holes(view) for view in content.views if view.holes]


def _table_of_holes(view: View) -> Table:
    """Returns the places of holes, from top to bottom and then further to the right."""
    count = -(-len(view.holes) // _SIDE_BY_SIDE)
    cells = [(hole.sign, fixed(hole.x, 2), fixed(hole.y, 2), hole.words) for hole in view.holes]
    cells += [("", "", "", "")] * (count * _SIDE_BY_SIDE - len(cells))
    rows = tuple(tuple(chain(*cells[row::count])) for row in range(count))
    return Table("holes", ("Hole", "X", "Y", "⌀") * _SIDE_BY_SIDE, rows, frozenset(range(4 * _SIDE_BY_SIDE)))


def _list_of_parts(content: Content) -> Table:
    rows = tuple(
        (str(item.number), item.name, str(item.count), item.style.material or "", item.size)
        for item in content.items
    )
    return Table("parts", ("Item", "Name", "Qty", "Material", "Size"), rows, frozenset({0, 2}))


def _title(job: Job, content: Content, draft: Draft, laid: _Laid, sheet: str) -> Title:
    root, subject = job.model.root, content.subject

    def said(name: str, of: SolvedStructure = root) -> str:
        return str(next(iter(of.attributes.get(name, ())), ""))

    title = said("title", subject) or _named(subject.doc, subject.name)
    if subject is not root:
        title = f"{said('title') or _plain(root.name)}: {title}"
    if content.count > 1:
        title = f"{title} ({content.count}×)"
    thickness = content.style.thickness
    return Title(
        title,
        said("number", subject) or said("number"),
        said("revision", subject) or said("revision"),
        said("author"),
        draft.date,
        "see list" if content.items else content.style.material or "",
        "see list" if content.items else f"{fixed(thickness, 3)} mm" if thickness is not None else "",
        scale_text(laid.scale),
        laid.paper.label,
        sheet,
    )


def _named(doc: str | None, name: str) -> str:
    """Returns what a part is called: the head of its documentation, up to a colon, else its name."""
    first = (doc or "").strip().partition("\n")[0]
    head = first.partition(":")[0].partition(". ")[0].rstrip(".").strip()
    return head if 0 < len(head) <= _LONGEST_TITLE else _plain(name)


def _plain(name: str) -> str:
    words = name.partition("[")[0].replace("_", " ")
    return words[:1].upper() + words[1:]


def _page(content: Content, laid: _Laid, title: Title, standard: Standard) -> Picture:
    left, bottom, right, top = laid.paper.frame
    around = (left, bottom), (right, bottom), (right, top), (left, top)
    frame = lines([*zip(around, (*around[1:], around[0]), strict=True)], 2 * WIDE, "frame")
    groups = [Group("frame", (frame,), {"class": "frame"})]
    for number, (corner, view) in enumerate(laid.views, 1):
        groups += view.at(corner, number)
    groups.append(title_block(title, right - WIDTH, bottom, standard.is_first_angle))
    level = bottom + TITLE_HEIGHT
    for table in _tables(content):
        groups.append(table.group(right - WIDTH, level))
        level += table.height
    return Picture(laid.paper.box, tuple(groups))
