"""SVG as a language: a text that says where everything is. What it fills and strokes becomes regions."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Any
from xml.etree import ElementTree

import numpy as np

from aidl_eval import rendering, shapes
from aidl_eval.regions import Regions
from aidl_eval.rendering import NOTHING, Rendered, RenderedLanguage
from aidl_lang.geometry.region import Polygon, Region

_LONGEST = 2_000_000
"""Most characters of a program."""
_MOST, _NUMBERS = 4000, 20_000
"""Most elements, with what `use` repeats, and most numbers in the outlines of them all."""
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_AROUND, _CHORDS = 96, 24
"""Chords of a whole circle, and of any other curved segment."""
_UNREAD = ("text", "image", "mask", "clipPath", "filter", "pattern", "foreignObject", "script", "animate")


@dataclass(frozen=True)
class Svg(RenderedLanguage):
    name: str = "svg"
    suffix: str = ".svg"
    fences: tuple[str, ...] = ("svg", "xml")

    def missing(self) -> str | None:
        why = "svgelements is not installed (pip install 'aidl-eval[svg]')"
        return None if find_spec("svgelements") else why

    def reads(self, text: str) -> bool:
        return "<svg" in text and render(text).ok

    def structures(self, program: str) -> int:
        """Counts the groups and symbols of a program."""
        return len(re.findall(r"<(?:g|symbol)\b", program))

    def knobs(self, program: str) -> Mapping[str, float]:
        """SVG has no names for numbers, so nothing can be turned."""
        return {}

    def run(self, program: str, edits: Sequence[Mapping[str, float]] = ({},)) -> list[Rendered]:
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
    if reason := _excess(root):
        return Rendered(errors=(f"error: {reason}",))
    try:
        drawn = Regions(tuple(_parts(program)))
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        said = " ".join(str(error).split())[:200]
        return Rendered(errors=(f"error: it cannot be read as SVG: {said or type(error).__name__}",))
    return Rendered(drawn, (), warnings) if drawn else Rendered(errors=(NOTHING,), warnings=warnings)


def _unread(root: ElementTree.Element) -> Iterator[str]:
    """Yields warnings about what is in a drawing and is not seen here."""
    found = dict.fromkeys(element.tag.rpartition("}")[2] for element in root.iter())
    for name in found:
        if name in _UNREAD:
            yield f"warning: `{name}` is left out: only filled and stroked shapes are drawn"


def _excess(root: ElementTree.Element) -> str | None:
    """Returns the reason why a drawing is too large to be read: `use` repeats elements, maybe without end."""
    named = {name: element for element in root.iter() if (name := element.get("id"))}
    sizes = dict[ElementTree.Element, tuple[int, int] | None]()

    def size(element: ElementTree.Element) -> tuple[int, int]:
        """Returns how many elements and numbers of outlines it stands for."""
        if element in sizes:
            if (known := sizes[element]) is None:
                raise ValueError("a `use` repeats what it is in itself")
            return known
        sizes[element] = None
        held = list(element)
        if element.tag.rpartition("}")[2] == "use":
            link = element.get("href") or element.get("{http://www.w3.org/1999/xlink}href") or ""
            held += [named[link[1:]]] if link[1:] in named else []
        counts = [size(one) for one in held]
        own = sum(len(_NUMBER.findall(element.get(name, ""))) for name in ("d", "points"))
        found = 1 + sum(elements for elements, _ in counts), own + sum(numbers for _, numbers in counts)
        sizes[element] = found
        return found

    try:
        elements, numbers = size(root)
    except ValueError as reason:
        return str(reason)
    except RecursionError:
        return "elements are nested too deep"
    if elements > _MOST:
        return f"there are more than {_MOST} elements"
    return f"outlines have more than {_NUMBERS} numbers" if numbers > _NUMBERS else None


def _parts(program: str) -> Iterator[Region]:
    svg = import_module("svgelements")
    read = svg.SVG.parse(io.StringIO(program), reify=True, ppi=96)
    for element in read.elements(conditional=lambda e: isinstance(e, svg.Shape)):
        if not _is_shown(element):
            continue
        outlines = [_points(svg, part) for part in svg.Path(element).as_subpaths()]
        if _is_ink(element.fill):
            rule = "EvenOdd" if element.values.get("fill-rule") == "evenodd" else "NonZero"
            region = shapes.region([o for o in outlines if len(o) > 2], rule)  # type: ignore[arg-type]
        elif _is_ink(element.stroke) and (width := float(element.stroke_width or 0.0)) > 0:
            cap = element.values.get("stroke-linecap", "butt")
            region = shapes.stroked([o for o in outlines if len(o)], width, cap)
        else:
            continue
        if region:
            yield region


def _chords(svg: Any, segment: Any) -> int:
    if not isinstance(segment, svg.Arc):
        return _CHORDS
    turn = abs(float(segment.sweep)) / math.tau
    return max(1, math.ceil(_AROUND * turn - 1e-6)) if math.isfinite(turn) else 1


def _is_shown(element: Any) -> bool:
    said = element.values
    return said.get("display") != "none" and said.get("visibility") not in ("hidden", "collapse")


def _is_ink(color: Any) -> bool:
    return color is not None and color.value is not None and color.alpha != 0


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
        count = 1 if straight else _chords(svg, segment)
        for step in range(1, count + 1):
            point = segment.end if step == count else segment.point(step / count)
            found.append((point.x, -point.y))
    points = np.array(found, float).reshape(-1, 2)
    if not (np.abs(points) < rendering.LARGEST).all():
        raise ValueError("a coordinate is not a finite number, or too large")
    return points
