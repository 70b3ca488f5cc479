"""XML that is not believed, and the values in SVG."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import field
from itertools import pairwise
from xml.parsers import expat

from fontTools.misc.transform import Identity, Offset, Scale, Transform

from aidl_lang.common.drawings import Bow, DrawingError, Stroke, bow
from aidl_lang.common.font_files import Vec, quadratic
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint

# --- XML of unknown origin as a tree of plain nodes: how many there are, how deep they lie, and what their
# DTD defines is bounded while it is read, and nothing outside of the text is looked at.

MOST_NODES = 100_000
DEEPEST = 100
_MOST_ENTITIES = 100
_LONGEST_ENTITY = 1_000


@record(frozen=False, eq=False, slots=True)
class Node:
    """An element: its name without the namespace ("" for one of another namespace than SVG's)."""

    tag: str
    attributes: dict[str, str]
    children: list[Node] = field(default_factory=list)
    text: str = ""

    def walk(self) -> Iterator[Node]:
        yield self
        for child in self.children:
            yield from child.walk()


def read(data: bytes, path: str) -> Node:
    """Returns the root of an SVG document. Raises DrawingError."""
    reader = _Reader(path)

    def wrong(what: str, hint: str) -> DrawingError:
        return DrawingError("E0362", f"`{path}` {what}", hint)

    try:
        reader.parser.Parse(data, True)
    except expat.ExpatError as reason:
        what = f"is not well-formed: {expat.ErrorString(reason.code)} in line {reason.lineno}"
        raise wrong(what, "save it anew as plain SVG in the program that drew it") from None
    except (LookupError, ValueError):  # an encoding that is unknown, or takes several bytes
        raise wrong("is in an encoding that is not known", "save it anew as UTF-8") from None
    if reader.root is None or reader.root.tag != "svg":
        raise wrong("is no SVG: it does not begin with an `svg` element", "export it as SVG")
    return reader.root


class _Reader:
    def __init__(self, path: str) -> None:
        self.path = path
        self.root: Node | None = None
        self.open: list[Node] = []
        self.count = self.entities = 0
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = lambda _: self.open.pop()
        self.parser.CharacterDataHandler = self._text
        self.parser.EntityDeclHandler = self._entity

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self.count += 1
        if self.count % 1_000 == 0:
            checkpoint()
        if self.count > MOST_NODES:
            raise self._refused(f"it has more than {MOST_NODES:,} elements")
        if len(self.open) >= DEEPEST:
            raise self._refused(f"its elements lie more than {DEEPEST} deep in one another")
        space, _, local = name.rpartition(" ")
        node = Node(local if space in ("", "http://www.w3.org/2000/svg") else "", _plain(attributes))
        if self.open:
            self.open[-1].children.append(node)
        else:
            self.root = node
        self.open.append(node)

    def _text(self, data: str) -> None:
        if self.open and self.open[-1].tag == "style":
            self.open[-1].text += data

    def _entity(self, name: str, is_parameter: bool, value: str | None, *other: str | None) -> None:
        """Takes the abbreviations that some programs write, and nothing that would grow or reach out."""
        self.entities += 1
        if value is None or is_parameter or "&" in value or len(value) > _LONGEST_ENTITY:
            raise self._refused(f"its entity `{name[:30]}` is no plain abbreviation")
        if self.entities > _MOST_ENTITIES:
            raise self._refused(f"it defines more than {_MOST_ENTITIES} entities")

    def _refused(self, reason: str) -> DrawingError:
        return DrawingError(
            "E0363", f"`{self.path}` is refused: {reason}", "save it anew as plain SVG, or in several files"
        )


def _plain(attributes: dict[str, str]) -> dict[str, str]:
    """Returns attributes by their local names; those of Inkscape keep a mark, as in `inkscape:label`."""
    found = {}
    for name, value in attributes.items():
        space, _, local = name.rpartition(" ")
        found[f"inkscape:{local}" if "inkscape" in space else local] = value
    return found


# --- The values of attributes in SVG: lengths, numbers, transforms, styles and the data of paths.

MM_PER_PIXEL = 25.4 / 96
_PIXELS = {"px": 1.0, "in": 96.0, "mm": 96 / 25.4, "cm": 960 / 25.4, "q": 24 / 25.4, "pt": 96 / 72, "ex": 8.0}
_PIXELS |= dict.fromkeys(("pc", "em", "rem"), 16.0)
"""Pixels in each unit of length; em and ex are those of the text that browsers begin with."""

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_NUMBERS = re.compile(_NUMBER)
_LENGTH = re.compile(rf"\s*({_NUMBER})\s*(%|[a-zA-Z]*)\s*")


class ValueMistake(ValueError):  # noqa: N818 (a mistake in a file, which is told)
    """Raised for an attribute that cannot be read."""


def pixels(text: str, whole: float) -> float:
    """Returns a length in pixels; `whole` is what a percentage is one of. Raises ValueMistake."""
    found = _LENGTH.fullmatch(text)
    if found is None:
        raise ValueMistake(text)
    number, unit = float(found[1]), found[2].lower() or "px"
    if unit == "%":
        return number * whole / 100
    if unit not in _PIXELS:
        raise ValueMistake(text)
    return number * _PIXELS[unit]


def numbers(text: str) -> list[float]:
    """Returns the numbers of a list. Raises ValueMistake."""
    if _NUMBERS.sub("", text).strip(" ,\t\r\n\f"):
        raise ValueMistake(text)
    return list(map(float, _NUMBERS.findall(text)))


def declarations(text: str) -> Iterator[tuple[str, str]]:
    """Yields the properties of a `style` attribute or of a rule."""
    for item in text.split(";"):
        name, colon, value = item.partition(":")
        if colon:
            yield name.strip().lower(), value.replace("!important", "").strip()


# --- Transforms ------------------------------------------------------------------------------------

_STEP = re.compile(r"\s*,?\s*([a-zA-Z]+)\s*\(([^()]*)\)\s*,?\s*")


def transform(text: str) -> Transform:
    """Returns the map that a `transform` attribute describes. Raises ValueMistake."""
    matrix, at = Identity, 0
    if text.strip() in ("", "none"):
        return matrix
    while at < len(text):
        found = _STEP.match(text, at)
        if found is None:
            raise ValueMistake(text)
        matrix, at = matrix.transform(_step(found[1], numbers(found[2]))), found.end()
    return matrix


def _step(name: str, given: Sequence[float]) -> Transform:
    match name, given:
        case "matrix", [_, _, _, _, _, _]:
            return Transform(*given)
        case "translate", [_] | [_, _]:
            return Offset(*given)
        case "scale", [_] | [_, _]:
            return Scale(*given)
        case "rotate", [angle] | [angle, _, _]:
            (c, s), (x, y) = _cos_sin(angle), given[1:] or (0.0, 0.0)
            return Transform(c, s, -s, c, x - c * x + s * y, y - s * x - c * y)
        case "skewX", [angle]:
            return Identity.skew(math.radians(angle))
        case "skewY", [angle]:
            return Identity.skew(0.0, math.radians(angle))
        case _:
            raise ValueMistake(name)


def _cos_sin(angle: float) -> Vec:
    """Returns cosine and sine of an angle in degrees, exact for quarter turns."""
    quarter = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}
    turn = math.radians(angle)
    return quarter.get(angle % 360.0) or (math.cos(turn), math.sin(turn))


