"""Pictures as data: their marks and colours, and whole ones made anew: scaled, made coarse, in a theme."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import field, replace
from functools import cached_property
from typing import NamedTuple, TypeAlias

from aidl_lang.common.colors import hexadecimal, rgb
from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Bounds, Line, Piece, Vec, image
from aidl_lang.geometry.region import Face, Loop

# --- Calm colours for bodies without a colour of their own, and the ink for everything else.

FILLS = (
    "#a7bcd6",  # slate blue
    "#d9c3a0",  # sand
    "#a9c8a4",  # sage
    "#d3aaa5",  # clay
    "#b9aed0",  # lilac
    "#9cc7c5",  # teal
    "#d8cf98",  # straw
    "#bcc0c6",  # stone
)
PAPER = "#ffffff"
OUTLINE = "#2f3b4a"
LIGHT = "#b4bfcc"
LOOSE = "#c2410c"
PLAN = "#64748b"
NAME = "#1e293b"
DIMENSION = "#17375e"
POINT = "#1d4ed8"
BOX = "#94a3b8"
GOOD = "#15803d"
BAD = "#dc2626"
FREE = "#b45309"

_SHADE = 0.55
"""What is left of the brightness of a fill in its outline."""
_LIGHTEST_OUTLINE = 128
"""Brightness, of 255, up to which an outline is seen well on white paper."""
_DARK = 112
"""Brightness, of 255, up to which dark letters are hard to read."""
_READABLE = 64
"""Least difference in brightness, of 255, of letters and what they lie on."""
_DARKEST = 60
"""Brightness, of 255, up to which a darker line is hard to see."""
_TINT = 0.5
"""The share of white in lines on what is darker."""


def body_fill(index: int) -> str:
    """Returns the colour of the body drawn as number `index`."""
    return FILLS[index % len(FILLS)]


def outline_of(fill: str) -> str:
    """Returns the colour of the outline of a body that the author gave a fill: a darker tone of it, and as
    much darker again as it takes to be seen on white.
    """
    bright = _brightness(rgb(fill))
    share = min(_SHADE, _LIGHTEST_OUTLINE / bright) if bright > 0 else _SHADE
    return hexadecimal(share * part for part in rgb(fill))


def etched(fill: str) -> str:
    """Returns an ink for lines on a fill: a darker tone of it, or a lighter one of what is very dark."""
    if _brightness(rgb(fill)) > _DARKEST:
        return outline_of(fill)
    return hexadecimal(part + _TINT * (255 - part) for part in rgb(fill))


def contrasting(fill: str, own: str | None) -> str:
    """Returns an ink for letters that can be read on a fill: their own, or one for white beside it, too."""
    bright = _brightness(rgb(fill))
    if own is not None and abs(_brightness(rgb(own)) - bright) > _READABLE:
        return own
    return OUTLINE if bright > _DARK else LIGHT


def _brightness(parts: tuple[int, int, int]) -> float:
    red, green, blue = parts
    return 0.299 * red + 0.587 * green + 0.114 * blue


# --- The marks of pictures, as data: areas, curves, texts, dots and frames. Coordinates in mm, y upwards.

CHARACTER, CAPITAL = 0.6, 0.73
"""Mean width of a character of the font, and height of a capital, relative to its size."""
ANCHORS = {"start": 0.0, "middle": -0.5, "end": -1.0}
"""Where a text begins, seen from where it is anchored, relative to its width."""

HALO = "halo"
"""The role of what has the colour of the paper: a gap around what lies in front."""
SHADOW = "shadow"
LETTERS = "letters"
AREA = "area"  # of a colour of its own, on a body or in a drawing


@record()
class Ink:
    """The look of a line: a CSS colour, width in mm, dashes and gaps by turns in mm, opacity, round ends."""

    color: str
    width: float
    dash: tuple[float, ...] | None = None
    opacity: float = 1.0
    is_round: bool = False


class Stop(NamedTuple):
    """The colour and the opacity of a gradient at a share of its way, from 0 to 1."""

    share: float
    color: str
    opacity: float = 1.0


@record()
class Gradient:
    """A fill that goes from colour to colour along the way from `start` to `end`; with a `radius`, outwards
    from `start`, up and down by a share of it, its `height`.
    """

    start: Vec
    end: Vec
    stops: tuple[Stop, ...]
    radius: float | None = None
    height: float = 1.0

    @property
    def fades(self) -> bool:
        """Whether something shows through it."""
        return any(stop.opacity < 1 for stop in self.stops)


@record()
class Area:
    """A face with its holes cut out, filled, outlined, or both; `opacity` is that of the fill, which a
    `gradient` may take the place of. Readers of the SVG find `role` in it.
    """

    face: Face
    fill: str | None
    ink: Ink | None
    role: str = ""
    opacity: float = 1.0
    gradient: Gradient | None = None

    @property
    def fades(self) -> bool:
        """Whether its fill goes over into nothing."""
        return self.gradient is not None and self.gradient.fades

    @property
    def is_sign(self) -> bool:
        """True for a mark of its own, as a letter or an arrowhead; false for a solid without outline."""
        return self.ink is None and self.role not in ("", HALO, SHADOW, AREA)


def widened(box: Bounds, by: float) -> Bounds:
    """Returns a box with so much more on each side."""
    return box[0] - by, box[1] - by, box[2] + by, box[3] + by


def corners(box: Bounds) -> tuple[Vec, Vec, Vec, Vec]:
    """Returns the corners of a box, counter-clockwise from the lower left one."""
    left, bottom, right, top = box
    return (left, bottom), (right, bottom), (right, top), (left, top)


def polygon(*at: Vec) -> Face:
    """Returns the face with these corners, counter-clockwise."""
    return Face(Loop(tuple(Line(p, q) for p, q in zip(at, at[1:] + at[:1], strict=True))))


def arrowhead(tip: Vec, way: Vec, length: float, width: float) -> Face:
    """Returns an arrowhead that points along `way`, a vector of length 1."""
    (x, y), (u, v), half = tip, way, width / 2
    left = x - length * u - half * v, y - length * v + half * u
    return polygon(tip, left, (x - length * u + half * v, y - length * v - half * u))


@record()
class Block:
    """A rectangle turned by `angle` degrees about `at`; `sides` in its own frame."""

    at: Vec
    angle: float
    sides: Bounds

    @cached_property
    def axes(self) -> tuple[Vec, Vec]:
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        return (c, s), (-s, c)

    @cached_property
    def corners(self) -> tuple[Vec, ...]:
        (c, s), _ = self.axes
        return tuple((self.at[0] + c * x - s * y, self.at[1] + s * x + c * y) for x, y in corners(self.sides))

    @cached_property
    def box(self) -> Bounds:
        xs, ys = zip(*self.corners, strict=True)
        return min(xs), min(ys), max(xs), max(ys)

    def overlaps(self, other: Block) -> bool:
        """Tells whether two rectangles overlap: no side of one has the other beyond it."""
        a, b = self.box, other.box
        if a[0] >= b[2] or b[0] >= a[2] or a[1] >= b[3] or b[1] >= a[3]:
            return False
        for axis in (*self.axes, *other.axes):
            (low, high), (first, last) = (block._reach(axis) for block in (self, other))
            if high <= first or last <= low:
                return False
        return True

    def _reach(self, axis: Vec) -> tuple[float, float]:
        along = [x * axis[0] + y * axis[1] for x, y in self.corners]
        return min(along), max(along)


@record()
class Curves:
    """Curves drawn as lines."""

    pieces: tuple[Piece, ...]
    ink: Ink
    role: str = ""


@record()
class Text:
    """A line of text; `anchor` is start, middle or end; its baseline through `at` rises by `angle`°."""

    at: Vec
    text: str
    size: float
    color: str
    anchor: str = "start"
    bold: bool = False
    halo: bool = True
    angle: float = 0.0

    @property
    def box(self) -> Bounds:
        width = CHARACTER * self.size * len(self.text)
        left = ANCHORS[self.anchor] * width
        return Block(self.at, self.angle, (left, -0.25 * self.size, left + width, 0.8 * self.size)).box


@record()
class Dot:
    """A filled circle with a white rim."""

    at: Vec
    radius: float
    color: str


@record()
class Frame:
    """A thin rectangle without a fill, dashed if a dash length is given."""

    box: Bounds
    color: str
    width: float
    dash: float = 0.0

    @property
    def ink(self) -> Ink:
        return Ink(self.color, self.width, (self.dash, 0.7 * self.dash) if self.dash else None)


Mark: TypeAlias = Area | Curves | Text | Dot | Frame


@record()
class Group:
    """Marks seen within `clip` only. `name` is unique in a picture; `attributes` are for programs."""

    name: str
    marks: tuple[Mark, ...]
    attributes: dict[str, str] = field(default_factory=dict)
    clip: Bounds | None = None


@record()
class Picture:
    """Everything to be drawn, from back to front, and the visible part of the plane."""

    box: Bounds
    groups: tuple[Group, ...]

    @property
    def width(self) -> float:
        return self.box[2] - self.box[0]

    @property
    def height(self) -> float:
        return self.box[3] - self.box[1]


def scaled(picture: Picture, factor: float) -> Picture:
    """Returns the picture with all its lengths multiplied."""
    scale = Placing(factor)
    return Picture(scale.box(picture.box), tuple(map(scale.group, picture.groups)))


@record()
class Placing:
    """Multiplies all lengths, then moves by `shift`."""

    factor: float
    shift: Vec = (0.0, 0.0)

    def point(self, p: Vec) -> Vec:
        return self.factor * p[0] + self.shift[0], self.factor * p[1] + self.shift[1]

    def box(self, box: Bounds) -> Bounds:
        return *self.point(box[:2]), *self.point(box[2:])

    def group(self, group: Group) -> Group:
        clip = None if group.clip is None else self.box(group.clip)
        return replace(group, marks=tuple(map(self.mark, group.marks)), clip=clip)

    def mark(self, mark: Mark) -> Mark:
        k = self.factor
        match mark:
            case Area(face=face, ink=ink, gradient=gradient):
                return replace(
                    mark,
                    face=face.mapped(self.piece),
                    ink=None if ink is None else self.ink(ink),
                    gradient=None if gradient is None else self.gradient(gradient),
                )
            case Curves(pieces=pieces, ink=ink):
                return replace(mark, pieces=tuple(map(self.piece, pieces)), ink=self.ink(ink))
            case Text(at=at, size=size):
                return replace(mark, at=self.point(at), size=k * size)
            case Dot(at=at, radius=radius):
                return replace(mark, at=self.point(at), radius=k * radius)
            case Frame(box=box, width=width, dash=dash):
                return replace(mark, box=self.box(box), width=k * width, dash=k * dash)

    def gradient(self, gradient: Gradient) -> Gradient:
        radius = None if gradient.radius is None else self.factor * gradient.radius
        start, end = self.point(gradient.start), self.point(gradient.end)
        return replace(gradient, start=start, end=end, radius=radius)

    def ink(self, ink: Ink) -> Ink:
        dash = None if ink.dash is None else tuple(self.factor * part for part in ink.dash)
        return replace(ink, width=self.factor * ink.width, dash=dash)

    def piece(self, piece: Piece) -> Piece:
        return image(piece, self.point, self.factor)


# --- Pictures for few pixels: no line thinner than one, and black lines on white without colours.

_BLACK = "#000000"
_SHORTEST_DASH = 2.0
"""Pixels; shorter ones cannot be told from a line."""
_SEEN_THROUGH = 0.5
"""Opacity up to which a fill hides nothing where there is black and white alone."""


def framed(picture: Picture, proportion: float) -> Picture:
    """Returns the picture with white around it, `proportion` times as wide as high."""
    return spaced(picture, picture.height * proportion, picture.width / proportion)


def spaced(picture: Picture, width: float, height: float) -> Picture:
    """Returns the picture with white around it, so wide and high at least."""
    (left, bottom, right, top), x, y = picture.box, width - picture.width, height - picture.height
    x, y = max(0.0, x) / 2, max(0.0, y) / 2
    return replace(picture, box=(left - x, bottom - y, right + x, top + y))


def coarse(picture: Picture, pixel: float) -> Picture:
    """Returns the picture with no line thinner than a `pixel`, mm."""

    def thickened(mark: Mark) -> Mark:
        match mark:
            case Area(ink=Ink() as ink) | Curves(ink=ink):
                dash = ink.dash if ink.dash and min(ink.dash) > _SHORTEST_DASH * pixel else None
                return replace(mark, ink=replace(ink, width=max(ink.width, pixel), dash=dash))
            case Frame():
                return replace(mark, width=max(mark.width, pixel))
            case Dot():
                return replace(mark, radius=max(mark.radius, pixel))
        return mark

    return _redrawn(picture, thickened)


def resolved(picture: Picture, pixel: float) -> Picture:
    """Returns the picture with paler lines for dashes below a `pixel`, mm: of a million resvg draws none."""

    def blurred(mark: Mark) -> Mark:
        match mark:
            case Area(ink=Ink(dash=tuple() as dash) as ink) | Curves(ink=Ink(dash=tuple() as dash) as ink):
                if sum(dash) > _SHORTEST_DASH * pixel:
                    return mark
                drawn = sum(dash[::2]) / sum(dash)
                return replace(mark, ink=replace(ink, dash=None, opacity=drawn * ink.opacity))
        return mark

    return _redrawn(picture, blurred)


def outlined(picture: Picture) -> Picture:
    """Returns the picture in black and white: outlines hide what is below them, and seams are left out."""
    return _redrawn(picture, _plain)


def separated(picture: Picture) -> tuple[Picture, tuple[Text, ...]]:
    """Returns the picture without its texts, and the texts."""
    texts = tuple(mark for group in picture.groups for mark in group.marks if isinstance(mark, Text))
    return _redrawn(picture, lambda mark: None if isinstance(mark, Text) else mark), texts


def _redrawn(picture: Picture, change: Callable[[Mark], Mark | None]) -> Picture:
    groups = (
        replace(group, marks=tuple(new for mark in group.marks if (new := change(mark)) is not None))
        for group in picture.groups
    )
    return replace(picture, groups=tuple(groups))


def _plain(mark: Mark) -> Mark | None:
    match mark:
        case Curves(role="seam"):
            return None
        case Text():
            return replace(mark, color=_BLACK)
        case Area(opacity=opacity):
            mark = replace(mark, opacity=float(mark.is_sign or opacity > _SEEN_THROUGH))
        case Curves(ink=ink):
            mark = replace(mark, ink=replace(ink, opacity=1.0))
    return _reduced(mark, REDUCED["ink"])


# --- The looks of a picture as a whole: as the author coloured it, white on blue, or black on white.

AS_COLOURED, FOR_CUTTER = "colour", "cutter"


@record()
class Theme:
    """The colours that a picture is reduced to: of the paper, of what is filled, and of every line.

    Fills that show through, as light and shade do, are left out: of one colour they would be a veil over the
    lines below.
    """

    paper: str
    fill: str
    line: str


REDUCED = {
    "blueprint": Theme("#1d4b87", "#2a5a99", "#eaf2ff"),
    "ink": Theme(PAPER, PAPER, _BLACK),
}
THEMES = (AS_COLOURED, *REDUCED, FOR_CUTTER)


def themed(picture: Picture, name: str) -> Picture:
    """Returns the picture in a theme; unchanged in those that keep its colours. Raises KeyError."""
    if name in (AS_COLOURED, FOR_CUTTER):
        return picture
    theme = REDUCED[name]
    paper = Group("paper", (Area(polygon(*corners(picture.box)), theme.paper, None, "paper"),))
    made = _redrawn(picture, lambda mark: _reduced(mark, theme))
    return replace(made, groups=(paper, *made.groups))


def _reduced(mark: Mark, theme: Theme) -> Mark | None:
    match mark:
        case Area() if mark.role == HALO:
            return replace(mark, fill=theme.paper)
        case Area() if mark.is_sign:
            return replace(mark, fill=theme.line)
        case Area(ink=ink):
            line = None if ink is None else replace(ink, color=theme.line)
            fill = theme.fill if mark.fill and mark.opacity == 1.0 and not mark.fades else None
            return replace(mark, fill=fill, ink=line, opacity=1.0, gradient=None) if fill or line else None
        case Curves(ink=ink):
            color = theme.paper if mark.role == HALO else theme.line
            return replace(mark, ink=replace(ink, color=color))
        case Text():
            return replace(mark, color=theme.line, halo=False)
        case Dot() | Frame():
            return replace(mark, color=theme.line)
