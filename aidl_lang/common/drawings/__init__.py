"""Drawings of other programs: the outlines in an SVG or a DXF file, under names, in millimetres with y up."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property, lru_cache
from pathlib import PurePosixPath
from typing import TypeAlias

from fontTools.misc.transform import Transform

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.font_files import Curve, Vec
from aidl_lang.common.names import fold
from aidl_lang.common.prose import counted, listed
from aidl_lang.common.records import record
from aidl_lang.common.world import WHOLE

# --- The curves of a drawing file: lines and cubic Bézier curves by their points, and arcs of ellipses, of
# which circles are a kind. An affine map of each is one of the same sort, exactly.


@record(slots=True)
class Bow:
    """An arc of an ellipse: the points center + u cos t + v sin t, for t from `first` to `first + sweep`.

    u, v  any two conjugate half-diameters: an affine map of the arc maps them
    start, end  are stored, so that curves that follow one another share them to the last digit
    """

    center: Vec
    u: Vec
    v: Vec
    first: float
    sweep: float
    start: Vec
    end: Vec

    @property
    def is_whole(self) -> bool:
        return abs(self.sweep) >= math.tau

    def at(self, t: float) -> Vec:
        """Returns the point at a parameter."""
        c, s = math.cos(t), math.sin(t)
        x = self.center[0] + self.u[0] * c + self.v[0] * s
        return x, self.center[1] + self.u[1] * c + self.v[1] * s

    def heading(self, t: float) -> Vec:
        """Returns the derivative at a parameter."""
        c, s = math.cos(t), math.sin(t)
        return self.v[0] * c - self.u[0] * s, self.v[1] * c - self.u[1] * s


Stroke: TypeAlias = Curve | Bow


def bow(center: Vec, u: Vec, v: Vec, first: float = 0.0, sweep: float = math.tau) -> Bow:
    """Returns an arc by two conjugate half-diameters; a whole ellipse unless said."""
    made = Bow(center, u, v, first, sweep, center, center)
    start = made.at(first)
    return replace(made, start=start, end=start if made.is_whole else made.at(first + sweep))


def mapped(stroke: Stroke, matrix: Transform) -> Stroke:
    """Returns the image of a stroke."""
    if not isinstance(stroke, Bow):
        return tuple(matrix.transformPoints(stroke))
    center, start, end = matrix.transformPoints((stroke.center, stroke.start, stroke.end))
    u, v = matrix.transformVectors((stroke.u, stroke.v))
    return Bow(center, u, v, stroke.first, stroke.sweep, start, end)


def ends(stroke: Stroke) -> tuple[Vec, Vec]:
    if isinstance(stroke, Bow):
        return stroke.start, stroke.end
    return stroke[0], stroke[-1]


def numbers(stroke: Stroke) -> Iterator[float]:
    """Yields every coordinate, to be checked."""
    if isinstance(stroke, Bow):
        stroke = stroke.start, stroke.end, stroke.u, stroke.v, stroke.center
    for p in stroke:
        yield from p


def has_length(stroke: Stroke) -> bool:
    """Tells whether a stroke is more than a single point."""
    if isinstance(stroke, Bow):
        return stroke.sweep != 0.0 and math.hypot(*stroke.u, *stroke.v) > 0.0
    return len(set(stroke)) > 1


# --- How far strokes reach -------------------------------------------------------------------------


def furthest(strokes: Iterable[Stroke], way: Vec) -> float:
    """Returns the greatest product of a point of the strokes with a vector."""
    return max(_furthest(stroke, way) for stroke in strokes)


def box(strokes: Iterable[Stroke]) -> tuple[float, float, float, float]:
    """Returns left, bottom, right and top of the strokes, tight."""
    strokes = tuple(strokes)
    left, bottom = (-furthest(strokes, way) for way in ((-1.0, 0.0), (0.0, -1.0)))
    right, top = (furthest(strokes, way) for way in ((1.0, 0.0), (0.0, 1.0)))
    return left, bottom, right, top


def _furthest(stroke: Stroke, way: Vec) -> float:
    def along(p: Vec) -> float:
        return p[0] * way[0] + p[1] * way[1]

    best = max(map(along, ends(stroke)))
    if isinstance(stroke, Bow):
        across, up = along(stroke.u), along(stroke.v)
        ahead = (math.atan2(up, across) - stroke.first) * math.copysign(1.0, stroke.sweep) % math.tau
        if ahead <= abs(stroke.sweep):  # it passes there
            best = max(best, along(stroke.center) + math.hypot(across, up))
        return best
    if len(stroke) < 4:
        return best
    a, b, c, d = map(along, stroke)
    for t in _turning_points(a, b, c, d):
        s = 1.0 - t
        best = max(best, s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d)
    return best


def _turning_points(a: float, b: float, c: float, d: float) -> Iterator[float]:
    """Yields where the derivative of a cubic Bézier function is 0, between its ends."""
    p, q, r = d - 3 * c + 3 * b - a, 2 * (c - 2 * b + a), b - a
    if p == 0.0:
        roots = [-r / q] if q else []
    else:
        inside = q * q - 4 * p * r
        if inside < 0.0:
            return
        # The sum that does not cancel gives one root, and the product of both the other.
        half = -0.5 * (q + math.copysign(math.sqrt(inside), q))
        roots = [half / p, *([r / half] if half else [])]
    yield from (t for t in roots if 0.0 < t < 1.0)


# --- In cubics -------------------------------------------------------------------------------------

_FINE = math.tau / 24
"""Turn of an arc that a cubic follows to 6e-9 of its radius."""


def as_curves(stroke: Stroke) -> tuple[Curve, ...]:
    """Returns a stroke in lines and cubics, which follow an arc to 6e-9 of its size."""
    if not isinstance(stroke, Bow):
        return (stroke,)
    count = max(1, math.ceil(abs(stroke.sweep) / _FINE))
    step = stroke.sweep / count
    handle = 4 / 3 * math.tan(step / 4)
    found: list[Curve] = []
    for k in range(count):
        first, last = stroke.first + k * step, stroke.first + (k + 1) * step
        start, end = stroke.at(first), stroke.at(last)
        (dx, dy), (ex, ey) = stroke.heading(first), stroke.heading(last)
        one = start[0] + dx * handle, start[1] + dy * handle
        two = end[0] - ex * handle, end[1] - ey * handle
        found.append((start, one, two, end))
    return tuple(found)


# --- A drawing that was read: its outlines and their names.

MOST_CURVES = 30_000
MOST_NUMBERS = 7 * MOST_CURVES
"""Numbers in the outlines of a file: no curve takes more."""
FURTHEST = 1e8
"""Millimetres from the origin beyond which nothing is read: a hundred kilometres."""


_DIGITS = re.compile(r"\d+\.?\d*")


class DrawingError(Exception):
    """Raised for a file that cannot be read as a drawing: a diagnostic's code, message and hints."""

    def __init__(self, code: str, message: str, *hints: str) -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hints = hints


