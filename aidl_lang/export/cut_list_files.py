"""The cut list as CSV, and as pages of a picture."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from aidl_lang.common.files import csv_text
from aidl_lang.common.prose import fixed
from aidl_lang.export import Exported, ExportError, Job
from aidl_lang.export.cut_list import Item, Sheet, sheets
from aidl_lang.export.drafting.tables import LARGE, WIDTH, Table, written
from aidl_lang.export.marks import Group, Picture

_DECIMALS, _SHOWN = 3, 1
"""Of lengths and areas in CSV and on pages."""
_ROWS = 42
"""Lines of a table on a page."""
_MARGIN, _TITLE = 10.0, 8.0
"""Around the table on a page, and above it, mm."""

_PARTS = (
    *(
        "number",
        "part",
        "quantity",
        "material",
        "thickness_mm",
        "width_mm",
        "height_mm",
        "area_mm2",
        "cut_mm",
    ),
)
_SHEETS = ("sheet", "material", "thickness_mm", "pieces", "numbers", "used_percent", "cut_mm")


def to_csv(jobs: Sequence[Job]) -> Exported:
    """Writes the list; below it, where parts are laid on sheets, a line for each sheet. Raises ExportError
    if there is no part.
    """
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
    """Returns the list as pages."""
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
    for first in range(0, len(rows), _ROWS):
        table = Table(name, heads, tuple(rows[first : first + _ROWS]), numeric)
        width, height = WIDTH + 2 * _MARGIN, table.height + _TITLE + 2 * _MARGIN
        title = written(
            f"{title_of}: lengths in mm, areas in mm²", (_MARGIN, height - _MARGIN - LARGE), LARGE
        )
        groups = (Group(f"{name}-title", (title,), {"class": "table"}), table.group(_MARGIN, _MARGIN))
        yield Picture((0.0, 0.0, width, height), groups)
