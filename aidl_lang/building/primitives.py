"""The numbers and points that define a primitive, seen from any structure (language reference: geometry).

A primitive stores what defines it in the frame of its owner; `view` converts that to the frame of the
structure that asks, and everything else a primitive is asked for follows from the view (see `curves`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Expression
from aidl_lang.building.model import (
    Geometry,
    Structure,
    chain,
    common_ancestor,
    convert_angle,
    convert_point,
    own_geometry,
)
from aidl_lang.building.values import ListVal, Num, PointVal, point
from aidl_lang.checking.registry import fields_of
from aidl_lang.checking.units import ANGLE
from aidl_lang.common.font_files import Vec

if TYPE_CHECKING:
    from aidl_lang.building.values import Value

DIRECTIONS = fields_of("direction")
"""Fields that are directions: they turn with the frame they are seen from."""


def translate(name: str, value: Value, owner: Structure, here: Structure) -> Value:
    """Returns a value read in the frame of `owner`, as `here` sees it, alone or in a list: points and
    directions turn, lengths do not.
    """
    if owner is here:
        return value
    if isinstance(value, PointVal):
        return convert_point(value, owner, here)
    if isinstance(value, ListVal):
        return ListVal(tuple(translate(name, item, owner, here) for item in value.items))
    if isinstance(value, Num) and name in DIRECTIONS:
        return Num(convert_angle(value.expression, owner, here), ANGLE, value.status)
    return value


def is_reflected(owner: Structure, here: Structure) -> bool:
    """Tells whether an odd number of mirrored frames lies between the two."""
    if owner is here:
        return False
    meeting = common_ancestor(owner, here)
    flips = 0
    for start in (owner, here):
        path = chain(start)
        flips += sum(s.frame.mirrored for s in path[: path.index(meeting)])
    return flips % 2 == 1


def view(geometry: Geometry, here: Structure) -> dict[str, Value]:
    """Returns the numbers and points that define a primitive, in the frame of `here`."""
    if geometry.owner is here:
        return geometry.fields
    if (known := geometry.views.get(here)) is None:
        known = {n: translate(n, v, geometry.owner, here) for n, v in geometry.fields.items()}
        geometry.views[here] = known
    return known


def clockwise(geometry: Geometry, here: Structure) -> bool:
    """Returns the sense of an arc as `here` sees it."""
    return geometry.clockwise != is_reflected(geometry.owner, here)


def xy(value: Value) -> tuple[Expression, Expression]:
    assert isinstance(value, PointVal)
    return value.x.expression, value.y.expression


def number(value: Value) -> Expression:
    assert isinstance(value, Num)
    return value.expression


def direction(a: Value, b: Value) -> Expression:
    """Returns the direction from one point to another in degrees."""
    (ax, ay), (bx, by) = xy(a), xy(b)
    return ex.atan2(ex.sub(by, ay), ex.sub(bx, ax))


def distance(a: Value, b: Value) -> Expression:
    (ax, ay), (bx, by) = xy(a), xy(b)
    return ex.apply("hypot", ex.sub(bx, ax), ex.sub(by, ay))


def sweep(core: Mapping[str, Value], is_clockwise: bool) -> Expression:
    """Returns the degrees from the start of an arc to its end, in its own sense; 0 to 360."""
    start, end = direction(core["center"], core["start"]), direction(core["center"], core["end"])
    turn = ex.sub(start, end) if is_clockwise else ex.sub(end, start)
    return ex.apply("mod", turn, ex.constant(360.0))


def polar(center: Value, radius: Expression, angle: Expression) -> PointVal:
    x, y = xy(center)
    return point(ex.add(x, ex.mul(radius, ex.cos(angle))), ex.add(y, ex.mul(radius, ex.sin(angle))))


def on_text(geometry: Geometry, here: Structure) -> Callable[[Vec], tuple[Expression, Expression]]:
    """Returns a function from units of the height of a text, or of a drawing, to the frame of `here`."""
    core = view(geometry, here)
    unit = "height" if geometry.trace is None else "unit"
    (x, y), height, angle = xy(core["start"]), number(core[unit]), number(core["angle"])
    along = ex.mul(height, ex.cos(angle)), ex.mul(height, ex.sin(angle))
    up = -1.0 if clockwise(geometry, here) else 1.0

    def at(p: Vec) -> tuple[Expression, Expression]:
        u, v = ex.constant(p[0]), ex.constant(up * p[1])
        return (
            ex.add(x, ex.sub(ex.mul(along[0], u), ex.mul(along[1], v))),
            ex.add(y, ex.add(ex.mul(along[1], u), ex.mul(along[0], v))),
        )

    return at


def defining(geometry: Geometry, here: Structure) -> list[Expression]:
    """Returns every number that defines a geometry, compound ones through their parts and arguments."""
    found: list[Expression] = []
    for value in view(geometry, here).values():
        if isinstance(value, Num):
            found.append(value.expression)
        elif isinstance(value, PointVal):
            found += [value.x.expression, value.y.expression]
    for part in own_geometry(geometry.parts, geometry):
        found += defining(part, here)
    return found
