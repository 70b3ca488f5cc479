"""The preview beside the text: a picture whose shapes say which element they are, sliders, problems."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from aidl_lang.building.expression import Evaluator, Expression, Place, Unknown
from aidl_lang.building.lower import seen
from aidl_lang.building.model import Model, Structure, convert
from aidl_lang.common.diagnostics import Diagnostic, TooLongError, within
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint
from aidl_lang.export.cuts import extent
from aidl_lang.export.job import Job, Options
from aidl_lang.export.marks import Group
from aidl_lang.export.picture import picture
from aidl_lang.export.svg import face_path, open_path, to_svg
from aidl_lang.geometry.curves import Bounds, Circle, Vec, union_bounds
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.solved import Motion, SolvedGeometry, SolvedStructure
from aidl_lang.pipeline import Compiled, Settings
from aidl_lang.solver.hierarchy import Memory
from aidl_server.ide.dragging import Handle
from aidl_server.ide.dragging.mobility import grips, is_somewhere
from aidl_server.ide.preview.elements import (
    FREEDOM,
    LAYERS,
    DrawnElement,
    Elements,
    Preview,
    Turn,
    Way,
    box_of,
    conflicts,
    curves_of,
    elements,
    point_of,
    problems,
    sliders,
)
from aidl_server.ide.workspace import SETTINGS, Solved, View, hasty, run, solved

# --- The remaining motions as arrows and arcs on the drawing.
#
# A motion of the model gives the velocity of each unknown. The velocities of points follow by changing the
# unknowns a very little and evaluating their places again.

MOST = 40
"""Most motions shown."""
MOST_THINGS = 8
"""Most things of one motion with arrows of their own."""
MOST_POINTS = 40
"""Most points of a thing used for its motion."""
LENGTH = 0.14
"""Length of an arrow, relative to the drawing."""
_ARC = 70.0
"""Sweep of the arc for a turn about a near place, degrees."""
_NUDGE = 1e-6
"""Change of the fastest unknown, relative to the drawing."""
_SLOW = 1e-3
"""Part of the greatest speed below which a point counts as still."""


def ways(solved: Solved, elements: Elements) -> Iterator[Way]:
    motions = solved.model.motions[:MOST]
    if not motions:
        return
    flow = _Flow(solved.built, solved.evaluate, solved.drawing.size)
    for motion in motions:
        things = list(_things(flow, motion, elements))
        fastest = max((math.hypot(*v) for thing in things for v in thing.velocities), default=0.0)
        yield Way(
            _words(motion, elements),
            tuple(elements.all_near(motion.things)),
            tuple(arrow for thing in things for arrow in thing.arrows(motion.kind, _SLOW * fastest)),
            tuple(turn for thing in things for turn in thing.turns(motion.kind)),
        )


def _words(motion: Motion, elements: Elements) -> str:
    """Describes a motion of elements, with the name of the moving point or number of an element."""
    if len(motion.things) != 1 or (number := elements.near(motion.things[0])) is None:
        return motion.words
    inside = motion.things[0].removeprefix(elements.values[number].path).removeprefix(".")
    if not inside:
        return motion.words
    return f"{motion.words} its {inside}" if motion.kind == "change" else f"{motion.words} at its {inside}"


class _Flow:
    """The points of a model with their paths and velocities."""

    def __init__(self, model: Model, evaluate: Evaluator, size: float) -> None:
        self.size = size
        self._model, self._evaluate = model, evaluate
        self._points = [(p, s, x, y) for s in model.root.walk() for p, x, y in _points(s)]
        self._in_root: dict[int, tuple[Expression, Expression]] = {}
        self._unknowns: dict[str, list[Unknown]] = defaultdict(list)
        for unknown in model.unknowns:
            self._unknowns[unknown.path].append(unknown)

    def nudged(self, motion: Motion) -> Evaluator | None:
        """Returns an evaluator of the model after a very little of a motion."""
        fastest = max((abs(rate) for rate in motion.moves.values()), default=0.0)
        if not fastest or not math.isfinite(fastest):
            return None
        step = _NUDGE * self.size / fastest
        values = dict(self._evaluate.values)
        for path, rate in motion.moves.items():
            for unknown in self._unknowns[path]:
                values[unknown] = values.get(unknown, unknown.guess) + step * rate
        return Evaluator(values, self._evaluate.measure)

    def moving(self, nudged: Evaluator, thing: str) -> list[tuple[Vec, Vec]]:
        """Returns points of the thing at a path with their velocities; some of very many."""
        inside = f"{thing}."
        found = [k for k, (path, *_) in enumerate(self._points) if path == thing or path.startswith(inside)]
        moving = []
        for k in found[:: len(found) // MOST_POINTS + 1]:
            x, y = (self._evaluate(e) for e in self._at(k))
            u, v = (nudged(e) for e in self._at(k))
            if all(map(math.isfinite, (x, y, u, v))):
                moving.append(((x, y), (u - x, v - y)))
        return moving

    def _at(self, k: int) -> tuple[Expression, Expression]:
        if k not in self._in_root:
            _, structure, x, y = self._points[k]
            self._in_root[k] = convert(Place(x, y), structure, self._model.root)
        return self._in_root[k]


def _points(structure: Structure) -> Iterator[tuple[str, Expression, Expression]]:
    """Yields points of a structure's own geometry, in its frame, and two on each circle."""
    center: tuple[str, Expression, Expression] | None = None
    for _, path, numbers in seen(structure):
        if len(numbers) == 2:
            yield path, *numbers
        holder, _, name = path.rpartition(".")
        if name == "center" and len(numbers) == 2:
            center = holder, *numbers
        elif name == "radius" and center is not None and center[0] == holder:
            _, x, y = center
            yield path, x + numbers[0], y
            yield path, x - numbers[0], y


