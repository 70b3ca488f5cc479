"""Parts to be cut: listed, each by itself, widened by the cut and laid out on sheets; the list as a file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import counted, first_few, fixed, listed, named, size_text
from aidl_lang.common.records import record
from aidl_lang.common.world import csv_text
from aidl_lang.export.cuts import outlines
from aidl_lang.export.job import ON_SHEETS, Exported, ExportError, Job, Progress, require
from aidl_lang.export.marks import Group, Picture
from aidl_lang.export.profiles import CUTS, PLAIN
from aidl_lang.export.unsaid import twice_compensated
from aidl_lang.geometry.arcs import WIDEST, Slit, as_arcs, has_slivers, without_slits
from aidl_lang.geometry.curves import union_bounds
from aidl_lang.geometry.drawing import SLIT, Drawing, Stroke
from aidl_lang.geometry.offsets import offset
from aidl_lang.geometry.parts import Motion, Part, Size, alike, drawn, parts_of, smallest_size, thickness_of
from aidl_lang.geometry.region import Face, Loop, Region, length
from aidl_lang.geometry.sheets import NestingError, laid_out
from aidl_lang.geometry.solved import SolvedModel

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
        hint = "only a `solid` is cut; a `drawing` is engraved"
        raise ExportError("E0926", "there is no part to write", hint)
    alone = replace(options, cut=options.for_cutter, sheet=None, nest=None, kerf=0.0, show=frozenset())
    found = {part.body.path: part for part in parts_of(job.drawing)[0]}
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
    found, _ = parts_of(job.drawing)
    root = f"{job.model.root.path}."
    said = job.options.thickness
    members = Counter(_stem(body.path.removeprefix(root)) for body in job.drawing.bodies)
    items = []
    for number, group in enumerate(sorted(alike(found), key=lambda group: group[0].stock), 1):
        part, paths = group[0], tuple(p.body.path for p in group)
        names = [path.removeprefix(root) for path in paths]
        here = Counter(map(_stem, names))
        # Arrays all of one item are named without indices.
        own = dict.fromkeys(s if here[s := _stem(n)] == members[s] else n for n in names)
        followed = outlines(job.model, drawn(job.drawing, [part]), job.options.followed or PLAIN)
        cut = sum(length(p) for outline in followed if outline.operation in CUTS for p in outline.pieces)
        quantity, thickness = sum(p.body.style.quantity for p in group), thickness_of(part.body, said)
        size, area = smallest_size(part), part.body.region.area
        items.append(Item(number, first_few(own, NAMED), part, paths, quantity, thickness, size, area, cut))
    return CutList(tuple(items), {path: item.number for item in items for path in item.paths})


def _stem(name: str) -> str:
    head, bracket, _ = name.rpartition("[")
    return _stem(head) if bracket and name.endswith("]") else name


# --- Jobs for cutters: outlines widened by the cut, parts laid out on sheets, one job for each sheet.

_SAME = 1e-6
"""Difference of widths, relative to the cut, that is none."""
MOST_PARTS = 5000
"""More parts are a mistake, and would take minutes to pack."""


def grown(job: Job, progress: Progress) -> tuple[Job, list[Diagnostic]]:
    """Returns the job with its outlines widened by half the cut, with notes. `progress` hears of it."""
    if not job.options.kerf:
        return job, []
    drawing, slits = _widened(job, job.options.kerf / 2, progress)
    notes = [*twice_compensated(job.model.root, job.options.kerf), *_slit_notes(job, slits)]
    return replace(job, drawing=drawing, whole=job), notes


def laid_on_sheets(job: Job, sheet: Size, spacing: float) -> tuple[list[Job], list[Diagnostic]]:
    """Returns a job for each sheet, with notes; raises ExportError if the parts cannot be laid out."""
    if unfit := sorted(job.options.show.difference(ON_SHEETS)):
        message = f"`--show {','.join(unfit)}` explains the assembled drawing and has no place on cut sheets"
        hint = "`--show names,numbers` writes the names and numbers of the parts on them"
        raise ExportError("E0924", message, hint)
    if min(sheet) <= 2 * spacing:
        message = f"a sheet of {size_text(sheet)} has no room within a spacing of {fixed(spacing)} mm"
        raise ExportError("E0924", message, "give a larger `--sheet` or a smaller `--spacing`")
    count = sum(body.style.quantity for body in job.drawing.bodies)
    if not count:
        message = "there is no part to lay on a sheet"
        raise ExportError("E0924", message, "only a `solid` is cut; a `drawing` is engraved on it")
    if count > MOST_PARTS:
        message = f"{count} parts are more than the {MOST_PARTS} that are laid on sheets"
        raise ExportError("E0924", message, "draw them in several programs")
    if job.options.nest is not None:
        require("spyrrow", "--nest", "nest")
    try:
        layout = laid_out(job.drawing, sheet, spacing, job.options.nest)
    except NestingError as reason:
        message = f"the parts could not be packed by their outlines: {reason}"
        hint = "leave `--nest` out: they are packed by their boxes then"
        raise ExportError("E0924", message, hint) from None
    if layout.oversize:
        raise _oversize(layout.oversize, sheet, spacing)
    notes = [_stray_note(job.model, layout.strays)] if layout.strays else []
    whole = job.whole or job
    return [replace(job, drawing=drawing, whole=whole) for drawing in layout.sheets], notes


def _oversize(parts: Sequence[tuple[str, Size]], sheet: Size, spacing: float) -> ExportError:
    path, size = max(parts, key=lambda part: max(part[1]))
    names = named([path for path, _ in parts])
    needed = tuple(side + 2 * spacing for side in size)
    if len(parts) == 1:
        message = f"{names} measures {size_text(size)} and does not fit on a sheet of {size_text(sheet)}"
    else:
        message = f"{names} do not fit on a sheet of {size_text(sheet)}; `{path}` measures {size_text(size)}"
    around = f" with {fixed(spacing)} mm around it" if spacing else ""
    largest = "it" if len(parts) == 1 else f"`{path}`"
    hint = f"{largest} needs a sheet of at least {size_text(needed)}{around}"
    paper = "to print it on small paper and join the pages, use `--tile a4` in place of `--sheet`"
    return ExportError("E0923", message, hint, paper)


def _stray_note(model: SolvedModel, strays: Sequence[Stroke]) -> Diagnostic:
    spans = {g.path: g.span for s in model.root.walk() for geometry in s.drawn for g in geometry.walk()}
    names = list(dict.fromkeys(stroke.geometry for stroke in strays))
    message = f"what of {named(names)} lies on no part is left off the sheets"
    hint = "a drawing inside a `solid` is laid out with it"
    return Diagnostic("W0736", message, spans.get(names[0]), hints=(hint,))


def _slit_notes(job: Job, slits: Mapping[str, Sequence[Slit]]) -> Iterator[Diagnostic]:
    """Yields a note on slits that become as wide as the cut, and were drawn in another width."""
    kerf = job.options.kerf
    others = {path: [s for s in own if abs(s.width - kerf) > _SAME * kerf] for path, own in slits.items()}
    for path, own in others.items():
        if own:
            structure, widths = job.model.root.find(path), sorted({fixed(round(s.width, 6)) for s in own})
            is_one = len(own) == 1
            cut = f"{counted(len(own), 'slit')} of `{path}` {'is' if is_one else 'are'} cut in one pass"
            message = f"{cut}: {fixed(kerf)} mm wide, as the cut, and drawn {listed(widths)} mm wide"
            hint = f"gaps wider than {fixed(WIDEST * kerf)} mm are cut along both sides"
            yield Diagnostic("N0757", message, None if structure is None else structure.span, hints=(hint,))


def _widened(job: Job, by: float, progress: Progress) -> tuple[Drawing, dict[str, list[Slit]]]:
    """Returns the drawing with all material grown by half the width of the cut, and holes shrunk by as
    much, and the slits that are lines in it. Outlines with pieces too short to be cut are drawn anew.
    """
    drawing = job.drawing
    holes = {s.path for s in job.model.root.walk() if s.kind == "hole"}
    grown = dict.fromkeys(holes, -by) | {body.path: by for body in drawing.bodies}
    regions = {}
    filled = {body.path: without_slits(body.region, 2 * by) for body in drawing.bodies}
    for done, (path, region) in enumerate(drawing.regions.items()):
        progress(done, len(drawing.regions))
        region, _ = filled.get(path, (region, ()))
        regions[path] = offset(region, grown.get(path, 0.0))
    progress(len(drawing.regions), len(drawing.regions))
    bodies = []
    for body in drawing.bodies:
        region = regions[body.path]
        if len(region.loops) != len(filled[body.path][0].loops):
            message = f"holes or gaps of `{body.path}` are narrower than a cut of {fixed(2 * by)} mm"
            raise ExportError("E0924", message, "widen them, or give a smaller `--kerf`")
        region = _smoothed(region, job.options.tolerance)
        bodies.append(replace(body, region=region))
    slits = {path: found for path, (_, found) in filled.items()}
    cuts = tuple(
        Stroke(path, path, (slit.way,), drawing.styles[path], SLIT)
        for path, found in slits.items()
        for slit in found
    )
    box = union_bounds([drawing.box, *(body.box for body in bodies)])
    strokes = drawing.strokes + cuts
    return replace(drawing, bodies=tuple(bodies), strokes=strokes, regions=regions, box=box), slits


def _smoothed(region: Region, tolerance: float) -> Region:
    """Returns the region with outlines that have no pieces too short to be cut."""

    def smooth(loop: Loop) -> Loop:
        if not has_slivers(loop.pieces, tolerance):
            return loop
        return replace(loop, pieces=as_arcs(loop.pieces, closed=True, tolerance=tolerance))

    return Region(tuple(Face(smooth(face.outer), tuple(map(smooth, face.holes))) for face in region.faces))


# --- The cut list as CSV, and as pages of a picture.

_DECIMALS, _SHOWN = 3, 1
"""Of lengths and areas in CSV and on pages."""
_ROWS = 42
"""Lines of a table on a page."""
_MARGIN, _TITLE = 10.0, 8.0
"""Around the table on a page, and above it, mm."""

_PARTS = tuple("number part quantity material thickness_mm width_mm height_mm area_mm2 cut_mm".split())
_SHEETS = ("sheet", "material", "thickness_mm", "pieces", "numbers", "used_percent", "cut_mm")


def to_csv(jobs: Sequence[Job]) -> Exported:
    """Writes the list, and below it that of the sheets. Raises ExportError if there is no part."""
    found = jobs[0].cut_list
    if not found.items:
        hint = "only a `solid` is cut; a `drawing` is engraved on it"
        raise ExportError("E0924", "there is no part to list", hint)
    rows = [_PARTS, *(_line(item, _DECIMALS) for item in found.items)]
    if jobs[0].options.sheet is not None:
        rows += [(), _SHEETS, *_sheets(found, jobs, _DECIMALS)]
    return Exported(csv_text(rows, end="\r\n").encode("utf-8-sig"))


def pages(jobs: Sequence[Job]) -> list[Picture]:
    found = jobs[0].cut_list
    parts, sheets = [_line(item, _SHOWN) for item in found.items], list(_sheets(found, jobs, _SHOWN))
    of_parts = ("No.", "Part", "Qty", "Material", "Thick", "Width", "Height", "Area", "Cut")
    of_sheets = ("Sheet", "Material", "Thick", "Pieces", "Numbers", "Used %", "Cut")
    return [*_pages("cut-list", "Parts", of_parts, parts), *_pages("sheets", "Sheets", of_sheets, sheets)]


def _line(item: Item, decimals: int) -> tuple[str, ...]:
    lengths = (item.thickness, *item.size, item.area, item.cut)
    numbers = (_number(value, decimals) for value in lengths)
    return (str(item.number), item.name, str(item.quantity), item.material, *numbers)


def _sheets(found: CutList, jobs: Sequence[Job], decimals: int) -> Iterator[tuple[str, ...]]:
    """Yields for each sheet how many pieces of which number are on it, their share of it, and the cuts."""
    by_number = {item.number: item for item in found.items}
    for number, job in enumerate(jobs, 1):
        pieces = Counter(found.numbers[body.path] for body in job.drawing.bodies)
        items = [(by_number[n], count) for n, count in pieces.items()]
        first, (left, bottom, right, top) = items[0][0], job.drawing.box
        used = sum(item.area * count for item, count in items) / ((right - left) * (top - bottom))
        yield (
            str(number),
            first.material,
            _number(first.thickness, decimals),
            str(pieces.total()),
            " ".join(map(str, sorted(pieces))),
            _number(100 * used, 1),
            _number(sum(item.cut * count for item, count in items), decimals),
        )


def _number(value: float | None, decimals: int) -> str:
    return "" if value is None else fixed(value, decimals)


def _pages(
    name: str, title_of: str, heads: tuple[str, ...], rows: Sequence[tuple[str, ...]]
) -> Iterator[Picture]:
    from aidl_lang.export.drafting.tables import LARGE, WIDTH, Table, written

    numeric = frozenset(k for k, head in enumerate(heads) if head not in ("Part", "Material", "Numbers"))
    for first in range(0, len(rows), _ROWS):
        table = Table(name, heads, tuple(rows[first : first + _ROWS]), numeric)
        width, height = WIDTH + 2 * _MARGIN, table.height + _TITLE + 2 * _MARGIN
        title = written(
            f"{title_of}: lengths in mm, areas in mm²", (_MARGIN, height - _MARGIN - LARGE), LARGE
        )
        groups = (Group(f"{name}-title", (title,), {"class": "table"}), table.group(_MARGIN, _MARGIN))
        yield Picture((0.0, 0.0, width, height), groups)
