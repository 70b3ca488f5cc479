"""SVG as a language: a text that says where everything is. What it fills and strokes becomes regions."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Mapping, Sequence
from importlib import import_module
from importlib.util import find_spec
from typing import Any
from xml.etree import ElementTree

import numpy as np

from aidl_lang.common.colors import hexadecimal
from aidl_lang.common.records import record
from aidl_lang.geometry.sections import Polygon
from aidl_lang.tools.evaluation import rendering, shapes
from aidl_lang.tools.evaluation.regions import Part, Regions
from aidl_lang.tools.evaluation.rendering import NOTHING, Rendered, RenderedConversation

_LONGEST = 2_000_000
"""Most characters of a program."""
_MOST = 4000
"""Most elements that are drawn."""
_CHORDS = 24
"""Chords of a curved segment."""
_LARGEST = 1e9
_UNREAD = ("text", "image", "mask", "clipPath", "filter", "pattern", "foreignObject", "script", "animate")


@record()
class Svg:
    name: str = "svg"
    suffix: str = ".svg"
    fences: tuple[str, ...] = ("svg", "xml")

    def missing(self) -> str | None:
        return (
            None
            if find_spec("svgelements")
            else "svgelements is not installed (pip install 'aidl-lang[svg]')"
        )

    def guide(self) -> str:
        return rendering.guide(self.name)

    def reads(self, text: str) -> bool:
        return "<svg" in text and render(text).ok

    def conversation(self, before: str | None = None) -> RenderedConversation:
        return RenderedConversation(self)

    def structures(self, program: str) -> int:
        """Counts the groups and symbols of a program."""
        return len(re.findall(r"<(?:g|symbol)\b", program))

    def knobs(self, program: str) -> Mapping[str, float]:
        """SVG has no names for numbers, so nothing can be turned."""
        return {}

    def run(
        self, program: str, edits: Sequence[Mapping[str, float]] = ({},), parted: bool = True
    ) -> list[Rendered]:
        return [render(program) for _ in edits]


def render(program: str) -> Rendered:
    """Reads a drawing. A fill is a part, and so is the stroke of what is not filled; y is turned upwards."""
    if len(program) > _LONGEST:
        return Rendered(errors=(f"error: the program has more than {_LONGEST} characters",))
    if re.search(r"<!(?:DOCTYPE|ENTITY)", program, re.I):
        return Rendered(errors=("error: entities and document types are not read: write everything out",))
    try:
        root = ElementTree.fromstring(program)
    except (ElementTree.ParseError, ValueError, RecursionError) as error:
        return Rendered(errors=(f"error: it is not well-formed XML: {error}",))
    if root.tag.rpartition("}")[2] != "svg":
        return Rendered(errors=("error: the outermost element must be `svg`",))
    warnings = tuple(_unread(root))
    try:
        drawn = Regions(tuple(_parts(program)))
    except (ValueError, TypeError, IndexError, AttributeError, KeyError, RecursionError) as error:
        said = " ".join(str(error).split())[:200]
        return Rendered(errors=(f"error: it cannot be read as SVG: {said or type(error).__name__}",))
    return Rendered(drawn, (), warnings) if drawn else Rendered(errors=(NOTHING,), warnings=warnings)


def _unread(root: ElementTree.Element) -> Iterator[str]:
    """Yields warnings about what is in a drawing and is not seen here."""
    found = dict.fromkeys(element.tag.rpartition("}")[2] for element in root.iter())
    for name in found:
        if name in _UNREAD:
            yield f"warning: `{name}` is left out: only filled and stroked shapes are drawn"


def _parts(program: str) -> Iterator[Part]:
    svg = import_module("svgelements")
    read = svg.SVG.parse(io.StringIO(program), reify=True, ppi=96)
    count = 0
    for element in read.elements(conditional=lambda e: isinstance(e, svg.Shape)):
        if not _is_shown(element):
            continue
        count += 1
        if count > _MOST:
            raise ValueError(f"more than {_MOST} shapes are drawn")
        outlines = [_points(svg, part) for part in svg.Path(element).as_subpaths()]
        filled = _color(element.fill)
        if filled is not None:
            rule = "EvenOdd" if element.values.get("fill-rule") == "evenodd" else "NonZero"
            region = shapes.region([o for o in outlines if len(o) > 2], rule)  # type: ignore[arg-type]
            if region:
                yield Part(region, filled)
        elif (stroked := _color(element.stroke)) is not None and (width := _width(element)) > 0:
            region = shapes.stroked([o for o in outlines if len(o) > 1], width)
            if region:
                yield Part(region, stroked)


def _is_shown(element: Any) -> bool:
    said = element.values
    return said.get("display") != "none" and said.get("visibility") not in ("hidden", "collapse")


def _width(element: Any) -> float:
    return float(element.stroke_width or 0.0)


def _color(color: Any) -> str | None:
    if color is None or color.value is None or color.alpha == 0:
        return None
    return hexadecimal([color.red, color.green, color.blue])


def _points(svg: Any, path: Any) -> Polygon:
    """Returns the points of one part of a path, y upwards; a closed one ends where it begins."""
    found = list[tuple[float, float]]()
    for segment in path:
        if isinstance(segment, svg.Move):
            found.append((segment.end.x, -segment.end.y))
            continue
        straight = isinstance(segment, (svg.Line, svg.Close))
        if segment.end is None or (straight and segment.start == segment.end):
            continue
        for step in (1,) if straight else range(1, _CHORDS + 1):
            point = segment.end if straight else segment.point(step / _CHORDS)
            found.append((point.x, -point.y))
    points = np.array(found, float).reshape(-1, 2)
    if not (np.abs(points) < _LARGEST).all():
        raise ValueError("a coordinate is not a finite number, or too large")
    return points
