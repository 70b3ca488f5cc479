"""The picture as SVG whose shapes say which element they are: `data-element`, a number of `elements`.

Above what is painted lie shapes that are not: `hit` for the curves of geometry that was united, cut away or
only guides, `hit area` for what a structure covers. They follow the order of the bodies, so that what lies on
top is what is pointed at; within a body the large come before the small.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import replace

from aidl_lang.common.cancelling import checkpoint
from aidl_lang.common.records import record
from aidl_lang.export import Job, Options
from aidl_lang.export.marks import Group
from aidl_lang.export.paths import face_path, open_path
from aidl_lang.export.picture import picture
from aidl_lang.export.svg import to_svg
from aidl_lang.geometry.curves import Circle, Piece
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.evaluate import bounds, is_finite
from aidl_lang.geometry.network import union_bounds
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.ide.preview.elements import DrawnElement, Elements, curves_of, point_of

POINT = 0.006
"""Radius of what stands for a point, relative to the drawing."""
_DIMENSIONS = "dimensions"
_END = "</svg>\n"


def svg_of(outcome: Compiled, elements: Elements, show: Collection[str] = ()) -> str:
    """Returns the SVG of a drawing with some of LAYERS over it."""
    assert outcome.model is not None
    assert outcome.drawing is not None
    options = Options(frozenset(show) - {_DIMENSIONS}, dimension=_DIMENSIONS in show)
    job = Job(outcome.model, outcome.drawing, options=options)
    painted = picture(job)
    groups = tuple(_numbered(group, elements) for group in painted.groups)
    text = to_svg(replace(painted, groups=groups))
    assert text.endswith(_END)
    # Only numbers, so nothing needs escaping: not worth a tree of objects.
    return text.removesuffix(_END) + "".join(hit.svg for hit in hits(outcome.drawing, elements)) + _END


def _numbered(group: Group, elements: Elements) -> Group:
    """Returns the group of a structure with its number."""
    number = elements.number.get(group.attributes.get("data-path", ""))
    if number is None:
        return group
    return replace(group, attributes={**group.attributes, "data-element": str(number)})


@record()
class PointedShape:
    """A shape by which an element is pointed at: `path` is SVG path data, `extent` the larger side."""

    element: int
    path: str
    extent: float
    is_area: bool = False

    @property
    def svg(self) -> str:
        kind = "hit area" if self.is_area else "hit"
        rule = ' fill-rule="evenodd"' if self.is_area else ""
        return f'<path class="{kind}" data-element="{self.element}" fill="none"{rule} d="{self.path}"/>\n'


def hits(drawing: Drawing, elements: Elements) -> Iterator[PointedShape]:
    """Yields the shapes to point at, body by body, those that belong to no body last."""
    bodies = {body.path: k for k, body in enumerate(drawing.bodies)}
    of_body: list[list[tuple[int, DrawnElement]]] = [[] for _ in range(len(bodies) + 1)]
    for number, drawn in enumerate(elements.drawn):
        checkpoint()
        of_body[_body_of(drawn, bodies)].append((number, drawn))
    for members in of_body:
        yield from _large_first(members, lambda k, drawn: _area(k, drawn, drawing))
        yield from _large_first(members, lambda k, drawn: _lines(k, drawn, elements))
        yield from _large_first(members, lambda k, drawn: _dot(k, drawn, POINT * drawing.size))


def _body_of(drawn: DrawnElement, bodies: Mapping[str, int]) -> int:
    """Returns the index of an element's body; the last for drawings, which are painted last."""
    path = drawn.owner.path
    while drawn.owner.kind != "drawing" and path:
        if path in bodies:
            return bodies[path]
        path = path.rpartition(".")[0]
    return len(bodies)


def _large_first(
    members: Iterable[tuple[int, DrawnElement]], shape: Callable[[int, DrawnElement], PointedShape | None]
) -> list[PointedShape]:
    found = (hit for number, drawn in members if (hit := shape(number, drawn)) is not None)
    return sorted(found, key=lambda hit: -hit.extent)


def _area(number: int, drawn: DrawnElement, drawing: Drawing) -> PointedShape | None:
    """Returns the area that a structure covers."""
    is_structure = isinstance(drawn.model, SolvedStructure)
    region = drawing.regions.get(drawn.element.path) if is_structure else None
    if not region:
        return None
    extent = _extent(piece for face in region.faces for piece in face.outer.pieces)
    return PointedShape(number, "".join(map(face_path, region.faces)), extent, is_area=True)


def _lines(number: int, drawn: DrawnElement, elements: Elements) -> PointedShape | None:
    """Returns the curves of a geometry, unless they are elements of their own."""
    geometry = drawn.model
    if isinstance(geometry, SolvedStructure):
        return None
    if any(part.path in elements.number for part in geometry.parts):
        return None
    pieces = [piece for piece in curves_of(geometry) if is_finite(piece)]
    return PointedShape(number, open_path(pieces), _extent(pieces)) if pieces else None


def _dot(number: int, drawn: DrawnElement, radius: float) -> PointedShape | None:
    """Returns the dot of a point."""
    at = point_of(drawn.model) if isinstance(drawn.model, SolvedGeometry) else None
    return None if at is None else PointedShape(number, open_path([Circle(at, radius)]), radius)


def _extent(pieces: Iterable[Piece]) -> float:
    left, bottom, right, top = union_bounds([bounds(piece) for piece in pieces])
    return max(right - left, top - bottom)
