"""SVG: millimetres or inches, y upwards, one group per structure, holes really cut, curves as curves."""

from __future__ import annotations

import io
import math
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from importlib import import_module
from types import ModuleType
from typing import Any

from aidl_lang.common.prose import fixed
from aidl_lang.common.running import checkpoint
from aidl_lang.export.job import UNITS
from aidl_lang.export.marks import Area, Curves, Dot, Frame, Gradient, Group, Ink, Mark, Picture, Text, scaled
from aidl_lang.geometry.curves import Arc, Bezier, Bounds, Circle, Ellipse, EllipseArc, Line, Piece, Vec
from aidl_lang.geometry.region import Face, Loop

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
    """Replaces a module that is not loaded. Functions imported from it load it when they are called, and a
    thread that asks it for more meanwhile has the real one.
    """
    if name in sys.modules:
        yield
        return
    stand_in: Any = ModuleType(name)

    def give_way() -> None:
        if sys.modules.get(name) is stand_in:
            del sys.modules[name]

    def real(wanted: str) -> Any:
        if wanted.startswith("__"):
            raise AttributeError(wanted)
        give_way()
        return getattr(import_module(name), wanted)

    for function in functions:
        setattr(stand_in, function, lambda *args, of=function, **named: real(of)(*args, **named))
    stand_in.__getattr__ = real
    sys.modules[name] = stand_in
    try:
        yield
    finally:
        give_way()


# --- SVG path data from exact pieces. Coordinates turn upside down: SVG counts y downwards.


def xy(p: Vec) -> str:
    return f"{fixed(p[0])} {fixed(-p[1])}"


def face_path(face: Face) -> str:
    """Returns all loops of a face as one path, its holes really cut out."""
    return "".join(map(_loop_path, face.loops))


def _loop_path(loop: Loop) -> str:
    if loop.is_whole:
        return _whole(loop.pieces[0], clockwise=loop.reversed)
    pieces = loop.pieces
    # The last straight way home is what Z draws.
    drawn = pieces[:-1] if isinstance(pieces[-1], Line) else pieces
    return f"M{xy(pieces[0].ends[0])}{''.join(map(_segment, drawn))}Z"


def open_path(pieces: Sequence[Piece]) -> str:
    """Returns curves one after the other, moving only where one does not start at the end before."""
    path, at = "", None
    for piece in pieces:
        if isinstance(piece, Circle | Ellipse):
            path += _whole(piece, clockwise=False)
            at = None
            continue
        start, end = piece.ends
        path += _segment(piece) if start == at else f"M{xy(start)}{_segment(piece)}"
        at = end
    return path


def _whole(piece: Piece, clockwise: bool) -> str:
    """Returns a closed curve in parts, since an `A` that ends where it starts draws nothing."""
    assert isinstance(piece, Circle | Ellipse)
    if isinstance(piece, Circle):  # written so that its halves end a diameter apart, to the last digit
        x, y, radius = (round(v, 6) for v in (*piece.center, piece.radius))
        piece, count = Circle((x, y), radius), 2
    else:
        count = 4
    stops = [xy(piece.point(k / count)) for k in range(count)]
    way = stops[:0:-1] if clockwise else stops[1:]
    return "M" + f"A{_radii(piece)} 0 {int(clockwise)} ".join([stops[0], *way, stops[0]]) + "Z"


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
    turn = abs(piece.sweep)
    if abs(turn - math.pi) < 0.2 or turn > 1.9 * math.pi:
        # How half a turn bends and where a whole one leads is lost in rounding: go by way of the middle.
        return f"A{_radii(piece)} 0 {flag} {xy(piece.point(0.5))}A{_radii(piece)} 0 {flag} {xy(piece.end)}"
    return f"A{_radii(piece)} {int(turn > math.pi)} {flag} {xy(piece.end)}"


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
    marks = (mark for group in picture.groups for mark in group.marks)
    used = (mark.gradient for mark in marks if isinstance(mark, Area) and mark.gradient is not None)
    shades = {gradient: f"shade-{k}" for k, gradient in enumerate(dict.fromkeys(used), 1)}
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


def _gradient(gradient: Gradient, name: str, svg: Any) -> Any:
    (x0, y0), (x1, y1) = gradient.start, gradient.end
    start, end = (fixed(x0), fixed(-y0)), (fixed(x1), fixed(-y1))
    looks = {"id": name, "gradientUnits": "userSpaceOnUse"}
    if gradient.radius is None:
        made = svg.linearGradient(start, end, **looks)
    else:
        made = svg.radialGradient(start, fixed(gradient.radius), **looks)
    if gradient.height != 1:
        made["gradientTransform"] = (
            f"matrix(1 0 0 {fixed(gradient.height)} 0 {fixed(-y0 * (1 - gradient.height))})"
        )
    for stop in gradient.stops:
        made.add_stop_color(fixed(stop.share), stop.color, None if stop.opacity == 1 else fixed(stop.opacity))
    return made


def _group(svg: Any, group: Group, shades: Mapping[Gradient, str]) -> Any:
    element = svg.g(id=_clean(group.name))
    element.attribs.update({key: _clean(value) for key, value in group.attributes.items()})
    for mark in group.marks:
        checkpoint()
        if isinstance(mark, Area) and mark.gradient is not None:
            mark = replace(mark, fill=f"url(#{shades[mark.gradient]})")
        element.add(_element(mark, svg))
    return element


def _clean(text: str) -> str:
    return _NOT_XML.sub("\ufffd", text)


def _element(mark: Mark, svg: Any) -> Any:
    match mark:
        case Area():
            looks = {"fill": mark.fill or "none", "fill_rule": "evenodd"}
            if mark.opacity != 1:
                looks["fill_opacity"] = fixed(mark.opacity)
            looks |= {"stroke": "none"} if mark.ink is None else _looks(mark.ink, closed=True)
            return svg.path(d=face_path(mark.face), **looks, **_role(mark.role))
        case Curves():
            looks = {"fill": "none"} | _looks(mark.ink)
            return svg.path(d=open_path(mark.pieces), **looks, **_role(mark.role))
        case Text():
            return _text(mark, svg)
        case Dot(at, radius, color):
            center, width = (fixed(at[0]), fixed(-at[1])), fixed(0.3 * radius)
            looks = {"fill": color, "stroke": "#ffffff", "stroke_width": width}
            return svg.circle(center=center, r=fixed(radius), **looks)
        case Frame():
            return _rectangle(mark.box, svg, fill="none", **_looks(mark.ink))


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


def _text(mark: Text, svg: Any) -> Any:
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


def _rectangle(box: Bounds, svg: Any, **looks: str) -> Any:
    left, bottom, right, top = box
    insert, size = (fixed(left), fixed(-top)), (fixed(right - left), fixed(top - bottom))
    return svg.rect(insert=insert, size=size, **looks)
