"""Makes the preview of a view: a picture whose shapes say which element they are, and its data."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import replace

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.drawing_time import TooLongError, within
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.export import Job, Options
from aidl_lang.export.marks import Group
from aidl_lang.export.picture import picture
from aidl_lang.export.svg import face_path, open_path, to_svg
from aidl_lang.geometry.curves import Circle, Piece
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.evaluate import bounds, is_finite
from aidl_lang.geometry.network import union_bounds
from aidl_lang.geometry.solved import SolvedGeometry, SolvedStructure
from aidl_lang.pipeline import Compiled, Settings
from aidl_lang.solver.memory import Memory
from aidl_lang.tools.ide.dragging import Handle, grips, handles, is_somewhere
from aidl_lang.tools.ide.preview.elements import DrawnElement, Elements, curves_of, elements, point_of
from aidl_lang.tools.ide.preview.sliders import conflicts, problems, sliders
from aidl_lang.tools.ide.preview.values import FREEDOM, LAYERS, Preview, Way
from aidl_lang.tools.ide.preview.ways import ways
from aidl_lang.tools.ide.workspace import SETTINGS, View, hasty, run

# --- The picture as SVG whose shapes say which element they are: `data-element`, a number of `elements`.
#
# Above what is painted lie shapes that are not: `hit` for the curves of geometry that was united, cut away
# or only guides, `hit area` for what a structure covers. They follow the order of the bodies, so that what
# lies on top is what is pointed at; within a body the large come before the small.

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


# --- Makes the preview of a view: the picture and the data beside it.

_NOWHERE = (0.0, 0.0, 0.0, 0.0)


def preview(
    view: View, show: Collection[str] = (), *, tried: bool = False, known: Iterable[Handle] = ()
) -> Preview:
    """Returns the preview of a program that was run, with some of LAYERS over it, and FREEDOM if wanted.

    A program that does not draw shows the last one that did, and its own problems. What can be dragged takes
    longer to find out than all the rest (see `with_handles`): here are those that are `known` from another
    picture of it, where they are now.
    """
    assert view.outcome is not None, "the view was not run"
    found = elements(view)
    drawn = view.drawn
    has_picture = drawn is not None and _is_anything_drawn(drawn)
    svg, unpainted = _painted(drawn, found, show) if drawn is not None and has_picture else (None, ())
    return Preview(
        status=_status(view.outcome),
        stale=has_picture and view.is_stale,
        tried=tried,
        seconds=sum(view.outcome.timings.values()),
        svg=svg,
        box=drawn.drawing.box if drawn is not None and drawn.drawing is not None else _NOWHERE,
        elements=found.values,
        knobs=tuple(sliders(view)),
        handles=tuple(_moved(view, known)),
        problems=tuple(problems(view, found, unpainted, tried=tried)),
        conflicts=tuple(conflicts(view, found)),
        ways=tuple(_ways(view, found)) if FREEDOM in show else (),
        degrees=view.outcome.model.degrees if view.outcome.model is not None else None,
    )


def _status(outcome: Compiled) -> str:
    """Returns how a program stands: one that solved may still be `wrong`, as when an `assert` fails."""
    is_wrong = outcome.status == "solved" and bool(outcome.errors)
    return "wrong" if is_wrong else outcome.status


def _painted(
    drawn: Compiled, found: Elements, show: Collection[str]
) -> tuple[str | None, tuple[Diagnostic, ...]]:
    """Returns the SVG; or, if painting takes too long, the diagnostics about that."""
    try:
        with within(drawn.limit, "painting"):
            return svg_of(drawn, found, set(show) & set(LAYERS)), ()
    except TooLongError as reason:
        return None, (reason.diagnostic,)


def with_handles(made: Preview, view: View) -> Preview:
    """Returns the preview with all handles. Raises Cancelled as `run` does."""
    return replace(made, handles=tuple(handles(view)))


def _moved(view: View, known: Iterable[Handle]) -> Iterator[Handle]:
    """Yields those handles that still exist, at their present places."""
    outcome, wanted = view.outcome, {handle.id: handle for handle in known}
    if not wanted or view.is_stale or outcome is None or outcome.built is None or outcome.evaluate is None:
        return
    for grip in grips(outcome.built):
        if grip.id in wanted and is_somewhere(at := grip.at(outcome.evaluate)):
            yield replace(wanted[grip.id], at=at)


def _is_anything_drawn(outcome: Compiled) -> bool:
    if outcome.model is None or outcome.drawing is None:
        return False
    return bool(outcome.drawing.bodies or outcome.drawing.strokes or outcome.model.root.box)


def _ways(view: View, found: Elements) -> Iterator[Way]:
    """Yields the remaining motions; none for the picture of an earlier text."""
    if view.outcome is not None and not view.is_stale:
        yield from ways(view.outcome, found)


def tried(
    view: View,
    knobs: Mapping[str, float | str | bool],
    memory: Memory | None = None,
    settings: Settings = SETTINGS,
    *,
    rests: bool = False,
) -> View:
    """Returns the view with other values of some params; why they do not hold is explained if what changes
    them `rests`. Raises Cancelled as `run` does.
    """
    how = settings if rests else hasty(settings)
    return run(view, view, memory, {**(view.params or {}), **knobs}, how)
