"""Copies: what `mirror`, `copy`, `move`, `rotate` and `scale` make, curve by curve."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from aidl_lang.syntax import ast
from tests.checker.functions import EMPTY, mirrored
from tests.checker.tree import Geo, Node, Transform, Vec
from tests.checker.values import MistakeError, Point, Scope, Thunk, fold

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator

Motion = Callable[[Vec], Vec]


@dataclass(frozen=True)
class Copy:
    """What was copied and where its points go, in the frame of the structure that holds the copy."""

    source: Geo | Node
    motion: Motion
    factor: float = 1.0


def origin(ev: Evaluator, value: ast.Expression, scope: Scope) -> Copy | None:
    """What an expression copies; None when it does not, or copies a list or a thing without a name."""
    if not isinstance(value, ast.Call):
        return None
    name = fold(scope.canonical(value.callee.text))
    if name not in _MAKERS or scope.own(value.callee.text):
        return None
    try:
        positional, named = ev.arguments(value, scope)
    except MistakeError:
        return None
    if not isinstance(positional[0], Geo | Node):
        return None
    maker = _MAKERS[name]
    return maker(ev, *positional, **ev.renamed(maker, named))


def same_names(source: Node, image: Node) -> None:
    """The body of a copy sees what the body of its source does, with the copy's own members."""
    if source.env is not None:
        image.env = Scope(source.env.parent, node=image)
        for name, value in source.env.names.items():
            if isinstance(value, Thunk) and value.scope is source.env:
                value = Thunk(value.expression, image.env, value.kind, value.name)
            image.env.names[name] = value
    for child, other in zip(source.children.values(), image.children.values(), strict=True):
        same_names(child, other)


# --- Motions ---------------------------------------------------------------------------------------


def turn(p: Vec, angle: float, about: Vec = (0.0, 0.0)) -> Vec:
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    x, y = p[0] - about[0], p[1] - about[1]
    return about[0] + c * x - s * y, about[1] + s * x + c * y


def _mirror(ev: Evaluator, x: Any, about: Any) -> Copy:
    return Copy(x, lambda p: mirrored(ev, p, about))


def _copy(
    ev: Evaluator,
    x: Any,
    by: Any = None,
    angle: Any = None,
    about: Any = None,
    scale: Any = None,
    center: Any = None,
) -> Copy:
    degrees = 0.0 if angle is None else ev.number(angle).value
    factor = 1.0 if scale is None else ev.number(scale).value
    middle = own_center(ev, x)
    pole = middle if about is None else ev.point(about).xy
    way = (0.0, 0.0) if by is None else ev.point(by).xy
    if center is not None:
        to = ev.point(center).xy
        pole, way = middle, (to[0] - middle[0], to[1] - middle[1])

    def motion(p: Vec) -> Vec:
        u, v = turn(p, degrees, pole)
        return pole[0] + factor * (u - pole[0]) + way[0], pole[1] + factor * (v - pole[1]) + way[1]

    return Copy(x, motion, factor)


def _move(ev: Evaluator, x: Any, by: Any = None, dx: Any = None, dy: Any = None) -> Copy:
    if by is None:
        by = Point(*(ev.number(EMPTY if d is None else d) for d in (dx, dy)))
    return _copy(ev, x, by=by)


def _rotate(ev: Evaluator, x: Any, angle: Any, about: Any = None) -> Copy:
    return _copy(ev, x, angle=angle, about=about)


def _scale(ev: Evaluator, x: Any, factor: Any, about: Any = None) -> Copy:
    return _copy(ev, x, scale=factor, about=about)


def own_center(ev: Evaluator, x: Geo | Node) -> Vec:
    """What a thing turns about: the origin of a structure, the centre of anything else."""
    if isinstance(x, Node):
        return ev.frame.inward(x.world.outward((0.0, 0.0)))
    if x.type == "point":
        return ev.point(x).xy
    center = ev.member(x, "center" if x.type != "bezier" else "bb")
    return center.xy if isinstance(center, Point) else ev.box(center).center


_MAKERS: dict[str, Callable[..., Copy]] = {
    "mirror": _mirror,
    "copy": _copy,
    "move": _move,
    "translate": _move,
    "rotate": _rotate,
    "scale": _scale,
}

# --- Likeness --------------------------------------------------------------------------------------


def away(frame: Transform, made: Copy, image: Geo | Node) -> float:
    """How far the curves and points of a copy are from where those of its source go."""
    here = [_marks(c, frame) for c in _curves(image)]
    expected = [
        (kind, [made.motion(p) for p in points], [made.factor * s for s in sizes])
        for kind, points, sizes in (_marks(c, frame) for c in _curves(made.source))
    ]
    if len(here) != len(expected) or not here:
        return math.inf
    left = list(here)
    worst = 0.0
    for one in expected:
        nearest = min(left, key=lambda other: _apart(one, other))
        worst = max(worst, _apart(one, nearest))
        left.remove(nearest)
    return worst


def _curves(thing: Geo | Node) -> Iterator[Geo]:
    if isinstance(thing, Geo):
        yield from _leaves(thing)
        return
    for geo in thing.geometry.values():
        yield from _leaves(geo)
    for child in thing.children.values():
        yield from _curves(child)


def _leaves(geo: Geo) -> Iterator[Geo]:
    if not geo.parts:
        yield geo
    for part in geo.parts.values():
        yield from _leaves(part)


Marks = tuple[str, list[Vec], list[float]]
_NAMES = {
    "line": ("start", "end"),
    "arc": ("start", "center", "end"),
    "circle": ("center",),
    "point": ("at",),
    "ellipse": ("center",),
}


def _marks(curve: Geo, frame: Transform) -> Marks:
    """Points and sizes that say where a curve is, in a frame; reversed they mean the same curve."""
    data = curve.data
    points = data["points"] if curve.type == "bezier" else [data[n] for n in _NAMES[curve.type]]
    found = [frame.inward((p[0], p[1])) for p in points]
    if curve.type == "arc":
        return "arc", [*found[:1], _middle(data, frame), *found[1:]], [data["radius"]]
    if curve.type == "ellipse":
        (x, y), turned = data["center"], math.radians(data["angle"])
        reach = data["rx"] * math.cos(turned), data["rx"] * math.sin(turned)
        tips = [frame.inward((x + s * reach[0], y + s * reach[1])) for s in (1, -1)]
        return "ellipse", [tips[0], *found, tips[1]], [data["rx"], data["ry"]]
    return curve.type, found, [data["radius"]] if curve.type == "circle" else []


def _middle(data: dict[str, Any], frame: Transform) -> Vec:
    """The point half-way along an arc."""
    (x, y), r = data["center"], data["radius"]
    first, last = (math.atan2(data[e][1] - y, data[e][0] - x) for e in ("start", "end"))
    if data.get("clockwise"):
        first, last = last, first
    half = first + (last - first) % math.tau / 2
    return frame.inward((x + r * math.cos(half), y + r * math.sin(half)))


def _apart(a: Marks, b: Marks) -> float:
    if a[0] != b[0] or len(a[1]) != len(b[1]):
        return math.inf
    if a[0] == "arc":
        a, b = ((k, [p[0], p[1], p[3]], s) for k, p, s in (a, b))
    ways = [max(math.dist(p, q) for p, q in zip(a[1], other, strict=True)) for other in (b[1], b[1][::-1])]
    return max(min(ways), *(abs(s - t) for s, t in zip(a[2], b[2], strict=True)), 0.0)
