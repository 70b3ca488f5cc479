"""Many of a thing, laid out by a pitch, a radius or a curve, and texts along curves.

These are built in because they make structures, which no definition of the language can do. A template is
instantiated once; the other members are copies over the same unknowns.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise, product

from aidl_lang.building import expression as ex
from aidl_lang.building.along import KINDS, Way, crossings, reading_way, way_along, within
from aidl_lang.building.boxes import box_of
from aidl_lang.building.coerce import whole
from aidl_lang.building.construct import bridge, is_filled, positions, size, typeset
from aidl_lang.building.copies import centre_of, copied
from aidl_lang.building.curves import NOWHERE, Motion, defining, turned, xy
from aidl_lang.building.expression import Expression, Place
from aidl_lang.building.model import Assertion, Comparison, Condition, Geometry, Structure, reach_of
from aidl_lang.building.state import Arguments, Env, Function, Indices, Interpreter
from aidl_lang.building.values import (
    NOTHING,
    Exactness,
    Instantiation,
    ListVal,
    Nothing,
    Num,
    Pattern,
    PointVal,
    StructureCopy,
    TextVal,
    Value,
    certain,
    kind_of,
    length,
    number,
    point,
    spliced,
)
from aidl_lang.checking.types import PUBLIC
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.common.lettering import ALIGNMENTS
from aidl_lang.common.prose import with_article
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

_ORIGIN = PointVal(number(0.0, LENGTH), number(0.0, LENGTH))


@record()
class _Call:
    """One call of a pattern; `settings` holds the numbers of the pattern, and is known by its name."""

    it: Interpreter
    a: Arguments
    node: ast.Call
    env: Env
    settings: Geometry

    def wrong(self, message: str, hint: str) -> Nothing:
        return self.it.report("E0332", message, self.node, hints=[hint])

    def count(self, name: str) -> int | None:
        found = whole(self.it, self.a[name], self.node, f"`{name}`")
        if found is not None and found < 0:
            self.wrong(f"`{name}` is a number of members, and this is {found}", "write 1 or more")
            return None
        return None if found is None or self.is_too_many(found) else found

    def is_too_many(self, members: float) -> bool:
        """Reports a number of members beyond the limit. Returns whether it is."""
        most = self.it.limits.entities
        if members > most:
            message = f"this pattern has {members:.0f} members; at most {most} are allowed"
            self.it.report("E0805", message, self.node)
        return members > most

    def check_followed(self, off: Sequence[Expression]) -> None:
        """Has it looked at in the drawing that these are 0, as they are at the first guesses."""
        if not (parts := tuple(Comparison("==", e, ex.ZERO, LENGTH) for e in off if not e.is_constant)):
            return
        said = self.it.said(self.node, self.env)
        followed = Assertion(self.env.here, Condition("and", parts), None, *said, is_followed=True)
        self.it.assertions.append(followed)

    def size(self, name: str) -> Expression:
        """Returns a number that belongs to the pattern: kept if literal."""
        value = certain(self.a[name], Num)
        dimension = value.dimension or LENGTH
        made = size(self.it, value, self.settings, name, dimension)
        self.settings.fields[name] = made
        return made.expression

    def position(self, name: str) -> Place:
        """Returns a position of the pattern: a first guess if literal, the origin if missing."""
        value = certain(self.a.get(name, _ORIGIN), PointVal)
        (made,) = positions(self.it, [value], self.settings, [name])
        self.settings.fields[name] = made
        return xy(made)

    @property
    def thing(self) -> Value:
        return self.a["x"]

    @property
    def has_place(self) -> bool:
        """True if the thing stands somewhere already, so that the pattern goes on from there."""
        return not isinstance(self.thing, Instantiation)

    def centre(self) -> Place:
        """Returns the point that comes to lie on the places of a pattern: the middle of a thing with a name,
        else the origin it is written about, whose distance to it is exact then.
        """
        thing = self.thing
        if isinstance(thing, Structure) or (isinstance(thing, Geometry) and thing.name is not None):
            return centre_of(self.it, thing, self.node, self.env)
        if isinstance(thing, Geometry):
            for unknown in ex.unknowns(defining(thing, self.env.here)):
                if unknown.field.rpartition(".")[2] in ("x", "y"):
                    unknown.exact = True
        return NOWHERE

    def is_without_place(self, centre: Place) -> bool:
        """True for a shape without a name that lies around the origin: one that was given no place."""
        is_nameless = isinstance(self.thing, Geometry) and self.thing.name is None
        return is_nameless and not any(c.value for c in centre)

    def check_alone(self, place: Place) -> None:
        """Warns of a place that is added to that of a thing without a name, written away from the origin."""
        box = box_of(self.thing, self.env.here)
        if box is None or not isinstance(self.thing, Geometry) or self.thing.name is not None:
            return
        spans = [[box.side(side).value for side in sides] for sides in (("left", "right"), ("bottom", "top"))]
        if any(at.value and low * high > 0 for at, (low, high) in zip(place, spans, strict=True)):
            x, y = (f"{(low + high) / 2:g}" for low, high in spans)
            message = f"what is repeated stands at ({x}, {y}) already, which is added to the place of the row"
            hint = "write it around the origin; or give no place: the row begins where it stands"
            self.it.report("W0511", message, self.node, hints=[hint])

    def laid_out(self, motions: Iterable[tuple[Indices, Motion | None]]) -> Value:
        """Returns the members; one without a motion is the thing itself."""
        made = Pattern(self.node.callee.text, self.settings)
        for index, motion in motions:
            member = self.thing
            if motion is not None and isinstance(member, Instantiation):
                member = StructureCopy(member, motion, self.node, is_laid=True)
            elif motion is not None:
                member = copied(self.it, member, motion, self.node, self.env)
            if isinstance(member, Nothing):
                return NOTHING
            made.members[index] = member
        return made


def _called(answer: Callable[[_Call], Value]) -> Function:
    def function(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
        thing = a.get("x")
        if thing is not None and not isinstance(thing, Geometry | Structure | Instantiation):
            message = f"`{node.callee.text}` repeats a geometry or a structure, and this is {kind_of(thing)}"
            it.report("E0331", message, node, hints=["put several things into a template, and repeat that"])
            return NOTHING
        settings = Geometry(node.callee.text, env.here, it.place(node))
        return answer(_Call(it, a, node, env, settings))

    return function


def _linear_array(call: _Call) -> Value:
    if (n := call.count("n")) is None:
        return NOTHING
    if "by" in call.a:
        step = xy(call.a["by"])
    else:
        pitch = call.size("pitch")
        angle = call.size("angle") if "angle" in call.a else ex.ZERO
        step = pitch * ex.towards(angle)
    return _in_steps(call, ((n, step),))


def _grid(call: _Call) -> Value:
    columns, rows = call.count("columns"), call.count("rows")
    if columns is None or rows is None:
        return NOTHING
    if "pitch" in call.a:
        across = up = call.size("pitch")
    else:
        across, up = call.size("pitch_x"), call.size("pitch_y")
    return _in_steps(call, ((columns, Place(across, ex.ZERO)), (rows, Place(ex.ZERO, up))))


def _in_steps(call: _Call, ways: tuple[tuple[int, Place], ...]) -> Value:
    """Lays out members at whole numbers of steps from the first, in one direction or in two."""
    if "center" in call.a and "start" in call.a:
        what = "a pattern is placed by its `center` or by the `start` of its first member, not by both"
        return call.wrong(what, "leave one of them out")
    span = sum(((n - 1) / 2 * step for n, step in ways), NOWHERE)
    back = -1.0 * span
    placed = next((name for name in ("start", "center") if name in call.a), None)
    goes_on = call.has_place and placed is None
    about = centre_of(call.it, call.thing, call.node, call.env) if goes_on else call.centre()
    first = back if goes_on and call.is_without_place(about) else NOWHERE
    if goes_on:
        start = about + first
    else:
        place = call.position(placed or "center")
        start = place if placed == "start" else place + back
        call.check_alone(place)
    call.settings.fields.setdefault("start", point(*start))
    call.settings.fields.setdefault("center", point(*(start + span)))

    def motion(index: Indices) -> Motion | None:
        away = sum((i * step for i, (_, step) in zip(index, ways, strict=True)), NOWHERE)
        if goes_on:
            moves = first is back or any(index)
            return Motion(to=first + away) if moves else None
        return Motion(about, start + away)

    return call.laid_out((index, motion(index)) for index in product(*(range(n) for n, _ in ways)))


def _polar_array(call: _Call) -> Value:
    if (n := call.count("n")) is None:
        return NOTHING
    if "radius" not in call.a and not call.has_place:
        what = "a template is laid out on a circle, whose `radius` is not said"
        return call.wrong(what, "as in `radius: 20`")
    center = call.position("center")
    start = call.size("start") if "start" in call.a else ex.ZERO
    step = _step(call, n)
    turns = call.a.get("turn") is not False
    radius = call.size("radius") if "radius" in call.a else None
    about = call.centre() if radius is not None else centre_of(call.it, call.thing, call.node, call.env)

    def motion(i: int) -> Motion | None:
        angle = start + float(i) * step
        if radius is None:
            if i == 0 and "start" not in call.a:
                return None
            round_about = turned(angle, center)
            return round_about if turns else Motion(about, round_about.place(about))
        to = center + radius * ex.towards(angle)
        return turned(angle, about, to) if turns else Motion(about, to)

    return call.laid_out(((i,), motion(i)) for i in range(n))


def _step(call: _Call, n: int) -> Expression:
    """Returns the angle between members: a full turn has no last one on its first, a part of one has ends."""
    sweep = certain(call.a.get("sweep", number(360.0, ANGLE)), Num)
    is_full = abs(abs(sweep.value) - 360.0) < 1e-9
    if is_full and sweep.expression.is_constant:
        return ex.constant(sweep.value / max(n, 1))
    return call.size("sweep") / float(n if is_full else max(n - 1, 1))


def _along(call: _Call) -> Value:
    way = _way(call)
    off: list[Expression] = []
    corners: list[Expression] = []
    if way is None:
        return NOTHING
    if way.is_closed and "margin" in call.a:
        margin = call.size("margin")
        if (inner := within(way, margin)) is None:
            what = "a `margin` is kept within lines, and arcs that go on from them without a corner"
            return call.wrong(what, "draw a `construction` path where the members are, and go along that")
        way, corners, off = inner
        if any(s.length.value < 1e-9 for s in way.stretches):
            return call.wrong(f"nothing is left of this outline within {margin.value:g} mm", "make it less")
    places = _on_corners(call, way, corners) if corners else _evenly(call, way)
    if places is None:
        return NOTHING
    if len(places) * len(way.stretches) > _MOST_ALONG:
        what = f"{len(places)} members along {len(way.stretches)} curves are too many"
        return call.it.report("E0805", f"{what}: their product is at most {_MOST_ALONG}", call.node)
    turns = call.a.get("turn") is not False
    about = call.centre()

    def motion(place: Expression) -> Motion:
        if way.is_free:
            to, heading, unmet = way.followed(place)
            off.extend(unmet)
        else:
            to, heading = way.at(place)
        return turned(heading, about, to) if turns else Motion(about, to)

    made = call.laid_out(((i,), motion(place)) for i, place in enumerate(places))
    call.check_followed(off)
    return made


def _evenly(call: _Call, way: Way) -> list[Expression] | None:
    """Returns the ways to members that are as far apart everywhere."""
    name = next((n for n in ("inset", "margin") if n in call.a), None)
    inset = call.size(name) if name and not (way.is_closed and name == "margin") else ex.ZERO
    length = way.length
    room = length if way.is_closed else length - 2.0 * inset
    if room.value <= 0:
        what = f"an `inset` of {inset.value:g} at both ends"
        message = f"nothing is left of a curve of {length.value:g} mm with {what}"
        call.wrong(message, "make the `inset` less")
        return None
    if (found := _steps(call, room, is_closed=way.is_closed)) is None:
        return None
    n, step = found
    first = inset
    if not way.is_closed:
        left = room - float(n - 1) * step
        first = inset + left * 0.5
    call.settings.fields.setdefault("pitch", Num(step, LENGTH))
    return [first + float(i) * step for i in range(n)]


def _on_corners(call: _Call, way: Way, corners: Sequence[Expression]) -> list[Expression] | None:
    """Returns the ways to members in all corners of a closed way, and evenly between each and the next."""
    runs = [b - a for a, b in pairwise([*corners, corners[0] + way.length])]
    if (found := _steps(call, way.length, is_closed=True)) is None:
        return None
    parts = [1 if "n" in call.a else max(1, round(run.value / found[1].value)) for run in runs]
    if "n" in call.a and found[0] < len(runs):
        few = f"{found[0]} members are fewer than the {len(runs)} corners"
        call.wrong(few, "write more, or follow a line")
        return None
    while "n" in call.a and sum(parts) < found[0]:
        sparse = max(range(len(runs)), key=lambda k: (round(runs[k].value / parts[k], 6), runs[k].value))
        parts[sparse] += 1
    spans = zip(corners, runs, parts, strict=True)
    shares = ((corner, run, k / part) for corner, run, part in spans for k in range(part))
    places = [corner + share * run for corner, run, share in shares]
    return [p if p.value < way.length.value else p - way.length for p in places]


_MOST_ALONG = 20_000  # members times curves: each place is worked out over all of them


def _way(call: _Call) -> Way | None:
    curves = _curves(call)
    found = way_along(curves, call.env.here) if curves else None
    if curves is not None and found is None:
        what = "`along` follows one line, open or closed, and this is none or several"
        call.wrong(what, "name one of them")
    return found


def _curves(call: _Call) -> list[Geometry] | None:
    given = [v for v in spliced(call.a["curve"]) if isinstance(v, Geometry)]
    drawn = [p for g in given for p in g.primitives(even_construction=True)]
    curves = [p for p in drawn if p.type != "point"]
    other = next((c.type for c in curves if c.type not in PUBLIC), None)
    if other is not None or any(g.recipe is not None for g in given):
        hint = "follow a `path` or `polyline` near it, or what the outline is made of"
        call.wrong(f"`along` follows curves, and this is {with_article(given[0].type)}", hint)
        return None
    return curves


def _point_at(call: _Call) -> Value:
    """Returns the point of curves at a length from their start, or the first or last that has an x or a y."""
    at, axis = certain(call.a["at"], Num), call.a.get("axis")
    if axis is None:
        if (way := _way(call)) is None:
            return NOTHING
        place, _, off = way.followed(at.expression)
    else:
        curves, word = _curves(call), certain(axis, TextVal).value
        found = crossings(curves or (), call.env.here, int(word == "y"), at.expression)
        if not found:
            what = f"no point of this outline has {word} = {at.value:g}"
            return call.wrong(what, "name an outline that reaches there") if curves is not None else NOTHING
        place, off = found[-1 if call.a["last"] is True else 0]
    call.check_followed(off)
    return point(*place)


def _way_between(call: _Call) -> Value:
    """Returns the length of a curve between the places nearest to two points; the shorter of two ways."""
    if (way := _way(call)) is None:
        return NOTHING
    (first, off), (last, more) = (way.up_to(xy(call.a[name])) for name in ("a", "b"))
    call.check_followed([off, more])
    between = ex.apply("abs", last - first)
    return length(ex.apply("minimum", between, way.length - between) if way.is_closed else between)


def _steps(call: _Call, room: Expression, *, is_closed: bool) -> tuple[int, Expression] | None:
    if "n" in call.a:
        if (n := call.count("n")) is None:
            return None
        parts = n if is_closed else n - 1
        return n, room / float(parts) if parts > 0 else ex.ZERO
    pitch = call.size("pitch")
    if pitch.value <= 0:
        call.wrong(f"the `pitch` is {pitch.value:g}", "write the way from one member to the next, in mm")
        return None
    fit = room.value / pitch.value
    if call.is_too_many(fit):
        return None
    if is_closed:
        n = max(1, round(fit))
        return n, room / float(n)
    return math.floor(fit + 1e-9) + 1, pitch


FUNCTIONS = {
    "along": _called(_along),
    "linear_array": _called(_linear_array),
    "grid": _called(_grid),
    "polar_array": _called(_polar_array),
    "point_at": _called(_point_at),
    "way_between": _called(_way_between),
}


# --- Texts along curves: each character stands upright on the curve, by the middle of its ink.
#
# A character is a text of its own whose place and angle are expressions of the curve, so it stays on it
# wherever the curve is solved to be.

_UPRIGHT = TextVal("upright")  # the side of a curve that is not told


def lettered(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns the characters of a text along a curve, each a geometry that stands upright on it."""
    given = [v for v in spliced(a["curve"]) if isinstance(v, Geometry)]
    curves = [p for g in given for p in g.primitives(even_construction=True) if p.type != "point"]
    is_simple = all(c.type in KINDS for c in curves) and not any(g.recipe for g in given)
    inside, place = a["inside"], it.place(it.call_sites[-1])
    if inside != _UPRIGHT and not isinstance(inside, bool):
        what = f"`inside` is {kind_of(inside)}, and tells the side of a curve by true or false"
        hint = "leave it out for the side on which it is upright"
        return it.report("E0516", what, place, hints=[hint], once=True)
    side = inside if isinstance(inside, bool) else None
    way = reading_way(curves, env.here, inside=side) if curves and is_simple else None
    if way is None:
        what = with_article(given[0].type) if len(given) == 1 else "no one curve"
        message = f"a text follows a circle, or an open way of lines and arcs, and this is {what}"
        hint = "name an edge of an outline, as in `along: plate.top`, or draw a guide near it: "
        hint += "`construction way = arc(…)`"
        return it.report("E0358", message, place, hints=[hint], once=True)
    if not (glyphs := typeset(it, a)):
        return NOTHING
    share = 0.5 if way.is_closed else ALIGNMENTS[certain(a["align"], TextVal).value]
    first, found = way.length * share, list[Geometry]()
    height: Expression | None = None
    reach, bridges = reach_of([g.bound_to for g in given], env.here), bridge(it, a)
    for glyph in glyphs:
        it.count_entity(node)
        g = Geometry("glyphs", env.here, it.place(node), glyphs=(glyph,), reach=reach)
        g.filled = is_filled(a, glyphs)
        if height is None:
            height = size(it, certain(a["height"], Num), g, "height").expression
        middle = height * ((glyph.box[0] + glyph.box[2]) / 2)
        at, heading = way.at(first + middle)
        start = point(*(at - middle * ex.towards(heading)))
        angle = Num(heading, ANGLE, Exactness.REFERENCE)
        g.fields = {"start": start, "height": length(height), "angle": angle}
        g.bridge = bridges
        found.append(g)
        if reach is not None:
            it.following.append(g)
    extent = max(glyph.box[2] for glyph in glyphs) - min(glyph.box[0] for glyph in glyphs)
    assert height is not None
    fits = Comparison("<=", height * extent, way.length, LENGTH)
    said = place or node.span
    both = Condition("and", (fits,))
    it.assertions.append(Assertion(env.here, both, None, said.one_line, said, extent=extent))
    whole = env.scope.declaring().container
    if isinstance(whole, Geometry):
        whole.reach = reach
    return ListVal(tuple(found))
