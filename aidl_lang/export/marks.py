"""The marks of pictures, as data: areas, curves, texts, dots and frames. Coordinates in mm, y upwards."""

from __future__ import annotations

import math
from dataclasses import field
from typing import NamedTuple, TypeAlias

from aidl_lang.common.records import record
from aidl_lang.geometry.curves import Line, Piece, Vec
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.geometry.region import Face, Loop

CHARACTER = 0.6
"""Mean width of a character of the font, relative to its size."""

HALO = "halo"
"""The role of what has the colour of the paper: a gap around what lies in front."""
LETTERS = "letters"


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
        """True for a mark of its own, such as a letter or the head of an arrow; false for a solid without
        outline.
        """
        return self.ink is None and self.role not in ("", HALO)


def polygon(*corners: Vec) -> Face:
    """Returns the face with these corners, counter-clockwise."""
    return Face(Loop(tuple(Line(p, q) for p, q in zip(corners, corners[1:] + corners[:1], strict=True))))


@record()
class Curves:
    """Curves drawn as lines."""

    pieces: tuple[Piece, ...]
    ink: Ink
    role: str = ""


@record()
class Text:
    """A line of text; `anchor` is start, middle or end, `at` lies on its baseline, which rises by `angle`
    degrees.
    """

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
        left = -{"start": 0.0, "middle": 0.5, "end": 1.0}[self.anchor] * width
        bottom, right, top = -0.25 * self.size, left + width, 0.8 * self.size
        if not self.angle:
            return self.at[0] + left, self.at[1] + bottom, self.at[0] + right, self.at[1] + top
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
        xs = [self.at[0] + c * x - s * y for x, y in corners]
        ys = [self.at[1] + s * x + c * y for x, y in corners]
        return min(xs), min(ys), max(xs), max(ys)


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


Mark: TypeAlias = Area | Curves | Text | Dot | Frame


@record()
class Group:
    """Marks that belong together, visible only within `clip`. `name` is unique in a picture; `attributes`
    identify it to programs.
    """

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