# --- Paths -----------------------------------------------------------------------------------------

_COMMANDS = re.compile("([MmZzLlHhVvCcSsQqTtAa])")


def path(data: str) -> tuple[list[Stroke], bool]:
    """Returns the curves of path data as far as it can be read, and whether that is all of it."""
    from fontTools.svgLib.path.parser import parse_path

    pen, (text, is_whole) = _Pen(), _readable(data)
    try:
        parse_path(text, pen)
    except (ValueError, ArithmeticError):
        return pen.strokes, False
    return pen.strokes, is_whole


def _readable(data: str) -> tuple[str, bool]:
    """Returns path data with numbers as fontTools reads them, up to where it is no path data."""
    pieces: list[str] = []
    command = ""
    for piece in _COMMANDS.split(data):
        if _COMMANDS.fullmatch(piece):
            command = piece
            pieces.append(piece)
        elif command in ("A", "a"):  # flags may touch what follows, which fontTools knows
            pieces.append(" ".join(piece.split()))
        else:
            try:
                pieces.append(" ".join(map(repr, numbers(piece))))
            except ValueMistake:
                return "".join(pieces[:-1]), False
    return "".join(pieces), True


class _Pen:
    """Takes the commands of a path (the protocol of pens in fontTools, with arcs)."""

    def __init__(self) -> None:
        self.strokes: list[Stroke] = []
        self.here: Vec = (0.0, 0.0)

    def moveTo(self, p: Vec) -> None:  # noqa: N802 (the name in the library)
        self.here = p

    def lineTo(self, p: Vec) -> None:  # noqa: N802
        self._add((self.here, p))

    def curveTo(self, one: Vec, two: Vec, end: Vec) -> None:  # noqa: N802
        self._add((self.here, one, two, end))

    def qCurveTo(self, control: Vec, end: Vec) -> None:  # noqa: N802
        self._add(quadratic(self.here, control, end))

    def arcTo(  # noqa: N802
        self, rx: float, ry: float, rotation: float, is_large: float, is_clockwise: float, end: Vec
    ) -> None:
        self._add(_arc(self.here, end, abs(rx), abs(ry), rotation, bool(is_large), bool(is_clockwise)))

    def endPath(self) -> None:  # noqa: N802
        pass

    closePath = endPath  # noqa: N815

    def _add(self, stroke: Stroke) -> None:
        self.strokes.append(stroke)
        self.here = stroke.end if isinstance(stroke, Bow) else stroke[-1]
        if len(self.strokes) % 1_000 == 0:
            checkpoint()