@record()
class _Thing:
    """Moving points of a thing. `velocity` is their mean; `spin` radians about the `middle` in that time."""

    box: Bounds
    places: Sequence[Vec]
    velocities: Sequence[Vec]
    size: float

    @property
    def center(self) -> Vec:
        return (self.box[0] + self.box[2]) / 2, (self.box[1] + self.box[3]) / 2

    @property
    def middle(self) -> Vec:
        return _mean(self.places)

    @property
    def velocity(self) -> Vec:
        return _mean(self.velocities)

    @property
    def spin(self) -> float:
        x, y = self.middle
        u, v = self.velocity
        turning = spread = 0.0
        for (px, py), (vx, vy) in zip(self.places, self.velocities, strict=True):
            turning += (px - x) * (vy - v) - (py - y) * (vx - u)
            spread += (px - x) ** 2 + (py - y) ** 2
        return turning / spread if spread > 1e-12 * self.size**2 else 0.0

    @property
    def is_turning(self) -> bool:
        reach = math.hypot(self.box[2] - self.box[0], self.box[3] - self.box[1]) / 2
        return abs(self.spin) * reach > math.hypot(*self.velocity)

    def arrows(self, kind: str, slow: float) -> Iterator[Mapping[str, Vec]]:
        """Yields an arrow for a slide; for growth, some outwards. Points slower than `slow` stand still."""
        if kind == "turn" or (kind == "together" and self.is_turning):
            return
        if kind in ("slide", "together") and math.hypot(*self.velocity) > slow:
            yield self._arrow(self.center, self.velocity)
            return
        moving = sorted(
            zip(self.velocities, self.places, strict=True), key=lambda each: -math.hypot(*each[0])
        )
        if not moving or math.hypot(*moving[0][0]) <= slow:
            return
        (first, at), others = moving[0], moving[1:]
        yield self._arrow(at, first)
        for velocity, place in others:
            along = velocity[0] * first[0] + velocity[1] * first[1]
            if along < -0.5 * math.hypot(*velocity) * math.hypot(*first) < 0:
                yield self._arrow(place, velocity)
                return

    def turns(self, kind: str) -> Iterator[Turn]:
        spin = self.spin
        if not spin or not (kind == "turn" or (kind == "together" and self.is_turning)):
            return
        (x, y), (u, v) = self.middle, self.velocity
        pole = x - v / spin, y + u / spin
        away = self.center[0] - pole[0], self.center[1] - pole[1]
        reach = max(self.box[2] - self.box[0], self.box[3] - self.box[1]) / 2
        distance = math.hypot(*away)
        if distance <= reach:  # about a place in it: around all of it
            radius, sweep, towards = max(0.7 * reach, 0.05 * self.size), _ARC, 90.0
        else:
            radius, sweep = distance, min(_ARC, math.degrees(1.5 * LENGTH * self.size / distance))
            towards = math.degrees(math.atan2(away[1], away[0]))
        sweep = math.copysign(sweep, spin)
        yield Turn(pole, radius, towards - sweep / 2, sweep)

    def _arrow(self, at: Vec, velocity: Vec) -> Mapping[str, Vec]:
        speed = math.hypot(*velocity)
        length = LENGTH * self.size / speed
        return {"from": at, "to": (at[0] + length * velocity[0], at[1] + length * velocity[1])}


