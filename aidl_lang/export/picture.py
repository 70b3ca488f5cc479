"""Turns a drawing into a picture: what is filled, outlined and written, in which ink, on how many pages."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from aidl_lang.common.colors import css_color, hexadecimal, rgb
from aidl_lang.common.prose import fixed, size_text
from aidl_lang.common.running import checkpoint
from aidl_lang.export import marks
from aidl_lang.export.job import ExportError, Job
from aidl_lang.export.marks import Area, Curves, Gradient, Group, Ink, Mark, Picture, Text, corners, widened
from aidl_lang.export.overlay import explain, labels
from aidl_lang.geometry.boolean import united, without
from aidl_lang.geometry.curves import Bounds, Line, Piece, Vec, larger_side, union_bounds
from aidl_lang.geometry.drawing import Body, Drawing, Stroke
from aidl_lang.geometry.intersect import inside
from aidl_lang.geometry.region import Polygon, Region, piece_points
from aidl_lang.geometry.solved import SolvedModel, SolvedStructure
from aidl_lang.geometry.styles import DASH, GAP, Shade, Style, layers, stacked, united_parts

# --- Splits pictures larger than the paper into several pages, printed 1:1 and joined afterwards.
#
# Pages overlap. Crosses in the middle of the overlaps lie on both pages, so that they can be laid over each
# other; a scale of 50 mm tells whether the printer kept the size. Pages on which nothing is drawn are left
# out.

PAGE_MARGIN = 10.0
"""Millimetres along each edge of a page: printers leave about 5 blank, the rest holds labels."""
OVERLAP = 10.0
MOST_PAGES = 500
SMALLEST_PAGE = 100.0
"""Narrower pages have no room for the scale and the label."""
SCALE = 50.0
HAIRLINE, FONT = 0.1, 2.8
ARM, TICK = 3.0, 2.5
"""Half of a cross at most, and the length of the marks at the corners of the window, mm."""
BLEED = 1.0
"""Distance by which drawings run over the edge of the window, so that no line there is halved, mm."""
DEVIATION = 0.05
"""Accuracy of the polylines that tell which pages a curve touches, mm."""

Size = tuple[float, float]


def _windows(low: float, high: float, window: float, overlap: float) -> tuple[int, Iterator[float]]:
    """Returns the number of the fewest windows that cover a range, centred on it, and where they begin."""
    step = window - overlap
    count = max(1, math.ceil((high - low - overlap) / step - 1e-9))
    first = (low + high - (count - 1) * step - window) / 2
    return count, (first + k * step for k in range(count))


def tiled(picture: Picture, page: Size, overlap: float = OVERLAP) -> list[Picture]:
    """Returns the pages on which something is drawn, in reading order; the box of each is that of the paper.

    Raises ExportError if the page is too small, or too many would be needed.
    """
    window = page[0] - 2 * PAGE_MARGIN, page[1] - 2 * PAGE_MARGIN
    _check(page, window, overlap)
    left, bottom, right, top = picture.box
    columns, lefts = _windows(left, right, window[0], overlap)
    rows, tops = _windows(-top, -bottom, window[1], overlap)  # rows count from the top
    if columns * rows > MOST_PAGES:
        message = f"{columns * rows} pages are more than {MOST_PAGES}"
        raise ExportError("E0924", message, "give a larger `--tile`")
    xs, ys, half, shares = [*lefts], [*tops], overlap / 2, (0.25, 0.75)
    crosses = [(x + half, -(y + window[1] * share)) for x in xs[1:] for y in ys for share in shares]
    crosses += [(x + window[0] * share, -(y + half)) for x in xs for share in shares for y in ys[1:]]
    shapes = [[(mark, _Shape(mark)) for mark in group.marks] for group in picture.groups]
    found = []
    for row, column in np.ndindex(rows, columns):
        checkpoint()
        x, y = xs[column], -ys[row]
        sight = (x, y - window[1], x + window[0], y)
        groups = [
            replace(group, marks=shown, clip=widened(sight, BLEED))
            for group, held in zip(picture.groups, shapes, strict=True)
            if (shown := tuple(mark for mark, shape in held if shape.meets(sight)))
        ]
        if groups or columns * rows == 1:
            found.append((sight, groups, f"row {row + 1}, column {column + 1}"))
    made = []
    for k, (sight, groups, place) in enumerate(found, 1):
        added = _page_marks(sight, crosses, overlap, f"{k}/{len(found)}: {place}")
        made.append(Picture(widened(sight, PAGE_MARGIN), (*groups, Group("page-marks", tuple(added)))))
    return made


def _check(page: Size, window: Size, overlap: float) -> None:
    if min(page) < SMALLEST_PAGE:
        message = f"a page of {size_text(page)} is too small for tiles"
        raise ExportError("E0924", message, f"each side must have {fixed(SMALLEST_PAGE)} mm at least")
    if overlap > min(window) / 2:
        raise ExportError(
            "E0924",
            f"an overlap of {fixed(overlap)} mm is more than half of what a page of {size_text(page)} shows",
            "give a smaller `--overlap` or a larger `--tile`",
        )


def _page_marks(sight: Bounds, crosses: Sequence[Vec], overlap: float, label: str) -> Iterator[Mark]:
    left, bottom, right, top = sight
    ink = Ink(marks.PLAN, HAIRLINE)
    ticks: list[Piece] = []
    for x, out in ((left, -1.0), (right, 1.0)):
        for y, up in ((bottom, -1.0), (top, 1.0)):
            ticks.append(Line((x + out * BLEED, y), (x + out * (BLEED + TICK), y)))
            ticks.append(Line((x, y + up * BLEED), (x, y + up * (BLEED + TICK))))
    yield Curves(tuple(ticks), ink, "crop")
    arm = min(ARM, 0.4 * overlap)
    for x, y in crosses:
        if arm and left <= x - arm and x + arm <= right and bottom <= y - arm and y + arm <= top:
            lines = Line((x - arm, y), (x + arm, y)), Line((x, y - arm), (x, y + arm))
            yield Curves(lines, ink, "registration")
    start, low = left + 2 * TICK, bottom - 2.5
    ends = (Line((x, low - 1), (x, low + 1)) for x in (start, start + SCALE))
    yield Curves((Line((start, low), (start + SCALE, low)), *ends), ink, "scale")
    yield Text((start + SCALE + 1, low - 1), f"{fixed(SCALE)} mm", FONT, marks.PLAN, halo=False)
    yield Text((start, top + 1.5), label, FONT, marks.PLAN, halo=False)


class _Shape:
    """The area of a mark, accurate enough to tell whether a page shows any of it."""

    def __init__(self, mark: Mark) -> None:
        self._lines: list[Polygon] = []
        self._filled: list[Polygon] = []
        air = 0.0
        match mark:
            case Area():
                polygons = mark.face.polygons(DEVIATION)
                self._lines = [np.concatenate((p, p[:1])) for p in polygons]
                self._filled = polygons if mark.fill else []
                air = mark.ink.width / 2 if mark.ink else 0.0
            case Curves():
                self._lines = [piece_points(piece, DEVIATION) for piece in mark.pieces]
                air = mark.ink.width / 2
            case marks.Frame():
                self._lines = [_outline(mark.box)]
                air = mark.width / 2
            case Text():
                self._lines = [_outline(mark.box)]
                self._filled = self._lines
            case marks.Dot(at, radius):
                self._lines = [np.array([at, at])]
                air = radius
        self._air = air + DEVIATION
        spots = np.concatenate(self._lines)
        self._low, self._high = spots.min(axis=0) - self._air, spots.max(axis=0) + self._air

    def meets(self, sight: Bounds) -> bool:
        """True if any of it lies in a window."""
        low, high = np.array(sight[:2]), np.array(sight[2:])
        if (self._low > high).any() or (self._high < low).any():
            return False
        if any(_reaches(line, low - self._air, high + self._air) for line in self._lines):
            return True
        middle = (low + high)[None] / 2  # no outline in sight: all of the window is inside, or nothing is
        return sum(int(inside([polygon], middle)[0]) for polygon in self._filled) % 2 == 1


def _reaches(line: Polygon, low: Polygon, high: Polygon) -> bool:
    """True if a polyline has points in a box: each side is clipped to the box along both axes."""
    start, way = line[:-1], np.diff(line, axis=0)
    level = way == 0
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (low - start) / way, (high - start) / way
    within = (low <= start) & (start <= high)
    enter = np.where(level, np.where(within, -np.inf, np.inf), np.minimum(first, second)).max(axis=1)
    leave = np.where(level, np.where(within, np.inf, -np.inf), np.maximum(first, second)).min(axis=1)
    return bool((np.maximum(enter, 0.0) <= np.minimum(leave, 1.0)).any())


def _outline(box: Bounds) -> Polygon:
    return np.array([*corners(box), box[:2]])


# One group for each structure from back to front: later siblings lie over earlier ones, unless they say
# otherwise; what explains the picture lies above them all.

MARGIN = 0.03
OUTLINE_WIDTH, SEAM_WIDTH, STROKE_WIDTH = 0.0025, 0.001, 0.003
"""Relative to the larger side of the picture."""
_SEAM_OPACITY = 0.55
_DARK = 0.3
"""The share of black in a shadow for which none is stated."""
_DRAWN = ":drawn"
_OVER = ":over"
"""Behind the path of a solid or a hole: what is engraved there and no drawing of its own."""


def picture(job: Job) -> Picture:
    """Returns the drawing as a picture by the options."""
    return marks.themed(_whole(job) if job.options.sheet is None else _sheet(job), job.options.theme)


def _sheet(job: Job) -> Picture:
    texts = tuple(labels(job))
    groups = [Group("show-labels", texts, {"class": "overlay"})] if texts else []
    return Picture(job.drawing.box, (*_drawn(job, 1.0), *groups))


def _whole(job: Job) -> Picture:
    options = job.options
    shadows = [] if options.for_cutter else list(_shadows(job.model.root, job.drawing))
    box = _picture_box(job.model, job.drawing, options.show)
    box = union_bounds([box, *(Region((area.face,)).box for _, area in shadows)])
    size = larger_side(box) or 1.0
    seen, dimensions = box, tuple[Group, ...]()
    if options.dimension:
        from aidl_lang.export.dimensioning import dimensioned

        seen, dimensions = dimensioned(job.model, job.drawing, box)
    shown, layers = explain(job.model, job.drawing, options.show, seen, size)
    groups = [*_drawn(job, size, shadows)]
    groups += dimensions
    groups += [Group(f"show-{name}", tuple(layer), {"class": "overlay"}) for name, layer in layers.items()]
    # Pages have margins of their own.
    margin = max(
        0.0 if options.tile else MARGIN * size, 0.0 if options.for_cutter else _overhang(job.drawing)
    )
    return Picture(widened(shown, margin), tuple(groups))


def _drawn(job: Job, size: float, shadows: Iterable[tuple[str, Area]] = ()) -> Iterator[Group]:
    """Yields the groups of the drawing: for a cutter what it follows, else one for each structure."""
    if job.options.followed is not None:
        from aidl_lang.export.cuts import followed_groups

        return followed_groups(job.model, job.drawing, job.options.followed)
    return _groups(job.model, job.drawing, [*shadows, *_marks(job.model.root, job.drawing, size)])


def _overhang(drawing: Drawing) -> float:
    """Returns how far the widest line of a stated width reaches beyond its middle."""
    styles = [*(body.style for body in drawing.bodies), *(stroke.style for stroke in drawing.strokes)]
    return max((style.width / 2 for style in styles if style.width is not None), default=0.0)


def pages(job: Job) -> list[Picture]:
    """Returns the picture, over as many pages as the options ask for."""
    whole, options = picture(job), job.options
    if options.tile is None:
        return [whole]
    return tiled(whole, options.tile, overlap=options.overlap)


def _picture_box(model: SolvedModel, drawing: Drawing, show: frozenset[str]) -> Bounds:
    """Returns the box that must be in sight. The box of the root stands in for a drawing without curves."""
    boxes = []
    if drawing.bodies or drawing.strokes:
        boxes.append(drawing.box)
    if "plan" in show:
        boxes += [plan.box for plan in drawing.plans]
    root = model.root.box
    if root is not None and (show or not boxes):
        boxes.append(root.bounds)
    return union_bounds(boxes) if boxes else (0.0, 0.0, 10.0, 10.0)


def _groups(model: SolvedModel, drawing: Drawing, marks: Iterable[tuple[str, Mark]]) -> Iterator[Group]:
    of = defaultdict(list)
    for path, mark in marks:
        of[path].append(mark)
    last = ""
    for structure, laid, is_over in layers(model.root):
        identity = _identity(structure, drawing)
        if not is_over:
            yield Group(last := structure.path, tuple(of[last]), identity)
            if drawn := of.get(f"{last}{_DRAWN}"):
                yield Group(f"{last}{_DRAWN}", tuple(drawn), {**identity, "data-kind": "drawing"})
        elif over := [mark for g in laid for mark in of.get(g.path, ())]:
            yield Group(last := f"{last}{_OVER}", tuple(over), identity)


def _identity(structure: SolvedStructure, drawing: Drawing) -> dict[str, str]:
    """Returns the attributes by which programs find a structure in the picture."""
    style = drawing.styles[structure.path]
    identity = {"data-kind": structure.kind, "data-path": structure.path}
    return identity if style.layer is None else {**identity, "data-layer": style.layer}


def _marks(root: SolvedStructure, drawing: Drawing, size: float) -> Iterator[tuple[str, Mark]]:
    halos = Halos(drawing, root) if any(style.halo for style in drawing.styles.values()) else None
    fills = _fills(root, drawing)
    for body in drawing.bodies:
        areas = list(_filled(body.region, body.style, fills[body.path], size))
        line = max((area.ink.width for area in areas if area.ink is not None), default=0.0)
        for area in (*halos.around_body(body, line), *areas) if halos else areas:
            yield body.path, area
    styles = {body.path: body.style for body in drawing.bodies}
    for seam in drawing.seams:
        if seam.is_asked or not styles[seam.body].is_unlined:
            ink = Ink(_outline_color(styles[seam.body]), SEAM_WIDTH * size)
            ink = ink if seam.is_asked else replace(ink, opacity=_SEAM_OPACITY)
            yield seam.path, Curves(seam.pieces, ink, "seam")
    inked = [(stroke, list(_strokes(stroke, size, fills))) for stroke in drawing.strokes]
    if halos:  # before all lines: those of a drawing, which may join, clear none of its own
        for stroke, own in inked:
            line = max((mark.ink.width for mark in own if mark.ink is not None), default=0.0)
            for mark in halos.around_stroke(stroke, line):
                yield stroke.path, mark
    kinds = {structure.path: structure.kind for structure in root.walk()}
    raised = {g.path for _, laid, is_over in layers(root) if is_over for g in laid}
    for stroke, own in inked:
        path = stroke.path
        if stroke.is_area:
            path = stroke.geometry if stroke.geometry in raised else path
        elif stroke.role == "drawing" and kinds[path] != "drawing":
            path = f"{path}{_DRAWN}"
        yield from ((path, mark) for mark in own)


def _fills(root: SolvedStructure, drawing: Drawing) -> dict[str, str]:
    """Returns the colours of bodies, and of the solids that are united with them, by their paths."""
    structures = {s.path: s for s in root.walk()}
    colors = [(b.path, b.style.color or marks.body_fill(k)) for k, b in enumerate(drawing.bodies)]
    return {part.path: color for path, color in colors for part in united_parts(structures[path])}


def _shadows(root: SolvedStructure, drawing: Drawing) -> Iterator[tuple[str, Area]]:
    """Yields what structures cast on what lies behind them: all their bodies as one, moved."""
    for structure in root.walk():
        if shadow := drawing.styles[structure.path].shadow:
            paths = {below.path for below in structure.walk()}
            cast = united(*(b.region for b in drawing.bodies if b.path in paths and not b.style.is_clear))
            x, y, dark = (*shadow, _DARK)[:3]
            for face in cast.mapped(marks.Placing(1.0, (x, y)).piece).faces:
                yield structure.path, Area(face, "black", None, marks.SHADOW, dark)


def _filled(
    region: Region, style: Style, fill: str, size: float, role: str = "", whole: Sequence[Piece] = ()
) -> Iterator[Area]:
    """Yields the faces of a region with their outlines; `whole`: what shade runs over, if some is hidden."""
    ink = None if style.is_unlined else _line(style, _outline_color(style), OUTLINE_WIDTH, size)
    gradient = None if style.shade is None else gradient_of(style.shade, fill, whole or region.pieces)
    for face in region.faces:
        yield Area(face, fill, ink, role, _opacity(style), gradient)


def _outline_color(style: Style) -> str:
    return marks.OUTLINE if style.color is None else marks.outline_of(style.color)


def _strokes(stroke: Stroke, size: float, fills: Mapping[str, str]) -> Iterator[Area | Curves]:
    style = stroke.style
    if stroke.role != "drawing":
        ink = Ink(marks.LOOSE, STROKE_WIDTH * size, (DASH * size, GAP * size), is_round=True)
        yield Curves(stroke.pieces, ink, stroke.role)
        return
    color = style.color or marks.OUTLINE
    if stroke.over is not None:
        color = marks.contrasting(stroke.over, style.color) if stroke.faces else marks.etched(stroke.over)
    if stroke.is_area:
        color = style.color or fills.get(stroke.path, color)
        yield from _filled(Region(stroke.faces), style, color, size, marks.AREA, stroke.whole)
        return
    if stroke.faces:
        yield from (Area(face, color, None, marks.LETTERS, _opacity(style)) for face in stroke.faces)
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


# --- Clear gaps around what lies in front (`@halo`): the colour of the paper, over all that is behind.


class Halos:
    """The gaps of a drawing; only what lies near something further back has one."""

    def __init__(self, drawing: Drawing, root: SolvedStructure) -> None:
        self._place = {s.path: place for place, s in enumerate(stacked(root))}
        boxes = [(self._place[b.path], b.box) for b in drawing.bodies]
        self._boxes = boxes + [(self._place[s.path], _box(s)) for s in drawing.strokes]

    def around_body(self, body: Body, line: float) -> Iterator[Area]:
        """Yields the gap around a body whose outline has a width."""
        width = body.style.halo or 0.0
        if width > 0 and self._covers(body.path, body.box, by := width + line / 2):
            from aidl_lang.geometry.offsets import offset

            wide = offset(body.region, by, sharp=False)
            if body.style.is_clear:
                wide = without(wide, body.region)
            yield from (Area(face, marks.PAPER, None, marks.HALO) for face in wide.faces)

    def around_stroke(self, stroke: Stroke, line: float) -> Iterator[Area | Curves]:
        """Yields the gap around curves drawn as lines of a width; letters that are filled have lines of 0."""
        width = stroke.style.halo or 0.0
        if width > 0 and self._covers(stroke.path, _box(stroke), width + line / 2):
            ink = Ink(marks.PAPER, line + 2 * width, is_round=True)
            yield Curves(stroke.pieces, ink, marks.HALO)

    def _covers(self, path: str, box: Bounds, by: float) -> bool:
        """Tells whether the box of something, widened, meets that of something behind it."""
        left, bottom, right, top = box[0] - by, box[1] - by, box[2] + by, box[3] + by
        return any(
            place < self._place[path] and b[0] < right and left < b[2] and b[1] < top and bottom < b[3]
            for place, b in self._boxes
        )


def _box(stroke: Stroke) -> Bounds:
    return union_bounds([piece.box for piece in stroke.pieces])


# --- Gradients of fills: light and shade on round things, and fills that go over into another colour.

_LIGHT: dict[str, tuple[tuple[float, float], ...]] = {
    "round": ((0, -0.26), (0.16, 0.2), (0.26, 0.34), (0.38, 0.22), (0.6, -0.06), (0.9, -0.44), (1, -0.36)),
    "ball": ((0.0, 0.5), (0.5, 0.0), (1.0, -0.45)),
    "slope": ((0.0, 0.18), (1.0, -0.26)),
}
"""Shares of the way, and how much lighter the colour is there, or darker where they are negative."""
_FADING = ((0.0, 1.0), (0.3, 0.78), (0.6, 0.3), (0.8, 0.09), (1.0, 0.0))
"""Shares of the way out of the middle, and the opacity there: as soft light and shadows end."""
_SPOT = (0.36, 0.66)
"""Where a ball is brightest: shares of the width and the height of its box."""
_REACH = 0.72
"""How far light reaches from there, in the larger side of the box."""
_LIFT, _PALER = 0.6, 0.5
"""What a tone adds to a colour of its own strength, and how much white."""
_STEPS = np.linspace(0.0, 1.0, 9)


def gradient_of(shade: Shade, color: str, outline: Sequence[Piece]) -> Gradient:
    """Returns the fill of a colour in what has an outline, of which some may be hidden."""
    stops = tuple(marks.Stop(share, _toned(color, tone)) for share, tone in _LIGHT.get(shade.kind, ()))
    left, bottom, right, top = union_bounds([piece.box for piece in outline])
    width, height = right - left, top - bottom
    if shade.way is None:
        center = (left + width / 2, bottom + height / 2)
        fading = tuple(marks.Stop(share, color, opacity) for share, opacity in _FADING)
        return Gradient(center, center, fading, width / 2, height / width)
    if shade.kind == "ball":
        spot = (left + _SPOT[0] * width, bottom + _SPOT[1] * height)
        return Gradient(spot, spot, stops, _REACH * max(width, height))
    ways = np.array([math.cos(math.radians(shade.way)), math.sin(math.radians(shade.way))])
    spots = np.concatenate([piece.points(_STEPS) for piece in outline])
    along = spots @ ways
    middle = np.array([(left + right) / 2, (bottom + top) / 2])
    start, end = (middle + (reach - middle @ ways) * ways for reach in (along.min(), along.max()))
    other = css_color([shade.kind])
    if shade.kind == "fade":
        stops = (marks.Stop(0.0, color), marks.Stop(1.0, color, 0.0))
    elif other is not None:
        stops = (marks.Stop(0.0, color), marks.Stop(1.0, other))
    return Gradient((float(start[0]), float(start[1])), (float(end[0]), float(end[1])), stops)


def _toned(color: str, tone: float) -> str:
    """Returns a colour in more light, or in less if the tone is negative. Light makes it stronger before it
    makes it paler: red gleams red, and not pink.
    """
    lift = min(1 + _LIFT * tone, 255 / max(*rgb(color), 1)) if tone > 0 else 1 + tone
    parts = [lift * part for part in rgb(color)]
    return hexadecimal(part + _PALER * max(tone, 0.0) * (255 - part) for part in parts)
