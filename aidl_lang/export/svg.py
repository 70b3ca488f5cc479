"""SVG: millimetres or inches, y upwards, one group per structure, holes really cut, curves as curves."""

from __future__ import annotations

import io
import math
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import singledispatch
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np

from aidl_lang.common.colors import css_color, hexadecimal, rgb
from aidl_lang.common.prose import fixed
from aidl_lang.common.running import checkpoint
from aidl_lang.export import themes
from aidl_lang.export.job import UNITS
from aidl_lang.export.marks import (
    HALO,
    Area,
    Curves,
    Dot,
    Frame,
    Gradient,
    Group,
    Ink,
    Mark,
    Picture,
    Stop,
    Text,
    scaled,
)
from aidl_lang.geometry.boolean import without
from aidl_lang.geometry.curves import (
    Arc,
    Bezier,
    Bounds,
    Circle,
    Ellipse,
    EllipseArc,
    Line,
    Piece,
    Vec,
    all_bounds,
    bounds,
    ends,
    point,
    points,
    union_bounds,
)
from aidl_lang.geometry.drawing import Body, Drawing, Stroke
from aidl_lang.geometry.region import Face, Loop
from aidl_lang.geometry.solved import SolvedStructure
from aidl_lang.geometry.styles import Shade, stacked

# --- Loads `svgwrite` without the modules that drawings do not use, which triple its loading time.


def svgwrite() -> Any:
    """Loads the package `svgwrite` when the first drawing is written.

    It imports the protocols of the web, to embed fonts and style sheets by their address, and a parser that
    checks the values of attributes (`debug=True`); both are loaded if they are ever called.
    """
    if "svgwrite" not in sys.modules:
        values = ("is_valid_transferlist", "is_valid_pathdata", "is_valid_animation_timing")
        with _loaded_later("urllib.request", "urlopen"), _loaded_later("svgwrite.data.svgparser", *values):
            import_module("svgwrite")
    return import_module("svgwrite")


@contextmanager
def _loaded_later(name: str, *functions: str) -> Iterator[None]:
    """Replaces a module that is not loaded; functions imported from it load it when called."""
    if name in sys.modules:
        yield
        return
    stand_in = _StandIn(name)
    for function in functions:
        setattr(stand_in, function, _calling(name, function))
    sys.modules[name] = stand_in
    try:
        yield
    finally:
        _remove(stand_in)


def _calling(name: str, function: str) -> Callable[..., Any]:
    def call(*args: Any, **named: Any) -> Any:
        return getattr(import_module(name), function)(*args, **named)

    return call