def _things(flow: _Flow, motion: Motion, elements: Elements) -> Iterator[_Thing]:
    nudged = flow.nudged(motion)
    if nudged is None:
        return
    for path in motion.things[:MOST_THINGS]:
        moving = flow.moving(nudged, path)
        number = elements.number.get(path)  # else it is a point, or a number, of something
        if not moving and (number := elements.near(path)) is not None:
            moving = flow.moving(nudged, elements.values[number].path)
        if moving:
            box = box_of(elements.drawn[number].model) if number is not None else None
            places, velocities = [place for place, _ in moving], [velocity for _, velocity in moving]
            box = box or union_bounds([(*place, *place) for place in places])
            yield _Thing(box, places, velocities, flow.size)


def _mean(vectors: Sequence[Vec]) -> Vec:
    return sum(v[0] for v in vectors) / len(vectors), sum(v[1] for v in vectors) / len(vectors)


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
    painted = picture(Job(outcome.model, outcome.drawing, options=layered(show)))
    groups = tuple(_numbered(group, elements) for group in painted.groups)
    text = to_svg(replace(painted, groups=groups))
    assert text.endswith(_END)
    # Only numbers, so nothing needs escaping: not worth a tree of objects.
    return text.removesuffix(_END) + "".join(hit.svg for hit in hits(outcome.drawing, elements)) + _END


def layered(show: Collection[str]) -> Options:
    """Returns the options for a picture with some of LAYERS over it."""
    return Options(frozenset(LAYERS).intersection(show) - {_DIMENSIONS}, dimension=_DIMENSIONS in show)


def _numbered(group: Group, elements: Elements) -> Group:
    number = elements.number.get(group.attributes.get("data-path", ""))
    more = {} if number is None else {"data-element": str(number)}
    return replace(group, attributes={**group.attributes, **more})


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
        areas = [_area(number, drawn, drawing) for number, drawn in members]
        lines = [_lines(number, drawn, elements) for number, drawn in members]
        dots = [_dot(number, drawn, POINT * drawing.size) for number, drawn in members]
        for found in (areas, lines, dots):
            yield from sorted(filter(None, found), key=lambda hit: -hit.extent)


def _body_of(drawn: DrawnElement, bodies: Mapping[str, int]) -> int:
    """Returns the index of an element's body; the last for drawings, which are painted last."""
    path = drawn.owner.path
    while drawn.owner.kind != "drawing" and path:
        if path in bodies:
            return bodies[path]
        path = path.rpartition(".")[0]
    return len(bodies)


