"""The list of what is to be cut, as CSV and as pages."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

from aidl_lang.common.prose import first_few, fixed
from aidl_lang.common.records import record
from aidl_lang.common.world import csv_text
from aidl_lang.export.cuts import outlines
from aidl_lang.export.job import ON_SHEETS, Exported, ExportError, Job
from aidl_lang.export.marks import Group, Picture
from aidl_lang.export.profiles import CUTS, PLAIN
from aidl_lang.geometry.parts import Motion, Part, Size, alike, drawn, parts_of, smallest_size
from aidl_lang.geometry.region import area, length

# --- Parts each by itself: a job for every part that differs from the others.


def jobs_of_parts(job: Job) -> Iterator[tuple[Item, Job]]:
    """Yields each item of the cut list with the job for one of its parts: flat, with its lower left corner at
    the origin. Raises ExportError for what explains the whole, and if there is no part.
    """
    options = job.options
    is_on_sheets = options.sheet is not None
    if options.dimension or (options.show and not (is_on_sheets and options.show.issubset(ON_SHEETS))):
        option = "--dimension" if options.dimension else f"--show {','.join(sorted(options.show))}"
        message = f"`{option}` explains the whole drawing and has no place in files of single parts"
        raise ExportError("E0926", message, "write it to a file of its own")
    items = job.cut_list.items
    if not items:
        raise ExportError(
            "E0926", "there is no part to write", "only a `solid` is cut; a `drawing` is engraved"
        )
    alone = replace(options, cut=options.for_cutter, sheet=None, nest=None, kerf=0.0, show=frozenset())
    found = {part.body.path: part for part in parts_of(job.model.root, job.drawing)[0]}
    for item in items:
        part = found[item.part.body.path]
        part = part.moved(Motion(0.0, -part.box[0], -part.box[1]))
        yield item, replace(job, drawing=drawn(job.drawing, [part]), options=alone, is_flat=True)


NAMED = 3
"""Names that an item bears; of more, the others are counted."""


@record()
class Item:
    """Equal parts of one stock. `part` is the first of them; `paths` are those of all."""

    number: int
    name: str
    part: Part
    paths: tuple[str, ...]
    quantity: int
    thickness: float | None
    size: Size
    area: float
    cut: float

    @property
    def material(self) -> str:
        return self.part.body.style.material or ""


@record()
class CutList:
    """The items in the order of their stocks, and the number of the item that each body is one of."""

    items: tuple[Item, ...]
    numbers: dict[str, int]


def cut_list(job: Job) -> CutList:
    found, _ = parts_of(job.model.root, job.drawing)
    groups = sorted(alike(found), key=lambda group: group[0].stock)
    names = _Names(job)
    items = tuple(_item(job, number, group, names) for number, group in enumerate(groups, 1))
    return CutList(items, {path: item.number for item in items for path in item.paths})


def _item(job: Job, number: int, group: Sequence[Part], names: _Names) -> Item:
    part = group[0]
    paths = tuple(p.body.path for p in group)
    followed = outlines(job.model, drawn(job.drawing, [part]), job.options.followed or PLAIN)
    return Item(
        number,
        first_few(names.of(paths), NAMED),
        part,
        paths,
        sum(p.body.style.quantity for p in group),
        job.options.thickness if part.body.style.thickness is None else part.body.style.thickness,
        smallest_size(part),
        area(part.body.region),
        sum(length(piece) for outline in followed if outline.operation in CUTS for piece in outline.pieces),
    )


class _Names:
    """Names of bodies in a list: paths from the root, without the indices of arrays all of one item."""

    def __init__(self, job: Job) -> None:
        self._root = job.model.root.path
        self._members = Counter(_stem(self.short(body.path)) for body in job.drawing.bodies)

    def short(self, path: str) -> str:
        return path.removeprefix(f"{self._root}.")

    def of(self, paths: Sequence[str]) -> list[str]:
        names = [self.short(path) for path in paths]
        here = Counter(map(_stem, names))
        return list(dict.fromkeys(s if here[s := _stem(n)] == self._members[s] else n for n in names))


def _stem(name: str) -> str:
    head, bracket, _ = name.rpartition("[")
    return _stem(head) if bracket and name.endswith("]") else name


@record()
class Sheet:
    """What is on a sheet: how many pieces of which number, their share of it, the length of cuts, mm."""

    number: int
    material: str
    thickness: float | None
    pieces: Counter[int]
    used: float
    cut: float


def sheets(found: CutList, jobs: Sequence[Job]) -> Iterator[Sheet]:
    by_number = {item.number: item for item in found.items}
    for number, job in enumerate(jobs, 1):
        pieces = Counter(found.numbers[body.path] for body in job.drawing.bodies)
        items = [(by_number[n], count) for n, count in pieces.items()]
        first, (left, bottom, right, top) = items[0][0], job.drawing.box
        yield Sheet(
            number,
            first.material,
            first.thickness,
            pieces,
            sum(item.area * count for item, count in items) / ((right - left) * (top - bottom)),
            sum(item.cut * count for item, count in items),
        )


# --- The cut list as CSV, and as pages of a picture.

_DECIMALS, _SHOWN = 3, 1
"""Of lengths and areas in CSV and on pages."""
_ROWS = 42
"""Lines of a table on a page."""
_MARGIN, _TITLE = 10.0, 8.0
"""Around the table on a page, and above it, mm."""

_PARTS = (
    *("number", "part", "quantity", "material", "thickness_mm"),
    *("width_mm", "height_mm", "area_mm2", "cut_mm"),
)
_SHEETS = ("sheet", "material", "thickness_mm", "pieces", "numbers", "used_percent", "cut_mm")


def to_csv(jobs: Sequence[Job]) -> Exported:
    """Writes the list, and below it that of the sheets. Raises ExportError if there is no part."""
    found = jobs[0].cut_list
    if not found.items:
        raise ExportError(
            "E0924", "there is no part to list", "only a `solid` is cut; a `drawing` is engraved on it"
        )
    rows = [_PARTS, *(_line(item, _DECIMALS) for item in found.items)]
    if jobs[0].options.sheet is not None:
        rows += [(), _SHEETS, *(_sheet_line(sheet, _DECIMALS) for sheet in sheets(found, jobs))]
    return Exported(csv_text(rows, end="\r\n").encode("utf-8-sig"))


def pages(jobs: Sequence[Job]) -> list[Picture]:
    found = jobs[0].cut_list
    return [
        *_pages(
            "cut-list",
            "Parts",
            ("No.", "Part", "Qty", "Material", "Thick", "Width", "Height", "Area", "Cut"),
            [_line(item, _SHOWN) for item in found.items],
            frozenset({0, 2, 4, 5, 6, 7, 8}),
        ),
        *_pages(
            "sheets",
            "Sheets",
            ("Sheet", "Material", "Thick", "Pieces", "Numbers", "Used %", "Cut"),
            [_sheet_line(sheet, _SHOWN) for sheet in sheets(found, jobs)],
            frozenset({0, 2, 3, 5, 6}),
        ),
    ]


def _line(item: Item, decimals: int) -> tuple[str, ...]:
    lengths = (item.thickness, *item.size, item.area, item.cut)
    numbers = (_number(value, decimals) for value in lengths)
    return (str(item.number), item.name, str(item.quantity), item.material, *numbers)


def _sheet_line(sheet: Sheet, decimals: int) -> tuple[str, ...]:
    return (
        str(sheet.number),
        sheet.material,
        _number(sheet.thickness, decimals),
        str(sheet.pieces.total()),
        " ".join(map(str, sorted(sheet.pieces))),
        _number(100 * sheet.used, 1),
        _number(sheet.cut, decimals),
    )


def _number(value: float | None, decimals: int) -> str:
    return "" if value is None else fixed(value, decimals)


def _pages(
    name: str, title_of: str, heads: tuple[str, ...], rows: Sequence[tuple[str, ...]], numeric: frozenset[int]
) -> Iterator[Picture]:
    from aidl_lang.export.drafting.tables import LARGE, WIDTH, Table, written

    for first in range(0, len(rows), _ROWS):
        table = Table(name, heads, tuple(rows[first : first + _ROWS]), numeric)
        width, height = WIDTH + 2 * _MARGIN, table.height + _TITLE + 2 * _MARGIN
        title = written(
            f"{title_of}: lengths in mm, areas in mm²", (_MARGIN, height - _MARGIN - LARGE), LARGE
        )
        groups = (Group(f"{name}-title", (title,), {"class": "table"}), table.group(_MARGIN, _MARGIN))
        yield Picture((0.0, 0.0, width, height), groups)