@record()
class Engraving:
    """What files of AIDL say of an outline that is engraved and not cut: its layer and its colour, where it
    has them, and whether it is the border of an area.
    """

    layer: str | None = None
    color: str | None = None
    is_area: bool = False


@record(eq=False)
class Element:
    """One outline of a file, or some that belong together, contour by contour.

    names    those by which the file calls it, from the outermost group to its own
    is_winding  what it encloses goes by the non-zero rule; otherwise nested contours alternate
    engraving   None for what bounds material, as far as the file says
    """

    names: tuple[str, ...]
    strokes: tuple[Stroke, ...]
    is_winding: bool = False
    engraving: Engraving | None = None


@record(eq=False)
class Trace:
    """The outlines of a drawing, or of a part of it, as one thing that moves and turns as a whole.

    name  that of the part, for messages
    """

    name: str
    elements: tuple[Element, ...]

    @cached_property
    def strokes(self) -> tuple[Stroke, ...]:
        return tuple(stroke for element in self.elements for stroke in element.strokes)

    @cached_property
    def box(self) -> tuple[float, float, float, float]:
        return box(self.strokes)

    def furthest(self, way: Vec) -> float:
        """Returns the greatest product of a point of it with a vector."""
        return furthest(self.strokes, way)

    @cached_property
    def silhouette(self) -> tuple[Curve, ...]:
        """The corners and curves of which some point is the furthest in every direction."""
        from aidl_lang.common.lettering import silhouette

        return silhouette([curve for stroke in self.strokes for curve in as_curves(stroke)])


@record(eq=False)
class OutlineFile:
    """A drawing file that was read.

    parts  what can be named in it: name in AIDL → outlines
    """

    whole: Trace
    parts: Mapping[str, Trace]
    remarks: tuple[Diagnostic, ...] = ()

    def trace(self, name: str) -> Trace:
        """Returns the outlines under a name."""
        return self.whole if name == WHOLE else self.parts[name]