def _area(number: int, drawn: DrawnElement, drawing: Drawing) -> PointedShape | None:
    is_structure = isinstance(drawn.model, SolvedStructure)
    region = drawing.regions.get(drawn.element.path) if is_structure else None
    if not region:
        return None
    outlines = (piece for face in region.faces for piece in face.outer.pieces)
    path = "".join(map(face_path, region.faces))
    return PointedShape(number, path, extent(outlines), is_area=True)


def _lines(number: int, drawn: DrawnElement, elements: Elements) -> PointedShape | None:
    """Returns the curves of a geometry, unless they are elements of their own."""
    geometry = drawn.model
    if isinstance(geometry, SolvedStructure):
        return None
    if any(part.path in elements.number for part in geometry.parts):
        return None
    pieces = [piece for piece in curves_of(geometry) if piece.is_finite()]
    return PointedShape(number, open_path(pieces), extent(pieces)) if pieces else None


def _dot(number: int, drawn: DrawnElement, radius: float) -> PointedShape | None:
    at = point_of(drawn.model) if isinstance(drawn.model, SolvedGeometry) else None
    return None if at is None else PointedShape(number, open_path([Circle(at, radius)]), radius)


# --- Makes the preview of a view: the picture and the data beside it.


def preview(
    view: View, show: Collection[str] = (), *, tried: bool = False, known: Iterable[Handle] = ()
) -> Preview:
    """Returns the preview of a program that was run, with some of LAYERS over it, and FREEDOM if wanted.

    A program that does not draw shows the last one that did, and its own problems. What can be dragged takes
    longer to find out than all the rest (see `handles`): here are those that are `known` from another
    picture of it, where they are now.
    """
    assert view.outcome is not None, "the view was not run"
    found = elements(view)
    drawn = solved(view.drawn)
    has_picture = drawn is not None and bool(
        drawn.drawing.bodies or drawn.drawing.strokes or drawn.model.root.box
    )
    svg: str | None = None
    unpainted: tuple[Diagnostic, ...] = ()
    if drawn is not None and has_picture:
        try:
            with within(drawn.outcome.limit, "painting"):
                svg = svg_of(drawn.outcome, found, show)
        except TooLongError as reason:
            unpainted = (reason.diagnostic,)
    # How a program stands: one that solved may still be `wrong`, as when an `assert` fails.
    is_wrong = view.outcome.status == "solved" and bool(view.outcome.errors)
    return Preview(
        status=("wrong" if is_wrong else view.outcome.status),
        stale=has_picture and view.is_stale,
        tried=tried,
        seconds=sum(view.outcome.timings.values()),
        svg=svg,
        box=drawn.drawing.box if drawn is not None else (0.0, 0.0, 0.0, 0.0),
        elements=found.values,
        knobs=tuple(sliders(view)),
        handles=tuple(_moved(view, known)),
        problems=tuple(problems(view, found, unpainted, tried=tried)),
        conflicts=tuple(conflicts(view, found)),
        motions=tuple(ways(view.solved, found)) if FREEDOM in show and view.solved is not None else (),
        degrees=view.solved.model.degrees if view.solved is not None else None,
    )


def _moved(view: View, known: Iterable[Handle]) -> Iterator[Handle]:
    solved, wanted = view.solved, {handle.id: handle for handle in known}
    if solved is None or not wanted:
        return
    for grip in grips(solved.built):
        if grip.id in wanted and is_somewhere(at := grip.at(solved.evaluate)):
            yield replace(wanted[grip.id], at=at)


def tried(
    view: View,
    knobs: Mapping[str, float | str | bool],
    memory: Memory | None = None,
    settings: Settings = SETTINGS,
    *,
    rests: bool = False,
) -> View:
    """Returns the view with other params; failures are explained if what changes them `rests`."""
    how = settings if rests else hasty(settings)
    return run(view, view, memory, {**(view.params or {}), **knobs}, how)
