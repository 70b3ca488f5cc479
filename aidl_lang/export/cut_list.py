"""The list of what is to be cut: each part that differs from the others, and how many pieces of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

from aidl_lang.common.prose import first_few
from aidl_lang.common.records import record
from aidl_lang.export import ON_SHEETS, ExportError, Job
from aidl_lang.export.cuts import outlines
from aidl_lang.export.profiles import CUTS, PLAIN
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.measures import area, length
from aidl_lang.geometry.parts import Motion, Part, Size, alike, drawn, parts_of, smallest_size

# --- Parts each by itself: a job for every part that differs from the others.


def jobs_of_parts(job: Job) -> Iterator[tuple[Item, Job]]:
    """Yields each item of the cut list with the job for one of its parts: flat, with its lower left corner at
    the origin. Raises ExportError for what explains the whole, and if there is no part.
    """
    options = job.options
    is_on_sheets = options.sheet is not None
    if options.dimension or (options.show and not (is_on_sheets and options.show.issubset(ON_SHEETS))):
        option = "--dimension" if options.dimension else f"--show {','.join(sorted(options.show))}"
        raise ExportError(
            "E0926",
            f"`{option}` explains the whole drawing and has no place in files of single parts",
            "write it to a file of its own",
        )
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
    """Returns the list of all bodies of a drawing."""
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
    """What bodies are called in a list: by their paths from the root, arrays that are all of one item without
    the numbers of their members.
    """

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
    """What is on a sheet: how many pieces of which number, which share of it they are, how long all cuts
    are, mm.
    """

    number: int
    material: str
    thickness: float | None
    pieces: Counter[int]
    used: float
    cut: float


def sheets(found: CutList, jobs: Sequence[Job]) -> Iterator[Sheet]:
    """Yields what is on each sheet."""
    by_number = {item.number: item for item in found.items}
    for number, job in enumerate(jobs, 1):
        pieces = Counter(found.numbers[body.path] for body in job.drawing.bodies)
        items = [(by_number[n], count) for n, count in pieces.items()]
        first, (width, height) = items[0][0], _size(job.drawing)
        yield Sheet(
            number,
            first.material,
            first.thickness,
            pieces,
            sum(item.area * count for item, count in items) / (width * height),
            sum(item.cut * count for item, count in items),
        )


def _size(drawing: Drawing) -> Size:
    left, bottom, right, top = drawing.box
    return right - left, top - bottom
