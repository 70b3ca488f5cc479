"""Turns a drawing into a picture: what is filled, outlined and written, in which ink.

One group for each structure from back to front: later siblings lie over earlier ones, unless they say
otherwise; what explains the picture lies above them all.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from aidl_lang.export import Job, themes
from aidl_lang.export.labels import labels
from aidl_lang.export.marks import LETTERS, Area, Curves, Group, Ink, Mark, Picture
from aidl_lang.export.overlay import explain
from aidl_lang.export.svg import gradient_of
from aidl_lang.export.themes import themed
from aidl_lang.geometry.drawing import Body, Drawing, Seam, Stroke
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.network import union_bounds
from aidl_lang.geometry.region import Region
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from aidl_lang.geometry.stacking import stacked
from aidl_lang.geometry.styles import DASH, GAP, Style

if TYPE_CHECKING:
    from aidl_lang.export.svg import Halos

MARGIN = 0.03
OUTLINE_WIDTH, SEAM_WIDTH, STROKE_WIDTH = 0.0025, 0.001, 0.003
"""Relative to the larger side of the picture."""
_SEAM_OPACITY = 0.55
_DRAWN = ":drawn"
"""Behind the path of a solid or a hole: what is engraved there and no drawing of its own."""


def picture(job: Job) -> Picture:
    """Returns the drawing as a picture by the options."""
    return themed(_sheet(job) if job.options.sheet is not None else _whole(job), job.options.theme)


def _whole(job: Job) -> Picture:
    options = job.options
    box = _picture_box(job.model, job.drawing, options.show)
    size = max(box[2] - box[0], box[3] - box[1]) or 1.0
    seen, dimensions = box, tuple[Group, ...]()
    if options.dimension:
        from aidl_lang.export.dimensioning import dimensioned

        seen, dimensions = dimensioned(job.model, job.drawing, box)
    overlay = explain(job.model, job.drawing, options.show, seen, size)
    groups = [*_drawn(job, size)]
    groups += dimensions
    groups += [
        Group(f"show-{name}", tuple(layer), {"class": "overlay"}) for name, layer in overlay.layers.items()
    ]
    # Pages have margins of their own.
    margin = max(
        0.0 if options.tile else MARGIN * size, 0.0 if options.for_cutter else _overhang(job.drawing)
    )
    return Picture(_grown(overlay.box, margin), tuple(groups))


def _drawn(job: Job, size: float) -> Iterator[Group]:
    """Yields the groups of the drawing: for a cutter what it follows, else one for each structure."""
    if job.options.followed is not None:
        from aidl_lang.export.sheets import followed_groups

        return followed_groups(job.model, job.drawing, job.options.followed)
    return _groups(job.model, job.drawing, _marks(job.model.root, job.drawing, size))


def _overhang(drawing: Drawing) -> float:
    """Returns how far the widest line of a stated width reaches beyond its middle."""
    styles = [*(body.style for body in drawing.bodies), *(stroke.style for stroke in drawing.strokes)]
    return max((style.width / 2 for style in styles if style.width is not None), default=0.0)


def pages(job: Job) -> list[Picture]:
    """Returns the picture, over as many pages as the options ask for."""
    whole, options = picture(job), job.options
    if options.tile is None:
        return [whole]
    from aidl_lang.export.tiles import tiled

    return tiled(whole, options.tile, overlap=options.overlap)


def _sheet(job: Job) -> Picture:
    """Returns the picture of a sheet with parts laid on it."""
    groups = [*_drawn(job, 1.0)]
    if texts := tuple(labels(job)):
        groups.append(Group("show-labels", texts, {"class": "overlay"}))
    return Picture(job.drawing.box, tuple(groups))


def _picture_box(model: SolvedModel, drawing: Drawing, show: frozenset[str]) -> Bounds:
    """Returns the box that must be in sight. The box of the root stands in for a drawing without curves."""
    boxes = []
    if drawing.bodies or drawing.strokes:
        boxes.append(drawing.box)
    if "plan" in show:
        boxes += [plan.box for plan in drawing.plans]
    root = model.root.box
    if root is not None and (show or not boxes):
        boxes.append((root.left, root.bottom, root.right, root.top))
    return union_bounds(boxes) if boxes else (0.0, 0.0, 10.0, 10.0)


def _grown(box: Bounds, by: float) -> Bounds:
    return box[0] - by, box[1] - by, box[2] + by, box[3] + by


def _groups(model: SolvedModel, drawing: Drawing, marks: Iterable[tuple[str, Mark]]) -> Iterator[Group]:
    of = defaultdict(list)
    for path, mark in marks:
        of[path].append(mark)
    for structure in stacked(model.root):
        identity = _identity(structure, drawing)
        yield Group(structure.path, tuple(of[structure.path]), identity)
        if drawn := of.get(f"{structure.path}{_DRAWN}"):
            yield Group(f"{structure.path}{_DRAWN}", tuple(drawn), {**identity, "data-kind": "drawing"})


def _identity(structure: SolvedStructure, drawing: Drawing) -> dict[str, str]:
    """Returns the attributes by which programs find a structure in the picture."""
    style = drawing.styles[structure.path]
    identity = {"data-kind": structure.kind, "data-path": structure.path}
    return identity if style.layer is None else {**identity, "data-layer": style.layer}


def _marks(root: SolvedStructure, drawing: Drawing, size: float) -> Iterator[tuple[str, Mark]]:
    """Yields all marks, with the path of the structure they belong to."""
    halos = _halos(root, drawing)
    for index, body in enumerate(drawing.bodies):
        areas = list(_areas(body, index, size))
        line = max((area.ink.width for area in areas if area.ink is not None), default=0.0)
        for area in (*halos.around_body(body, line), *areas) if halos else areas:
            yield body.path, area
    styles = {body.path: body.style for body in drawing.bodies}
    for seam in drawing.seams:
        if seam.is_asked or not styles[seam.body].is_unlined:
            yield seam.path, _seam(seam, styles[seam.body], size)
    marks = [(stroke, list(_strokes(stroke, size))) for stroke in drawing.strokes]
    if halos:  # before all lines: those of a drawing, which may join, clear none of its own
        for stroke, own in marks:
            line = max((mark.ink.width for mark in own if mark.ink is not None), default=0.0)
            for mark in halos.around_stroke(stroke, line):
                yield stroke.path, mark
    kinds = {structure.path: structure.kind for structure in root.walk()}
    for stroke, own in marks:
        is_on_part = stroke.role == "drawing" and kinds[stroke.path] != "drawing" and not stroke.is_area
        for mark in own:
            yield f"{stroke.path}{_DRAWN}" if is_on_part else stroke.path, mark


def _halos(root: SolvedStructure, drawing: Drawing) -> Halos | None:
    """Returns the gaps around what lies in front; None where none are asked for, as in most drawings."""
    if not any(style.halo for style in drawing.styles.values()):
        return None
    from aidl_lang.export.svg import Halos

    return Halos(drawing, root)


def _areas(body: Body, index: int, size: float) -> Iterator[Area]:
    return _filled(body.region, body.style, body.style.color or themes.body_fill(index), size)


def _filled(region: Region, style: Style, fill: str, size: float) -> Iterator[Area]:
    """Yields the faces of a region with their outlines."""
    ink = None if style.is_unlined else _line(style, _outline_color(style), OUTLINE_WIDTH, size)
    gradient = None if style.shade is None else gradient_of(style.shade, fill, region)
    for face in region.faces:
        yield Area(face, fill, ink, opacity=_opacity(style), gradient=gradient)


def _outline_color(style: Style) -> str:
    return themes.OUTLINE if style.color is None else themes.outline_of(style.color)


def _seam(seam: Seam, style: Style, size: float) -> Curves:
    ink = Ink(_outline_color(style), SEAM_WIDTH * size, opacity=1.0 if seam.is_asked else _SEAM_OPACITY)
    return Curves(seam.pieces, ink, "seam")


def _strokes(stroke: Stroke, size: float) -> Iterator[Area | Curves]:
    style = stroke.style
    if stroke.role != "drawing":
        ink = Ink(themes.LOOSE, STROKE_WIDTH * size, (DASH * size, GAP * size), is_round=True)
        yield Curves(stroke.pieces, ink, stroke.role)
        return
    color = style.color or themes.OUTLINE
    if stroke.over is not None:
        color = themes.contrasting(stroke.over) if stroke.faces else themes.etched(stroke.over)
    if stroke.is_area:
        yield from _filled(Region(stroke.faces), style, color, size)
        return
    if stroke.faces:
        yield from (Area(face, color, None, LETTERS, _opacity(style)) for face in stroke.faces)
        return
    ink = replace(_line(style, color, STROKE_WIDTH, size), opacity=_opacity(style))
    yield Curves(stroke.pieces, ink)


def _line(style: Style, color: str, width: float, size: float) -> Ink:
    """Returns the ink of lines of a style; their width relative to a size where the style has none."""
    stated, dash = style.width, style.dashes(size)
    # Round ends would make dashes longer than stated.
    return Ink(color, width * size if stated is None else stated, dash, is_round=dash is None)


def _opacity(style: Style) -> float:
    return 1.0 if style.opacity is None else style.opacity