def _arc(start: Vec, end: Vec, rx: float, ry: float, rotation: float, large: bool, positive: bool) -> Stroke:
    """Returns an arc by its ends (SVG 2, B.2.4): in its ellipse's frame and radii, one of a unit circle."""
    if rx == 0.0 or ry == 0.0 or start == end:
        return start, end
    c, s = _cos_sin(rotation)

    def flat(p: Vec) -> Vec:
        return (c * p[0] + s * p[1]) / rx, (c * p[1] - s * p[0]) / ry

    (x0, y0), (x1, y1) = flat(start), flat(end)
    dx, dy = x1 - x0, y1 - y0
    half = math.hypot(dx, dy) / 2
    if half > 1.0:  # too small to reach: they grow
        rx, ry = rx * half, ry * half
        x0, y0, x1, y1 = x0 / half, y0 / half, x1 / half, y1 / half
        dx, dy, half = dx / half, dy / half, 1.0
    height = math.sqrt(max(1.0 - half * half, 0.0)) / (2 * half)
    if large == positive:
        height = -height
    mx, my = (x0 + x1) / 2 - height * dy, (y0 + y1) / 2 + height * dx
    first = math.atan2(y0 - my, x0 - mx)
    sweep = (math.atan2(y1 - my, x1 - mx) - first) % math.tau
    if not positive:
        sweep -= math.tau
    u, v = (rx * c, rx * s), (-ry * s, ry * c)
    center = c * mx * rx - s * my * ry, s * mx * rx + c * my * ry
    return Bow(center, u, v, first, sweep, start, end)


# --- The shapes of SVG as curves, in the coordinates of the element.

SHAPES = frozenset({"path", "rect", "circle", "ellipse", "line", "polyline", "polygon"})


def outline(node: Node, page: tuple[float, float]) -> tuple[list[Stroke], bool]:
    """Returns a shape's curves and whether all was read; percentages are of `page`. Raises ValueMistake."""
    if node.tag == "path":
        return path(node.attributes.get("d", ""))
    return list(_strokes(node, page)), True


def _strokes(node: Node, page: tuple[float, float]) -> Iterator[Stroke]:
    def length(name: str, axis: int) -> float:
        return pixels(node.attributes.get(name, "0"), page[axis])

    match node.tag:
        case "line":
            yield (length("x1", 0), length("y1", 1)), (length("x2", 0), length("y2", 1))
        case "polyline" | "polygon":
            given = numbers(node.attributes.get("points", ""))
            points = list(zip(given[::2], given[1::2], strict=False))
            if node.tag == "polygon":
                points += points[:1]
            yield from pairwise(points)
        case "circle":
            radius = pixels(node.attributes.get("r", "0"), math.hypot(*page) / math.sqrt(2))
            if radius > 0.0:
                yield bow((length("cx", 0), length("cy", 1)), (radius, 0.0), (0.0, radius))
        case "ellipse":
            a, b = _radii(node, page)
            if a > 0.0 and b > 0.0:
                yield bow((length("cx", 0), length("cy", 1)), (a, 0.0), (0.0, b))
        case _:
            sides = length("x", 0), length("y", 1), length("width", 0), length("height", 1)
            yield from _rectangle(*sides, *_radii(node, page))


def _radii(node: Node, page: tuple[float, float]) -> tuple[float, float]:
    """Returns `rx` and `ry`, of which one may stand for both. Raises ValueMistake."""
    rx, ry = (node.attributes.get(name, "auto").strip() for name in ("rx", "ry"))
    both = (ry if rx == "auto" else rx), (rx if ry == "auto" else ry)
    a, b = (0.0 if text == "auto" else pixels(text, whole) for text, whole in zip(both, page, strict=True))
    return a, b


_QUARTER = math.tau / 4


def _rectangle(x: float, y: float, width: float, height: float, rx: float, ry: float) -> Iterator[Stroke]:
    if width <= 0.0 or height <= 0.0:
        return
    right, bottom = x + width, y + height
    rx, ry = min(rx, width / 2), min(ry, height / 2)
    if rx <= 0.0 or ry <= 0.0:
        corners = [(x, y), (right, y), (right, bottom), (x, bottom), (x, y)]
        yield from pairwise(corners)
        return
    centers = [(right - rx, y + ry), (right - rx, bottom - ry), (x + rx, bottom - ry), (x + rx, y + ry)]
    sides = [
        ((right - rx, y), (right, y + ry)),
        ((right, bottom - ry), (right - rx, bottom)),
        ((x + rx, bottom), (x, bottom - ry)),
        ((x, y + ry), (x + rx, y)),
    ]
    here = sides[-1][1]
    for number, (center, (start, end)) in enumerate(zip(centers, sides, strict=True)):
        if start != here:
            yield here, start
        yield Bow(center, (rx, 0.0), (0.0, ry), (number - 1) * _QUARTER, _QUARTER, start, end)
        here = end
