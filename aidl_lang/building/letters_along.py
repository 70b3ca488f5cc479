"""Texts along curves: each character stands upright on the curve, by the middle of its ink.

A character is a text of its own whose place and angle are expressions of the curve, so it stays on it
wherever the curve is solved to be.
"""

from __future__ import annotations

from aidl_lang.building import expression as ex
from aidl_lang.building.along import KINDS, reading_way
from aidl_lang.building.construct import size
from aidl_lang.building.expression import Expression
from aidl_lang.building.lettering import bridge, is_filled, report_once, typeset
from aidl_lang.building.model import Assertion, Comparison, Condition, Geometry, reach_of
from aidl_lang.building.state import Arguments, Env, Interpreter
from aidl_lang.building.values import (
    NOTHING,
    Exactness,
    ListVal,
    Num,
    TextVal,
    Value,
    kind_of,
    length,
    point,
    spliced,
)
from aidl_lang.checking.units import ANGLE, LENGTH
from aidl_lang.common import lettering
from aidl_lang.common.prose import with_article
from aidl_lang.syntax import ast

_UPRIGHT = TextVal("upright")
"""The side of a curve that is not told."""


def lettered(it: Interpreter, a: Arguments, node: ast.Call, env: Env) -> Value:
    """Returns the characters of a text along a curve, each a geometry that stands upright on it."""
    given = [v for v in spliced(a["curve"]) if isinstance(v, Geometry)]
    curves = [p for g in given for p in g.primitives(even_construction=True) if p.type != "point"]
    is_simple = all(c.type in KINDS for c in curves) and not any(g.recipe for g in given)
    inside = a["inside"]
    if inside != _UPRIGHT and not isinstance(inside, bool):
        what = f"`inside` is {kind_of(inside)}, and tells the side of a curve by true or false"
        report_once(
            it, "E0516", what, it.call_sites[-1], ["leave it out for the side on which it is upright"]
        )
        return NOTHING
    side = inside if isinstance(inside, bool) else None
    way = reading_way(curves, env.here, inside=side) if curves and is_simple else None
    if way is None:
        what = with_article(given[0].type) if len(given) == 1 else "no one curve"
        report_once(
            it,
            "E0358",
            f"a text follows a circle, or an open way of lines and arcs, and this is {what}",
            it.call_sites[-1],
            [
                "name an edge of an outline, as in `along: plate.top`, or draw a guide near it: "
                "`construction way = arc(…)`"
            ],
        )
        return NOTHING
    glyphs, align = typeset(it, a), a["align"]
    if not glyphs:
        return NOTHING
    assert isinstance(align, TextVal)
    assert isinstance(a["height"], Num)
    share = 0.5 if way.is_closed else lettering.ALIGNMENTS[align.value]
    first, found = ex.mul(way.length, ex.constant(share)), list[Geometry]()
    height: Expression | None = None
    reach, bridges = reach_of([g.bound_to for g in given], env.here), bridge(it, a)
    for glyph in glyphs:
        it.count_entity(node)
        g = Geometry("glyphs", env.here, it.place(node), glyphs=(glyph,), reach=reach)
        g.filled = is_filled(a, glyphs)
        if height is None:
            height = size(it, a["height"], g, "height").expression
        middle = ex.mul(height, ex.constant((glyph.box[0] + glyph.box[2]) / 2))
        (x, y), heading = way.at(ex.add(first, middle))
        cos, sin = ex.cos(heading), ex.sin(heading)
        start = point(ex.sub(x, ex.mul(middle, cos)), ex.sub(y, ex.mul(middle, sin)))
        angle = Num(heading, ANGLE, Exactness.REFERENCE)
        g.fields = {"start": start, "height": length(height), "angle": angle}
        g.bridge = bridges
        found.append(g)
        if reach is not None:
            it.following.append(g)
    extent = max(glyph.box[2] for glyph in glyphs) - min(glyph.box[0] for glyph in glyphs)
    assert height is not None
    fits = Comparison("<=", ex.mul(height, ex.constant(extent)), way.length, LENGTH)
    call = it.call_sites[-1]
    place = it.place(call) or call.span
    it.assertions.append(
        Assertion(env.here, Condition("and", (fits,)), None, place.one_line, place, extent=extent)
    )
    whole = env.scope.declaring().container
    if isinstance(whole, Geometry):
        whole.reach = reach
    return ListVal(tuple(found))
