"""SVG: millimetres or inches, y upwards, one group per structure, holes really cut, curves as curves."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping
from dataclasses import replace
from functools import singledispatch
from typing import Any

from aidl_lang.common.cancelling import checkpoint
from aidl_lang.common.numbers import fixed
from aidl_lang.export import UNITS
from aidl_lang.export.marks import Area, Curves, Dot, Frame, Gradient, Group, Ink, Mark, Picture, Text
from aidl_lang.export.paths import face_path, open_path
from aidl_lang.export.scaling import scaled
from aidl_lang.export.svg_package import svgwrite
from aidl_lang.geometry.evaluate import Bounds

FONT = "DejaVu Sans, Verdana, Arial, sans-serif"

_NOT_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def to_svg(picture: Picture, pixels: tuple[int, int] | None = None, units: str = "mm") -> str:
    """Returns the picture as an SVG document in its true size, or so many pixels wide and high. Its
    coordinates are in `units`.
    """
    svg = svgwrite()
    if units != "mm":
        picture = scaled(picture, 1 / UNITS[units])
    left, _, _, top = picture.box
    width, height = fixed(picture.width), fixed(picture.height)
    document = svg.Drawing(
        size=pixels or (f"{width}{units}", f"{height}{units}"),
        viewBox=f"{fixed(left)} {fixed(-top)} {width} {height}",
        debug=False,
    )
    boxes = dict.fromkeys(group.clip for group in picture.groups if group.clip is not None)
    clips = {box: f"clip-{k}" for k, box in enumerate(boxes, 1)}
    for clip, name in clips.items():
        path = svg.masking.ClipPath(id=name, debug=False)
        path.add(_rectangle(clip, svg))
        document.defs.add(path)
    shades = _shades(picture)
    for gradient, name in shades.items():
        document.defs.add(_gradient(gradient, name, svg))
    for group in picture.groups:
        element = _group(svg, group, shades)
        if group.clip is not None:
            element["clip-path"] = f"url(#{clips[group.clip]})"
        document.add(element)
    text = io.StringIO()
    document.write(text)
    # One element per line. Text is escaped, so this pattern stands between tags only.
    return text.getvalue().replace("><", ">\n<") + "\n"


def _shades(picture: Picture) -> dict[Gradient, str]:
    """Returns the names of the gradients of a picture, in order of use."""
    marks = (mark for group in picture.groups for mark in group.marks)
    used = (mark.gradient for mark in marks if isinstance(mark, Area) and mark.gradient is not None)
    return {gradient: f"shade-{k}" for k, gradient in enumerate(dict.fromkeys(used), 1)}


def _gradient(gradient: Gradient, name: str, svg: Any) -> Any:
    (x0, y0), (x1, y1) = gradient.start, gradient.end
    start, end = (fixed(x0), fixed(-y0)), (fixed(x1), fixed(-y1))
    looks = {"id": name, "gradientUnits": "userSpaceOnUse", "debug": False}
    made = (
        svg.gradients.LinearGradient(start, end, **looks)
        if gradient.radius is None
        else svg.gradients.RadialGradient(start, fixed(gradient.radius), **looks)
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
    element = svg.container.Group(id=_clean(group.name), debug=False)
    element.attribs.update(attributes)
    for mark in group.marks:
        checkpoint()
        if isinstance(mark, Area) and mark.gradient is not None:
            mark = replace(mark, fill=f"url(#{shades[mark.gradient]})")
        element.add(_element(mark, svg))
    return element


def _clean(text: str) -> str:
    """Removes the characters that XML cannot hold."""
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
    return svg.path.Path(d=face_path(mark.face), **looks, **_role(mark.role), debug=False)


@_element.register
def _(mark: Curves, svg: Any) -> Any:
    looks = {"fill": "none"} | _looks(mark.ink)
    return svg.path.Path(d=open_path(mark.pieces), **looks, **_role(mark.role), debug=False)


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
    text = svg.text.Text(_clean(mark.text), insert=at, **looks, debug=False)
    if not mark.halo:
        return text
    # The halo is a text of its own below: not every renderer knows `paint-order`.
    looks |= {"fill": "#ffffff", "stroke": "#ffffff", "stroke_width": fixed(0.22 * mark.size)}
    halo = svg.text.Text(_clean(mark.text), insert=at, stroke_linejoin="round", **looks, debug=False)
    halo["aria-hidden"] = "true"
    both = svg.container.Group(debug=False)
    both.add(halo)
    both.add(text)
    return both


@_element.register
def _(mark: Dot, svg: Any) -> Any:
    return svg.shapes.Circle(
        center=(fixed(mark.at[0]), fixed(-mark.at[1])),
        r=fixed(mark.radius),
        fill=mark.color,
        stroke="#ffffff",
        stroke_width=fixed(0.3 * mark.radius),
        debug=False,
    )


@_element.register
def _(mark: Frame, svg: Any) -> Any:
    ink = Ink(mark.color, mark.width, (mark.dash, 0.7 * mark.dash) if mark.dash else None)
    return _rectangle(mark.box, svg, fill="none", **_looks(ink))


def _rectangle(box: Bounds, svg: Any, **looks: str) -> Any:
    left, bottom, right, top = box
    insert, size = (fixed(left), fixed(-top)), (fixed(right - left), fixed(top - bottom))
    return svg.shapes.Rect(insert=insert, size=size, **looks, debug=False)
