"""Geometry, texts and drawings among it, and the exactness of its numbers (language reference: numbers)."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from aidl_lang.building import expression as ex
from aidl_lang.building.boxes import SIDES
from aidl_lang.building.coerce import constant
from aidl_lang.building.curves import direction, distance, polar, xy
from aidl_lang.building.expression import Expression, Place
from aidl_lang.building.model import Constraint, Geometry, Holder, Measurement, is_size
from aidl_lang.building.state import Arguments, Env, Interpreter, Stop
from aidl_lang.building.values import (
    Exactness,
    Num,
    PointVal,
    TextVal,
    Value,
    certain,
    kind_of,
    length,
    number,
    point,
)
from aidl_lang.building.wording import equated
from aidl_lang.checking.builtins import SIGNATURES
from aidl_lang.checking.rules import place_before
from aidl_lang.checking.types import PRIMITIVES, NumberType, PointType
from aidl_lang.checking.units import ANGLE, LENGTH, PLAIN, MaybeDimension
from aidl_lang.common import lettering
from aidl_lang.common.diagnostics import Edit, Fix
from aidl_lang.common.font_files import FontError
from aidl_lang.common.lettering import Font, Glyph
from aidl_lang.common.prose import first_few
from aidl_lang.common.source import Span
from aidl_lang.common.world import FONTS, FileError, ReadFailure, relative_to
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.common.drawings import Trace

# --- Arcs given by three points without names: centre, start and end, with a warning if they hardly can be.

ROUND = 0.01
"""The part of the larger one by which the distances of start and end from the centre may differ without a
warning."""

_BY_CENTER = ("center", "start", "end")
_BY_MIDDLE = ("start", "mid", "end")


def check_bare_points(it: Interpreter, node: ast.Call, arguments: Mapping[str, Value]) -> None:
    """Warns of an arc whose unnamed first point is taken as its centre, if that is not as far from both."""
    if any(a.name is not None and a.name.text == "center" for a in node.arguments):
        return
    a, b, c = (arguments.get(name) for name in _BY_CENTER)
    if not (isinstance(a, PointVal) and isinstance(b, PointVal) and isinstance(c, PointVal)):
        return
    start, end, across = _apart(a, b), _apart(a, c), _apart(b, c)
    if not differ(start, end) > ROUND:
        return
    is_through = differ(start, across) <= differ(start, end)
    meant, other = (_BY_MIDDLE, _BY_CENTER) if is_through else (_BY_CENTER, _BY_MIDDLE)
    far = f"the start is {start:g} from the centre and the end {end:g}"
    message = f"the points of `{node.callee.text}` are centre, start and end, and here {far}"
    hint, fix = "name them: `center`, `start` and `end`, or `start`, `mid` and `end`", None
    if _is_plain(node):
        points = node.arguments[:3]
        said = ", ".join(f"{name}: {p.span.one_line}" for name, p in zip(other, points, strict=True))
        hint = f"or write `{node.callee.text}({said})` if that is meant"
        edits = tuple(Edit(place_before(p), f"{name}: ") for name, p in zip(meant, points, strict=True))
        fix = Fix(f"name them `{meant[0]}`, `{meant[1]}` and `{meant[2]}`", edits)
    it.report("W0503", message, node, hints=[hint], fix=fix, once=True)


def _apart(a: PointVal, b: PointVal) -> float:
    return (b.place - a.place).length.value


def differ(a: float, b: float) -> float:
    """Returns the part of the larger one by which two distances differ."""
    return abs(a - b) / max(a, b) if max(a, b) > 0 else 0.0


def _is_plain(node: ast.Call) -> bool:
    points = node.arguments[:3]
    return node.receiver is None and len(points) == 3 and all(p.name is None for p in points)


# --- The font that a text names: one that ships with the package, or a file beside the program.
#
# Paths follow the rules of imports: relative to the file in which the text is written, and inside the
# project.

PLAIN_FONT, SINGLE_LINE = "DejaVu Sans", "single line"
"""The names of the fonts that ship with the package."""


class NoFontError(Exception):
    """Raised for a font that there is not, with a message and hints."""


def font_of(it: Interpreter, name: str, *, bold: bool) -> Font:
    """Returns the font of this name, for the text that is being built. Raises NoFontError or FontError."""
    if name == PLAIN_FONT:
        return lettering.bold_font() if bold else lettering.plain_font()
    if name == SINGLE_LINE:
        if bold:
            message = "letters of single lines cannot be bold: they are as wide as the tool"
            raise NoFontError(message, "leave out `bold`, or the font")
        return lettering.single_line_font()
    if PurePosixPath(name).suffix.lower() not in FONTS:
        raise NoFontError(
            f'there is no font "{name}"',
            'name a font file beside the program, as in `font: "Lobster.ttf"`',
            "fonts of this machine are not looked through, as others have other ones",
            f'`font: "{PLAIN_FONT}"` is what texts have unasked, `font: "{SINGLE_LINE}"` is for engraving',
        )
    if bold:
        hint = "name the file of its bold face, and leave out `bold`"
        raise NoFontError(f"`{name}` is one face, and cannot be made bold", hint)
    if (world := it.program.resolution.world) is None:
        raise NoFontError(f"`{name}` cannot be read: only this text is at hand")
    try:
        path = relative_to(name, _writer(it))
        if path not in it.fonts:
            it.fonts[path] = lettering.font_of(world.read_bytes(path))
        return it.fonts[path]
    except FileError as error:
        hint = "paths are relative to the file that the text is written in"
        if error.reason is ReadFailure.OUTSIDE:
            hint = "copy it beside the program: only its own folder and those below it are read"
        raise NoFontError(f"`{name}` cannot be read: {error.reason}", hint) from None


def _writer(it: Interpreter) -> str:
    authored = (node for node in reversed(it.call_sites) if node.span.source not in it.library_sources)
    source = next(authored, it.program.main).span.source
    if source is it.program.main.source:
        return PurePosixPath(source.name.replace("\\", "/")).name
    return source.name


# --- Lettering in a program: `glyphs(…)` makes one geometry of a whole text, `ink(…)` measures it.
#
# A text is a single primitive: its place, height and angle are solved for, its curves follow when the
# solution is read out. Dozens of letters then cost the solver no more than one circle.


def typeset(it: Interpreter, a: Arguments) -> tuple[Glyph, ...]:
    """Returns the characters of a text in units of its height; empty after an error, reported here."""
    node = it.call_sites[-1]
    at = it.place(node)
    text, align, name = (certain(a[each], TextVal).value for each in ("text", "align", "font"))
    apart = constant(it, certain(a["line_spacing"], Num), node, "the spacing of lines")
    if align not in lettering.ALIGNMENTS:
        allowed = ", ".join(f'`"{word}"`' for word in lettering.ALIGNMENTS)
        message = f'"{align}" is not one of the words that are meant here'
        it.report("E0516", message, at, hints=[f"it is one of {allowed}"], once=True)
        return ()
    if apart is None:
        return ()
    if len(text) > it.limits.entities:
        it.count_entity(node, len(text))  # stops here, before the letters are set
    try:
        font = font_of(it, name, bold=a["bold"] is True)
        if unknown := lettering.unknown_characters(text, font):
            _report_unknown(it, unknown, at, name)
            return ()
        glyphs = lettering.typeset(text, align, apart, font)
    except NoFontError as lack:
        message, *hints = lack.args
        it.report("E0359", message, at, hints=hints, once=True)
        return ()
    except FontError as reason:
        again = "get the file anew, or save it anew as .ttf or .otf with a program for fonts"
        it.report("E0360", f"`{name}` cannot be drawn with: {reason}", at, hints=[again], once=True)
        return ()
    if not glyphs:
        hint = "write what is to be drawn, or leave the text out"
        it.report("E0351", "there is nothing to draw in this text", at, hints=[hint], once=True)
    return glyphs


def is_filled(a: Arguments, glyphs: Sequence[Glyph]) -> bool:
    """Tells whether a drawing fills the letters of a text."""
    return a["outline"] is not True and not any(glyph.is_stroked for glyph in glyphs)


_BRIDGE = 0.1  # width of the bridges of a stencil, in heights of a capital, where none is told


def bridge(it: Interpreter, a: Arguments) -> Num | None:
    """Returns how wide the bridges of a text are (see `Geometry.bridge`); None for none or an error."""
    stencil, node = a["stencil"], it.call_sites[-1]
    if stencil is False:
        return None
    if a["font"] == TextVal(SINGLE_LINE):
        what = "letters of single lines enclose nothing that a stencil could hold"
        it.report("E0342", what, it.place(node), hints=["leave out `stencil`, or the font"], once=True)
        return None
    if stencil is True:
        return number(_BRIDGE, PLAIN)
    width = constant(it, stencil, node, "the width of bridges") if isinstance(stencil, Num) else 0.0
    if width is not None and width <= 0:
        given = f"{width:g}" if isinstance(stencil, Num) else kind_of(stencil)
        hint = "write `stencil: true` for a tenth of the height, or how wide they are: `stencil: 2mm`"
        message = f"`stencil` is {given}, and bridges have a width"
        it.report("E0342", message, it.place(node), hints=[hint], once=True)
    return number(width, LENGTH) if width and width > 0 else None


def _report_unknown(it: Interpreter, unknown: list[str], at: Span | None, font: str) -> None:
    names = first_few(list(map(lettering.described, unknown)), 5)
    others = {c: lettering.replacement(c) for c in unknown[:5]}
    instead = [f"write `{other}` for `{c}`" for c, other in others.items() if other is not None]
    if font != PLAIN_FONT:
        it.report("E0350", f"`{font}` has no {names}", at, hints=instead, once=True)
        return
    has = "it has Latin, Greek and Cyrillic letters, digits, punctuation, and signs such as `±` `°` `Ø` `→`"
    it.report("E0350", f"the font has no {names}", at, hints=[*instead, has], once=True)


# --- Drawings of other programs in a program: one geometry each, of which the parts are views.


def trace_of(it: Interpreter, name: str) -> Trace:
    """Returns the outlines under a name, of the drawing whose definitions call; ends building elsewhere."""
    call = it.call_sites[-1]
    if (drawing := it.program.resolution.drawings.get(call.span.source)) is None:
        it.refuse(call, 'imports write it: `import "logo.svg" as logo` has the parts of a drawing')
        raise Stop
    return drawing.outlines.trace(name)


def part(it: Interpreter, a: Mapping[str, Value], node: ast.Call, env: Env) -> Value:
    """Returns some outlines of a drawing, to be measured and copied: they are drawn with the others."""
    whole, name = certain(a["of"], Geometry), certain(a["part"], TextVal)
    outlines = trace_of(it, name.value)
    return replace(whole, trace=outlines, name=name.value, container=whole, views={}, attributes={})


# --- Geometry and the exactness of its numbers (language reference: numbers, parameters, exactness).
#
# A number becomes an unknown, a constant or an expression by its status and by the place it is given to:
# positions are free first guesses, sizes are kept. Several literal points given to one constructor move as
# one: the first is the position, the differences to it are kept sizes.


def solvable(it: Interpreter, value: Num, span: Span | None) -> Expression:
    """Returns a number as the solver sees it; 0 for a measure of what is drawn later, which is reported."""
    return ex.ZERO if refuses_measure(it, value, span) else value.expression


def refuses_measure(it: Interpreter, value: Num, span: Span | None) -> bool:
    """Reports a number that follows from a measure of what is drawn after solving. Returns whether it was."""
    if not math.isnan(value.value):
        return False  # a measure has no value before
    found = (n.payload for n in ex.nodes([value.expression]) if isinstance(n.payload, Measurement))
    if (measured := next(found, None)) is None:
        return False
    is_box = measured.kind in SIDES
    code, what = ("E0519", "this box") if is_box else ("E0512", f"`{measured.kind}`")
    message = f"geometry cannot follow from {what}, which is known after solving only"
    hint = "take the sizes and points of what is measured, or check it in an `assert`"
    it.report(code, message, span, hints=[hint])
    return True


def size(it: Interpreter, value: Num, holder: Geometry, name: str, dimension: MaybeDimension = LENGTH) -> Num:
    """Returns a number given as a size: kept if literal, exact if a param is in it, derived from unknowns."""
    expression = solvable(it, value, holder.span)
    if dimension in (None, LENGTH) and is_size(name) and expression.is_constant and value.value < 0:
        message = f"the {name} of this {holder.type} is {value.value:g}, and sizes are never negative"
        hint = f"write {-value.value:g}; directions belong to angles and positions"
        it.report("E0515", message, holder.span, hints=[hint])
    if expression.is_constant and value.status in (Exactness.NUMBER, Exactness.GUESS):
        kept = value.status is Exactness.NUMBER
        expression = it.unknown(value.value, holder, name, dimension=dimension, kept=kept)
        it.became(value, expression, holder, name, dimension)
    return Num(expression, dimension, Exactness.REFERENCE)


def turn(it: Interpreter, value: Num, holder: Geometry, name: str, rotatable: bool) -> Num:
    """Returns an angle that stays 0 until asked for: by `rotatable`, `guess`, another value, a constraint."""
    expression = value.expression
    if not expression.is_constant or value.status >= Exactness.PARAM or (value.value != 0 and not rotatable):
        return size(it, value, holder, name, ANGLE)
    stays = not rotatable and value.status is not Exactness.GUESS
    made = it.unknown(value.value, holder, name, dimension=ANGLE, locked=stays)
    it.became(value, made, holder, name, ANGLE)
    return Num(made, ANGLE, Exactness.REFERENCE)


def positions(
    it: Interpreter, points: Sequence[PointVal], holder: Holder, names: Sequence[str], *, edges: bool = True
) -> list[PointVal]:
    """Returns points given as positions to one constructor; literal ones move as one.

    From one literal point to the next the way is kept as a length and a direction, so that what turns an edge
    does not shorten it; for points that are no corners (`edges` is false), as differences from the first. The
    start and the end of a shape that spans, as a strip does, are literal with a param in them, too.
    """
    spans = list(names) == ["start", "end"] and isinstance(holder, Geometry) and holder.type != "line"
    literal = _is_first_guess if spans else _is_literal
    placed: list[PointVal] = []
    anchors: dict[str, tuple[Num, Expression, str]] = {}
    before: tuple[PointVal, PointVal, str] | None = None

    def coordinate(axis: str, number: Num, name: str) -> Expression:
        """Returns one coordinate: exact, a first guess, or a difference from the first guess before it."""
        if number.status >= Exactness.FIXED:
            return solvable(it, number, holder.span)
        if axis not in anchors or number.status is Exactness.GUESS:
            made = it.unknown(number.value, holder, f"{name}.{axis}", dimension=LENGTH)
            anchors.setdefault(axis, (number, made, name))
            return made
        first, base, since = anchors[axis]
        offset = number.value - first.value
        if Exactness.PARAM in (number.status, first.status):
            return base + offset
        return base + it.unknown(offset, holder, f"{name}.d{axis}", dimension=LENGTH, kept=True, since=since)

    for at, name in zip(points, names, strict=True):
        if edges and literal(at) and before is not None and _differ(before[0], at):
            made = _beyond(it, before, at, holder, name)
        else:
            made = point(coordinate("x", at.x, name), coordinate("y", at.y, name))
        if literal(at):
            before = (at, made, name)
        it.became_point(at, made, holder, name)
        placed.append(made)
    return placed


def _is_literal(at: PointVal) -> bool:
    return at.x.status is at.y.status is Exactness.NUMBER


def _is_first_guess(at: PointVal) -> bool:
    return {at.x.status, at.y.status} <= {Exactness.NUMBER, Exactness.PARAM}


def _differ(a: PointVal, b: PointVal) -> bool:
    return a.x.value != b.x.value or a.y.value != b.y.value


def _beyond(
    it: Interpreter, before: tuple[PointVal, PointVal, str], at: PointVal, holder: Holder, name: str
) -> PointVal:
    """Returns a literal point by its distance and direction from the literal point before it."""
    written, base, since = before
    way, angle = (
        it.unknown(n.value, holder, f"{name}.{what}", dimension=n.dimension, kept=True, since=since)
        for n, what in zip(_way(written, at), ("length", "angle"), strict=True)
    )
    return polar(base, way, angle)


def _way(a: PointVal, b: PointVal) -> tuple[Num, Num]:
    x, y = b.x.value - a.x.value, b.y.value - a.y.value
    return Num(ex.constant(math.hypot(x, y)), LENGTH), Num(ex.constant(math.degrees(math.atan2(y, x))), ANGLE)


def _point(it: Interpreter, g: Geometry, a: Arguments, env: Env) -> None:
    at = a["at"] if "at" in a else PointVal(certain(a["x"], Num), certain(a["y"], Num))
    g.fields = {"at": loose_point(it, certain(at, PointVal), g)}


def loose_point(it: Interpreter, at: PointVal, g: Geometry) -> PointVal:
    """Returns a named point: its unknowns are called `p.x` and `p.y`."""
    return point(*loose_place(it, at, g))


def loose_place(it: Interpreter, at: PointVal, of: Holder) -> Place:
    """Returns the coordinates of a point or a frame: exact ones as they are, else unknowns `x` and `y`."""
    owner, moved = (of.owner, None) if isinstance(of, Geometry) else (of.parent or of, of)

    def coordinate(n: Num, axis: str) -> Expression:
        if n.status >= Exactness.FIXED:
            return solvable(it, n, of.span)
        made = it.unknown(n.value, of, axis, owner=owner, dimension=LENGTH, frame_of=moved)
        return it.became(n, made, of, axis)

    return Place(coordinate(at.x, "x"), coordinate(at.y, "y"))


def _points(it: Interpreter, g: Geometry, a: Arguments, names: Sequence[str]) -> dict[str, Value]:
    """Returns the named point arguments as positions of one geometry; a missing one is guessed at (0, 0)."""
    found = positions(it, [_written(a, name) for name in names], g, names)
    return dict(zip(names, found, strict=True))


def _written(a: Arguments, name: str) -> PointVal:
    return certain(a.get(name, _ORIGIN), PointVal)


_ORIGIN = PointVal(Num(ex.ZERO, LENGTH), Num(ex.ZERO, LENGTH))


def _size(it: Interpreter, g: Geometry, a: Arguments, name: str, dimension: MaybeDimension = LENGTH) -> Num:
    return size(it, certain(a[name], Num), g, name, dimension)


def _line(it: Interpreter, g: Geometry, a: Arguments, env: Env) -> None:
    end = None
    if "end" in a:
        start, end = _written(a, "start"), _written(a, "end")
        if not (_is_literal(start) and _is_literal(end) and _differ(start, end)):
            g.fields = _points(it, g, a, ("start", "end"))
            return
        a = dict(zip(("start", "length", "angle"), (start, *_way(start, end)), strict=True))
    g.fields = _points(it, g, a, ("start",))
    reach, angle = _size(it, g, a, "length"), _size(it, g, a, "angle", ANGLE)
    made = polar(g.fields["start"], reach.expression, angle.expression)
    if end is not None:
        it.became_point(end, made, g, "end")
        for unknown in ex.unknowns([reach.expression, angle.expression]):
            unknown.implied = True
    g.fields |= {"end": made, "length": reach, "angle": angle}


def _circle(it: Interpreter, g: Geometry, a: Arguments, env: Env) -> None:
    g.fields = _points(it, g, a, ("center",))
    if "radius" in a:
        g.fields["radius"] = _size(it, g, a, "radius")
    else:
        diameter = _size(it, g, a, "diameter")
        g.fields |= {"diameter": diameter, "radius": length(diameter.expression * 0.5)}


def _arc(it: Interpreter, g: Geometry, a: Arguments, env: Env) -> None:
    g.clockwise = a.get("clockwise") is True
    written, a = a, _by_angles_if_round(a)
    if "start_angle" in a:
        _arc_by_angles(it, g, a)
        for name in ("start", "end") if a is not written else ():
            it.became_point(_written(written, name), _written(g.fields, name), g, name)
    elif "radius" in a:
        _arc_by_radius(it, g, a)
    else:
        g.fields = _points(it, g, a, ("center", "start", "end"))
        g.fields["radius"] = length(distance(g.fields["center"], g.fields["start"]))
    if "start_angle" not in a:
        hidden = [distance(g.fields["center"], g.fields["end"])]
        if "radius" in a:
            hidden.append(distance(g.fields["center"], g.fields["start"]))
        radius = certain(g.fields["radius"], Num)
        assert g.span is not None
        node = ast.Identifier(span=g.span, text=g.type)
        if comparisons := equated(it, [(length(h), radius) for h in hidden], node):
            it.hidden.append((g, comparisons))


def _by_angles_if_round(a: Arguments) -> Arguments:
    """Returns three literal points of one circle, rounded as by hand, as a radius and two angles."""
    if not all(name in a and _is_literal(_written(a, name)) for name in ("center", "start", "end")):
        return a
    center = _written(a, "center")
    (radius, first), (other, last) = (_way(center, _written(a, name)) for name in ("start", "end"))
    if differ(radius.value, other.value) > ROUND:
        return a
    return {"center": center, "radius": radius, "start_angle": first, "end_angle": last}


def _arc_by_angles(it: Interpreter, g: Geometry, a: Arguments) -> None:
    g.fields = _points(it, g, a, ("center",))
    radius = _size(it, g, a, "radius")
    ends = {n: _size(it, g, a, f"{n}_angle", ANGLE) for n in ("start", "end")}
    centre = g.fields["center"]
    g.fields |= {n: polar(centre, radius.expression, angle.expression) for n, angle in ends.items()}
    g.fields |= {"radius": radius, "start_angle": ends["start"], "end_angle": ends["end"]}


def _arc_by_radius(it: Interpreter, g: Geometry, a: Arguments) -> None:
    """Makes the centre an unknown tied by two equations: a formula would be singular at half a circle."""
    g.fields = _points(it, g, a, ("start", "end"))
    g.fields["radius"] = radius = _size(it, g, a, "radius")
    start, end = g.fields["start"], g.fields["end"]
    chord = distance(start, end).value
    reach = radius.value
    height = (max(reach * reach - chord * chord / 4, 0.0)) ** 0.5
    # Counter-clockwise and shorter than half a turn, the centre lies to the left of the chord.
    side = 1.0 if (a.get("large") is True) == g.clockwise else -1.0
    c, s = ex.exact_turn(direction(start, end).value + 90.0 * side)
    (ax, ay), (bx, by) = xy(start).written, xy(end).written
    x, y = (ax + bx) / 2 + height * c, (ay + by) / 2 + height * s
    center = PointVal(Num(ex.constant(x), LENGTH), Num(ex.constant(y), LENGTH))
    g.fields["center"] = positions(it, [center], g, ["center"])[0]


def _plain(it: Interpreter, g: Geometry, a: Arguments, env: Env) -> None:
    """Sets the fields of a kind that is called in one way to its arguments. Its points are no corners, and a
    direction that may be left out stays 0 until something asks for another.
    """
    points, numbers = _given(g.type)
    placed = positions(it, [_written(a, name) for name in points], g, points, edges=False)
    g.fields = dict(zip(points, placed, strict=True))
    for name, kind, is_optional in numbers:
        if is_optional and kind.dimension == ANGLE:
            angle = certain(a.get(name, Num(ex.ZERO, ANGLE)), Num)
            g.fields[name] = turn(it, angle, g, name, rotatable=False)
        else:
            g.fields[name] = _size(it, g, a, name, kind.dimension)


@cache
def _given(kind: str) -> tuple[tuple[str, ...], tuple[tuple[str, NumberType, bool], ...]]:
    """Returns the points and the numbers among the parameters of a kind that are its fields."""
    (signature,) = SIGNATURES[kind]
    fields = [each for each in signature.parameters if each[0] in PRIMITIVES[kind].types]
    points = tuple(name for name, of, _ in fields if isinstance(of, PointType))
    return points, tuple((name, of, may_lack) for name, of, may_lack in fields if isinstance(of, NumberType))


def _glyphs(it: Interpreter, g: Geometry, a: Arguments, env: Env) -> None:
    g.glyphs = typeset(it, a)
    g.filled = is_filled(a, g.glyphs)
    it.count_entity(None, len(g.glyphs))
    g.bridge = bridge(it, a)
    _plain(it, g, a, env)


def _traced(it: Interpreter, g: Geometry, a: Arguments, env: Env) -> None:
    g.trace = trace_of(it, certain(a["part"], TextVal).value)
    unit = certain(a["unit"], Num)
    if unit.value < 0:
        message = f"the scale of this drawing is {unit.value:g}, and sizes are never negative"
        hints = ["`angle: 180deg` turns it about, and `mirror(…)` makes a mirror image of it"]
        it.report("E0515", message, it.place(it.call_sites[-1]), hints=hints)
    g.filled = a.get("filled") is True
    it.count_entity(None, len(g.trace.strokes))
    _plain(it, g, a, env)


_OWN: Mapping[str, Callable[[Interpreter, Geometry, Arguments, Env], None]] = {
    "point": _point,
    "line": _line,
    "circle": _circle,
    "arc": _arc,
    "glyphs": _glyphs,
    "traced": _traced,
}

CONSTRUCTORS = {kind: _OWN.get(kind, _plain) for kind in PRIMITIVES}


def construct(it: Interpreter, kind: str, arguments: Arguments, node: ast.Node, env: Env) -> Geometry:
    """Makes a primitive from arguments that fit one of its constructors."""
    it.count_entity(node)
    if kind == "arc" and isinstance(node, ast.Call):
        check_bare_points(it, node, arguments)
    geometry = Geometry(kind, env.here, it.place(node))
    CONSTRUCTORS[kind](it, geometry, arguments, env)
    return geometry


def hidden_constraints(it: Interpreter) -> list[Constraint]:
    """Returns the equations of geometry that became part of the model."""
    found: list[Constraint] = []
    for g, comparisons in it.hidden:
        if (g.name or g.known_as) and g.span is not None:
            text = f"{g.path.removeprefix(g.owner.path + '.')} is an arc of one radius"
            found.append(Constraint(g.owner, comparisons, text, g.span, is_inherent=True))
    return found