@record(frozen=False)
class Collector:
    """The elements read so far, counted and checked.

    left_out  what was not read: how it is called → how many there were
    """

    what: str
    elements: list[Element] = field(default_factory=list)
    left_out: Counter[str] = field(default_factory=Counter)
    curves: int = 0
    numbers: int = 0

    def add(
        self,
        names: Sequence[str],
        strokes: Iterable[Stroke],
        *,
        is_winding: bool = False,
        engraving: Engraving | None = None,
    ) -> None:
        """Adds an element. Raises DrawingError for one that has no place on a plane, or one too many."""
        found = tuple(strokes)
        kept = tuple(stroke for stroke in found if has_length(stroke))
        self.curves += len(kept)
        self.check()
        for number in (n for stroke in found for n in numbers(stroke)):
            if not math.isfinite(number) or abs(number) > FURTHEST:
                named = f" in `{names[-1]}`" if names else ""
                message = f"`{self.what}` reaches further than {FURTHEST / 1e6:g} km from its origin{named}"
                hint = "look whether a coordinate or a transform in it is what was meant"
                raise DrawingError("E0364", message, hint)
        if kept:
            self.elements.append(Element(tuple(names), kept, is_winding, engraving))

    def count_numbers(self, text: str) -> None:
        """Counts the numbers of an attribute before it is read. Raises DrawingError."""
        self.numbers += sum(1 for _ in _DIGITS.finditer(text))
        self.check()

    def check(self) -> None:
        if self.curves > MOST_CURVES or self.numbers > MOST_NUMBERS:
            hint = "simplify it in the program that drew it, or export fewer of its layers"
            raise DrawingError("E0363", f"`{self.what}` has more than {MOST_CURVES:,} curves", hint)


# --- Reading of a drawing file, by the suffix of its name, and the names in it made names of AIDL.


MOST_NAMES = 250
_LONGEST_NAME = 60
_TAKEN = frozenset(
    fold(word)
    for word in (
        f"{WHOLE} art start center unit scale width height angle filled rotatable bb edge origin rotation "
        "self x_axis y_axis fillet chamfer left right top bottom center_x center_y top_left top_right "
        "bottom_left bottom_right top_center bottom_center left_center right_center "
        "alias and assert at constrain constraint construction else false fn for if import in let not or "
        "param prefer rotated shape step template todo true var weight fixed guess turned traced traced_part"
    ).split()
)
"""Names that mean something else in or about a drawing, and words that begin statements."""


@lru_cache(maxsize=8)
def outlines(path: str, data: bytes) -> OutlineFile:
    """Returns what is in a drawing file. Raises DrawingError."""
    name = PurePosixPath(path).name
    # Loaded when a program imports one: others need no reader.
    if path.lower().endswith(".svg"):
        from aidl_lang.common.drawings import svg

        found, remarks = svg.read(data, name)
    else:
        from aidl_lang.common.drawings import dxf

        found, remarks = dxf.read(data, name)
    if not found.elements:
        raise DrawingError("E0365", f"`{name}` has no outlines", *_left_out(found))
    elements = tuple(found.elements)
    parts, more = _parts(elements, "layer" if path.lower().endswith(".dxf") else "id")
    return OutlineFile(Trace(WHOLE, elements), parts, (*remarks, *_told(found, more)))


_PLURALS = {"hatch": "hatches", "mesh": "meshes", "hidden entity": "hidden entities"}


def _left_out(found: Collector) -> Iterator[str]:
    if found.left_out:
        counts = [counted(count, kind, _PLURALS.get(kind, "")) for kind, count in found.left_out.items()]
        yield f"left out: {listed(counts)}"


def _told(found: Collector, more: int) -> Iterator[Diagnostic]:
    for text in _left_out(found):
        message = f"`{found.what}` has more than outlines; {text}"
        hint = "only outlines are imported; in the program that drew it texts can be turned into paths"
        yield Diagnostic("N0751", message, hints=(hint,))
    if more:
        message = f"`{found.what}` has {more} names beyond the first {MOST_NAMES}, which cannot be used"
        hint = "give names to the groups or layers that are needed, and leave the rest without"
        yield Diagnostic("N0751", message, hints=(hint,))


def _parts(elements: Iterable[Element], kind: str) -> tuple[dict[str, Trace], int]:
    """Returns what each name stands for, and how many names were too many. Equal names are one part."""
    members: dict[str, list[Element]] = {}
    for element in elements:
        for name in dict.fromkeys(element.names):
            members.setdefault(name, []).append(element)
    parts: dict[str, Trace] = {}
    taken = set(_TAKEN)
    for written, of in members.items():
        if len(parts) == MOST_NAMES:
            return parts, len(members) - MOST_NAMES
        name = re.sub(r"\W+", "_", written[:_LONGEST_NAME]).strip("_") or kind
        if name[0].isdigit() or not name[0].isidentifier():
            name = f"{kind}_{name}"
        if any(fold(name) == fold(known) and part.elements == tuple(of) for known, part in parts.items()):
            continue  # the label of a group and its id
        name = _free(name, taken)
        taken.add(fold(name))
        parts[name] = Trace(name, tuple(of))
    return parts, 0


def _free(name: str, taken: set[str]) -> str:
    """Returns a name that means nothing else yet, not even when it is spelled otherwise."""
    if fold(name) not in taken:
        return name
    candidates = (f"{name}_part", *(f"{name}_{k}" for k in range(2, MOST_NAMES + 3)))
    return next(c for c in candidates if fold(c) not in taken)
