"""The dimensions that a drawing of a solved model should state: of geometry, of constraints, of the whole.

A dimension measures what is drawn: a size that nothing drawn has is not stated.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from aidl_lang.building.expression import Evaluator, Expression
from aidl_lang.building.model import Model, Structure
from aidl_lang.building.state import ParamBinding, Scope
from aidl_lang.building.values import Num
from aidl_lang.geometry.curves import LARGEST, NO_LENGTH, Arc, Circle
from aidl_lang.geometry.dimensions.constraints import Scene, by_hand, stated_lengths
from aidl_lang.geometry.dimensions.features import (
    X_AXIS,
    Y_AXIS,
    field_sizes,
    left_of,
    length_along,
    pattern_pitches,
)
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness, SolvedModel

RANKS = ("hand", "param", "overall", "constraint", "size", "pattern")
"""Origins of dimensions, the more important first."""


def sizes(model: Model, solved: SolvedModel, evaluate: Evaluator) -> tuple[Dimension, ...]:
    """Returns the dimensions that the program states: exact sizes, what constraints measure, kept sizes."""
    names = _param_names(model.root)
    scene, fields = Scene(model, solved, evaluate, names), field_sizes(model, solved, evaluate, names)
    found = [*by_hand(model, scene), *fields, *stated_lengths(model, scene)]
    found = [d for d in found if abs(d.value) <= LARGEST]  # of what has a place
    return tuple(sorted(found, key=lambda d: RANKS.index(d.origin)))


def _param_names(root: Structure) -> dict[Expression, str]:
    """Returns the params by their numbers: one that is passed on as it is stays the same expression."""
    names: dict[Expression, str] = {}
    for structure in root.walk():
        assert isinstance(structure.scope, Scope)
        for scope in structure.scope.chain():
            for name, binding in scope.values.items():
                if isinstance(binding, ParamBinding) and isinstance(binding.known, Num):
                    names[binding.known.expression] = name
    return names


def dimensions(model: SolvedModel, drawing: Drawing) -> list[tuple[Dimension, ...]]:
    """Returns all dimensions, each place once; equal ones of one group stand together and are to be shown
    once. The more important come first, that of the whole before all.
    """
    tolerance = 1e-6 * drawing.size
    stated = _grouped([*overall(drawing), *left_of(model.sizes, model.root)], tolerance)
    # A diameter tells width and height of what is round.
    rounds = [g[0].curve for g in stated if isinstance(g[0], Roundness) and isinstance(g[0].curve, Circle)]
    stated = [
        g for g in stated if g[0].origin != "overall" or not any(_spans(c, g[0], tolerance) for c in rounds)
    ]
    everything = [d for g in stated for d in g]
    everything += [d for g in stated for d in pattern_pitches(g, tolerance)]
    return sorted(_grouped(everything, tolerance), key=lambda g: not _is_overall(g[0], drawing))


def _grouped(found: Iterable[Dimension], tolerance: float) -> list[tuple[Dimension, ...]]:
    groups: dict[object, list[Dimension]] = {}
    places: set[object] = set()
    for dimension in sorted(found, key=lambda d: RANKS.index(d.origin)):
        place = _place(dimension, tolerance)
        if dimension.value > NO_LENGTH and place not in places:
            places.add(place)
            key = (dimension.group or place, type(dimension), round(dimension.value / tolerance))
            groups.setdefault(key, []).append(dimension)
    return [tuple(g) for g in groups.values()]


def _spans(circle: Circle | Arc, whole: Dimension, tolerance: float) -> bool:
    assert isinstance(whole, Length)
    middle = circle.center[0] * whole.along[0] + circle.center[1] * whole.along[1]
    start = whole.start[0][0] * whole.along[0] + whole.start[0][1] * whole.along[1]
    same = abs(2 * circle.radius - whole.value) <= tolerance
    return same and abs(middle - circle.radius - start) <= tolerance


def overall(drawing: Drawing) -> Iterator[Length]:
    """Yields width and height of all that is drawn."""
    curves = [p for b in drawing.bodies for loop in b.region.loops for p in loop.pieces]
    curves += [p for stroke in drawing.strokes for p in stroke.pieces]
    if curves:
        for along in (X_AXIS, Y_AXIS):
            yield replace(length_along(curves, along), origin="overall")


def _is_overall(dimension: Dimension, drawing: Drawing) -> bool:
    if not isinstance(dimension, Length) or dimension.along not in (X_AXIS, Y_AXIS):
        return False
    axis = int(dimension.along == Y_AXIS)
    whole = drawing.box[axis + 2] - drawing.box[axis]
    return abs(dimension.value - whole) <= 1e-6 * drawing.size


def _place(dimension: Dimension, tolerance: float) -> object:
    """Returns a key that dimensions of the same place share."""

    def rounded(numbers: Iterable[float]) -> tuple[int, ...]:
        return tuple(round(n / tolerance) for n in numbers)

    match dimension:
        case Length(start=start, end=end, along=(u, v)):
            ends = sorted(p[0] * u + p[1] * v for p in (start[0], end[0]))
            across = [] if (u, v) in (X_AXIS, Y_AXIS) else [p[1] * u - p[0] * v for p in (start[0], end[0])]
            return Length, rounded([*ends, *across, u * 100 * tolerance, v * 100 * tolerance])
        case Roundness(curve=curve):
            return Roundness, rounded([*curve.center, curve.radius])
        case Opening(corner=corner, first=first, value=value):
            return Opening, rounded(corner), round(first * 100), round(value * 100)
        case _:
            raise TypeError(dimension)