class _StandIn(ModuleType):
    """A placeholder module that gives way to the real one when another thread asks it for more."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        _remove(self)
        return getattr(import_module(self.__name__), name)


def _remove(stand_in: ModuleType) -> None:
    if sys.modules.get(stand_in.__name__) is stand_in:
        del sys.modules[stand_in.__name__]


# --- SVG path data from exact pieces. Coordinates turn upside down: SVG counts y downwards.

_HALF = 1e-8
"""Radians by which a half turn may be off after solving; to take it for the other half moves nothing."""


def xy(p: Vec) -> str:
    return f"{fixed(p[0])} {fixed(-p[1])}"


def face_path(face: Face) -> str:
    """Returns all loops of a face as one path, its holes really cut out."""
    return "".join(loop_path(loop) for loop in face.loops)


def loop_path(loop: Loop) -> str:
    if loop.is_whole:
        return _whole(loop.pieces[0], clockwise=loop.reversed)
    pieces = loop.pieces
    # The last straight way home is what Z draws.
    drawn = pieces[:-1] if isinstance(pieces[-1], Line) else pieces
    return f"M{xy(ends(pieces[0])[0])}{''.join(map(_segment, drawn))}Z"


def open_path(pieces: Sequence[Piece]) -> str:
    """Returns curves one after the other, moving only where one does not start at the end before."""
    return "".join(_chain(pieces))


def _chain(pieces: Iterable[Piece]) -> Iterable[str]:
    at: Vec | None = None
    for piece in pieces:
        if isinstance(piece, Circle | Ellipse):
            yield _whole(piece, clockwise=False)
            at = None
            continue
        start, end = ends(piece)
        if start != at:
            yield f"M{xy(start)}"
        yield _segment(piece)
        at = end


def _whole(piece: Piece, clockwise: bool) -> str:
    """Returns a closed curve as two halves, since an `A` that ends where it starts draws nothing."""
    assert isinstance(piece, Circle | Ellipse)
    start, middle = xy(point(piece, 0.0)), xy(point(piece, 0.5))
    flag = int(clockwise)
    radii = _radii(piece)
    return f"M{start}A{radii} 0 {flag} {middle}A{radii} 0 {flag} {start}Z"


def _radii(piece: Arc | Circle | Ellipse | EllipseArc) -> str:
    if isinstance(piece, Arc | Circle):
        return f"{fixed(piece.radius)} {fixed(piece.radius)} 0"
    return f"{fixed(piece.rx)} {fixed(piece.ry)} {fixed(-math.degrees(piece.angle))}"


def _segment(piece: Piece) -> str:
    """Returns the path command that continues from the start of a piece."""
    if isinstance(piece, Line):
        return f"L{xy(piece.end)}"
    if isinstance(piece, Bezier):
        return f"C{xy(piece.p1)} {xy(piece.p2)} {xy(piece.p3)}"
    assert isinstance(piece, Arc | EllipseArc)
    flag = int(piece.sweep < 0)
    if abs(piece.sweep) > 1.9 * math.pi:
        # Nearly full turns lose their direction in rounding: go by way of the middle.
        return f"A{_radii(piece)} 0 {flag} {xy(point(piece, 0.5))}A{_radii(piece)} 0 {flag} {xy(piece.end)}"
    is_large = (
        abs(piece.sweep) > math.pi + _HALF
    )  # of two equal halves no machine says otherwise than another
    return f"A{_radii(piece)} {int(is_large)} {flag} {xy(piece.end)}"


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
            yield from (Area(face, themes.PAPER, None, HALO) for face in wide.faces)

    def around_stroke(self, stroke: Stroke, line: float) -> Iterator[Area | Curves]:
        """Yields the gap around curves drawn as lines of a width; letters that are filled have lines of 0."""
        width = stroke.style.halo or 0.0
        if width > 0 and self._covers(stroke.path, _box(stroke), width + line / 2):
            ink = Ink(themes.PAPER, line + 2 * width, is_round=True)
            yield Curves(stroke.pieces, ink, HALO)

    def _covers(self, path: str, box: Bounds, by: float) -> bool:
        """Tells whether the box of something, widened, meets that of something behind it."""
        left, bottom, right, top = box[0] - by, box[1] - by, box[2] + by, box[3] + by
        return any(
            place < self._place[path] and b[0] < right and left < b[2] and b[1] < top and bottom < b[3]
            for place, b in self._boxes
        )


def _box(stroke: Stroke) -> Bounds:
    return union_bounds([bounds(piece) for piece in stroke.pieces])


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
    stops = tuple(Stop(share, _toned(color, tone)) for share, tone in _LIGHT.get(shade.kind, ()))
    left, bottom, right, top = union_bounds(all_bounds(outline))
    width, height = right - left, top - bottom
    if shade.way is None:
        center = (left + width / 2, bottom + height / 2)
        fading = tuple(Stop(share, color, opacity) for share, opacity in _FADING)
        return Gradient(center, center, fading, width / 2, height / width)
    if shade.kind == "ball":
        spot = (left + _SPOT[0] * width, bottom + _SPOT[1] * height)
        return Gradient(spot, spot, stops, _REACH * max(width, height))
    ways = np.array([math.cos(math.radians(shade.way)), math.sin(math.radians(shade.way))])
    spots = np.concatenate([points(piece, _STEPS) for piece in outline])
    along = spots @ ways
    middle = np.array([(left + right) / 2, (bottom + top) / 2])
    start, end = (middle + (reach - middle @ ways) * ways for reach in (along.min(), along.max()))
    other = css_color([shade.kind])
    if shade.kind == "fade":
        stops = (Stop(0.0, color), Stop(1.0, color, 0.0))
    elif other is not None:
        stops = (Stop(0.0, color), Stop(1.0, other))
    return Gradient((float(start[0]), float(start[1])), (float(end[0]), float(end[1])), stops)


def _toned(color: str, tone: float) -> str:
    """Returns a colour in more light, or in less if the tone is negative. Light makes it stronger before it
    makes it paler: red gleams red, and not pink.
    """
    lift = min(1 + _LIFT * tone, 255 / max(*rgb(color), 1)) if tone > 0 else 1 + tone
    parts = [lift * part for part in rgb(color)]
    return hexadecimal(part + _PALER * max(tone, 0.0) * (255 - part) for part in parts)


FONT = "DejaVu Sans, Verdana, Arial, sans-serif"

_NOT_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def to_svg(picture: Picture, pixels: tuple[int, int] | None = None, units: str = "mm") -> str:
    """Returns the picture as SVG, in its true size or so many pixels wide and high, drawn in `units`."""
    if units != "mm":
        picture = scaled(picture, 1 / UNITS[units])
    left, _, _, top = picture.box
    width, height = fixed(picture.width), fixed(picture.height)
    document = svgwrite().Drawing(
        size=pixels or (f"{width}{units}", f"{height}{units}"),
        viewBox=f"{fixed(left)} {fixed(-top)} {width} {height}",
        debug=False,
    )
    boxes = dict.fromkeys(group.clip for group in picture.groups if group.clip is not None)
    clips = {box: f"clip-{k}" for k, box in enumerate(boxes, 1)}
    for clip, name in clips.items():
        path = document.clipPath(id=name)
        path.add(_rectangle(clip, document))
        document.defs.add(path)
    shades = _shades(picture)
    for gradient, name in shades.items():
        document.defs.add(_gradient(gradient, name, document))
    for group in picture.groups:
        element = _group(document, group, shades)
        if group.clip is not None:
            element["clip-path"] = f"url(#{clips[group.clip]})"
        document.add(element)
    text = io.StringIO()
    document.write(text)
    # One element per line. Text is escaped, so this pattern stands between tags only.
    return text.getvalue().replace("><", ">\n<") + "\n"


def _shades(picture: Picture) -> dict[Gradient, str]:
    marks = (mark for group in picture.groups for mark in group.marks)
    used = (mark.gradient for mark in marks if isinstance(mark, Area) and mark.gradient is not None)
    return {gradient: f"shade-{k}" for k, gradient in enumerate(dict.fromkeys(used), 1)}


def _gradient(gradient: Gradient, name: str, svg: Any) -> Any:
    (x0, y0), (x1, y1) = gradient.start, gradient.end
    start, end = (fixed(x0), fixed(-y0)), (fixed(x1), fixed(-y1))
    looks = {"id": name, "gradientUnits": "userSpaceOnUse"}
    made = (
        svg.linearGradient(start, end, **looks)
        if gradient.radius is None
        else svg.radialGradient(start, fixed(gradient.radius), **looks)
    )
    if gradient.height != 1:
        made["gradientTransform"] = (
            f"matrix(1 0 0 {fixed(gradient.height)} 0 {fixed(-y0 * (1 - gradient.height))})"
        )
    for stop in gradient.stops:
        made.add_stop_color(fixed(stop.share), stop.color, None if stop.opacity == 1 else fixed(stop.opacity))
    return made


def _group(svg: Any, group: Group, shades: Mapping[Gradient, str]) -> Any:
    attributes = {key: _clean(value) for key, value in group.attributes.items()}
    element = svg.g(id=_clean(group.name))
    element.attribs.update(attributes)
    for mark in group.marks:
        checkpoint()
        if isinstance(mark, Area) and mark.gradient is not None:
            mark = replace(mark, fill=f"url(#{shades[mark.gradient]})")
        element.add(_element(mark, svg))
    return element


def _clean(text: str) -> str:
    return _NOT_XML.sub("\ufffd", text)


@singledispatch
def _element(mark: Mark, svg: Any) -> Any:
    raise TypeError(mark)


@_element.register
def _(mark: Area, svg: Any) -> Any:
    looks = {"fill": mark.fill or "none", "fill_rule": "evenodd"}
    if mark.opacity != 1:
        looks["fill_opacity"] = fixed(mark.opacity)
    looks |= {"stroke": "none"} if mark.ink is None else _looks(mark.ink, closed=True)
    return svg.path(d=face_path(mark.face), **looks, **_role(mark.role))


@_element.register
def _(mark: Curves, svg: Any) -> Any:
    looks = {"fill": "none"} | _looks(mark.ink)
    return svg.path(d=open_path(mark.pieces), **looks, **_role(mark.role))


def _role(role: str) -> dict[str, str]:
    return {"class_": role} if role else {}


def _looks(ink: Ink, *, closed: bool = False) -> dict[str, str]:
    looks = {"stroke": ink.color, "stroke_width": fixed(ink.width)}
    if ink.is_round:
        looks["stroke_linejoin"] = "round"
    if ink.is_round and not closed:
        looks["stroke_linecap"] = "round"
    if ink.opacity != 1:
        looks["stroke_opacity"] = fixed(ink.opacity)
    if ink.dash is not None:
        looks["stroke_dasharray"] = " ".join(map(fixed, ink.dash))
    return looks


@_element.register
def _(mark: Text, svg: Any) -> Any:
    looks = {"font_size": fixed(mark.size), "font_family": FONT, "fill": mark.color}
    if mark.anchor != "start":
        looks["text_anchor"] = mark.anchor
    if mark.bold:
        looks["font_weight"] = "bold"
    at = (fixed(mark.at[0]), fixed(-mark.at[1]))
    if mark.angle:
        looks["transform"] = f"rotate({fixed(-mark.angle)} {at[0]} {at[1]})"
    text = svg.text(_clean(mark.text), insert=at, **looks)
    if not mark.halo:
        return text
    # The halo is a text of its own below: not every renderer knows `paint-order`.
    looks |= {"fill": "#ffffff", "stroke": "#ffffff", "stroke_width": fixed(0.22 * mark.size)}
    halo = svg.text(_clean(mark.text), insert=at, stroke_linejoin="round", **looks)
    halo["aria-hidden"] = "true"
    both = svg.g()
    both.add(halo)
    both.add(text)
    return both


@_element.register
def _(mark: Dot, svg: Any) -> Any:
    return svg.circle(
        center=(fixed(mark.at[0]), fixed(-mark.at[1])),
        r=fixed(mark.radius),
        fill=mark.color,
        stroke="#ffffff",
        stroke_width=fixed(0.3 * mark.radius),
    )


@_element.register
def _(mark: Frame, svg: Any) -> Any:
    ink = Ink(mark.color, mark.width, (mark.dash, 0.7 * mark.dash) if mark.dash else None)
    return _rectangle(mark.box, svg, fill="none", **_looks(ink))


def _rectangle(box: Bounds, svg: Any, **looks: str) -> Any:
    left, bottom, right, top = box
    insert, size = (fixed(left), fixed(-top)), (fixed(right - left), fixed(top - bottom))
    return svg.rect(insert=insert, size=size, **looks)
