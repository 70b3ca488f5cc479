"""Makes the drawing of a solution: numbers read off, names with places, regions, and diagnostics."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from aidl_lang.building import expression as ex
from aidl_lang.building.attributes import FILLING, OF_AREAS
from aidl_lang.building.curves import clockwise, number, pieces, translate, xy
from aidl_lang.building.expression import DEGREE, Evaluator, Place
from aidl_lang.building.lower import Lowered, Solved
from aidl_lang.building.model import Finish, Geometry, Model, Structure, convert, own_geometry
from aidl_lang.building.state import NameBinding, ParamBinding, PassedBinding, Scope, VarBinding
from aidl_lang.building.values import Num, PointVal, TextVal, Value
from aidl_lang.checking.units import PLAIN
from aidl_lang.common.diagnostics import Diagnostic, blaming
from aidl_lang.common.records import record
from aidl_lang.common.running import Later, Stopwatch, checkpoint, working
from aidl_lang.common.source import Span
from aidl_lang.geometry import curves, solved
from aidl_lang.geometry.boolean import stencilled, united_character
from aidl_lang.geometry.curves import LARGEST, Bounds, Curve, Vec
from aidl_lang.geometry.drawing import Drawing, Findings, draw
from aidl_lang.geometry.faces import as_edges, parts_of
from aidl_lang.geometry.notes import unusable_note
from aidl_lang.geometry.solved import Scalar, SolvedGeometry, SolvedModel, SolvedStructure, Values, described
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.common.lettering import Glyph
    from aidl_lang.solver.analysis import Freedom

_HEAVY = "most of its curves are made here"


def pictured(
    built: Model, solution: Solved, freedom: Callable[[], Freedom], watch: Stopwatch
) -> tuple[SolvedModel, Evaluator, Drawing, Findings]:
    """Returns the solved model with its evaluator, its drawing, and diagnostics on it."""
    with watch("read out"):
        model, evaluator = read_out(built, solution, freedom)
    with watch("regions"), blaming(partial(_most_drawn, model), _HEAVY):
        model, notes = with_places(replace(model, size_up=partial(_sizes, built, evaluator)))
        if model.is_unfinished:
            from aidl_lang.geometry.outlines import complete

            model, more = complete(model)
            notes += more
        drawing, found = draw(model)
        if any(s.ground is not None for s in model.root.walk()):
            from aidl_lang.geometry.outlines import on_material

            model = on_material(model, drawing)
            drawing, found = draw(model)

    def everything() -> list[Diagnostic]:
        with watch("notes"), blaming(partial(_most_drawn, model), _HEAVY):
            return [*notes, *found.everything()]

    errors = [*(d for d in notes if d.is_error), *found.errors]
    return model, evaluator, drawing, Findings(errors, everything)


def _sizes(built: Model, evaluator: Evaluator, model: SolvedModel) -> tuple[solved.Dimension, ...]:
    from aidl_lang.geometry.dimensions import sizes

    with working:
        return sizes(built, model, evaluator)


def _most_drawn(model: SolvedModel) -> Span | None:
    """Returns the statement of the program that makes more curves than any other."""
    made: Counter[Span] = Counter()
    for structure in model.root.walk():
        for geometry in structure.geometry:
            if geometry.span is not None:
                made[geometry.span] += sum(1 for each in geometry.walk() if each.curve is not None)
    return max(made, key=lambda span: made[span], default=None)


# --- Model + Solution → SolvedModel: every number read off at the solved values, in the frame of the root.


def read_out(model: Model, solution: Solved, freedom: Callable[[], Freedom]) -> tuple[SolvedModel, Evaluator]:
    """Returns the solved model, with its `freedom` worked out on demand, and the evaluator of its values."""
    lowered = solution.problem
    values = lowered.by_unknown(solution.values)
    evaluator = Evaluator(values)
    changed = tuple(
        solved.Change(u.path, u.guess, values[u], u.holder.span, u.description, u.is_size)
        for u in map(lowered.unknowns.__getitem__, solution.changed)
    )
    reports = tuple(_reports(model, solution))
    root = _Reader(model, evaluator).structure(model.root)
    readings = tuple(dict.fromkeys(solved.Reading(span, text) for span, text in model.readings))
    mobility = Later(partial(_mobility, model, solution, freedom))
    return SolvedModel(solution.status.value, root, reports, changed, readings, mobility), evaluator


def _mobility(model: Model, solution: Solved, freedom: Callable[[], Freedom]) -> solved.Mobility:
    found = freedom()

    def ways() -> tuple[solved.Motion, ...]:
        from aidl_lang.geometry.freedom import motions

        return motions(model, solution, found)

    each = zip(model.root.walk(), found.group_degrees, found.states, strict=True)
    return solved.Mobility(
        found.degrees,
        tuple(solution.problem.unknowns[i].path for i in found.free),
        tuple(_floating(solution.problem, found)),
        {structure.path: (degrees, str(state)) for structure, degrees, state in each},
        Later(ways),
    )


def _literal(model: Model, finish: Finish) -> ast.Number | None:
    """Returns the number that is the size of a fillet or chamfer, if no constraint mentions it."""
    if not finish.sizes:
        return None
    size, *more = finish.sizes
    rows = (c for constraint in model.constraints for c in constraint.comparisons)
    if more or size.expression.payload in set(ex.unknowns(side for c in rows for side in (c.left, c.right))):
        return None
    node = next((each.node for each in model.literals if each.became is size.expression), None)
    return node if isinstance(node, ast.Number) and finish.span.overlaps(node.span) else None


def _floating(lowered: Lowered, freedom: Freedom) -> Iterator[str]:
    """Yields the paths of structures with guessed values that no constraint ties to what is around them."""
    guessed = set(zip(lowered.group.tolist(), lowered.axis.tolist(), strict=True))
    for group in freedom.loose:
        if (group, 0) in guessed and (group, 1) in guessed:
            yield lowered.groups[group]


def _reports(model: Model, solution: Solved) -> Iterator[solved.ConstraintReport]:
    number = {stated: index for index, stated in enumerate(solution.problem.stated)}
    for stated in model.constraints:
        if (index := number.get(stated)) is not None:
            yield solved.ConstraintReport(
                stated.holder.path,
                f"{stated.text} [{stated.label}]" if stated.label else stated.text,
                stated.span,
                solution.residuals[index],
                solution.satisfied[index],
                Later(partial(getattr, stated, "mentions")),
                stated.weight is not None,
                all(comparison.relation == "==" for comparison in stated.comparisons),
            )


@record(frozen=False)
class _Reader:
    model: Model
    evaluate: Evaluator

    def place(self, at: Place, owner: Structure) -> Vec:
        """Returns a point of `owner` in the frame of the root."""
        x, y = convert(at, owner, self.model.root)
        return self.evaluate(x), self.evaluate(y)

    def structure(self, s: Structure) -> SolvedStructure:
        geometry = tuple(map(self._named, s.own()))
        children = tuple(self.structure(child) for child in s.children)
        frame = s.frame
        return SolvedStructure(
            name=s.name,
            path=s.path,
            kind=s.kind,
            orientation=self._orientation(s),
            frame=solved.Frame(
                self.evaluate(frame.x), self.evaluate(frame.y), self.evaluate(frame.rotation), frame.mirrored
            ),
            attributes=self._attributes(s),
            params=dict(self._params(s)),
            geometry=geometry,
            structures=children,
            box=self._box(s, geometry, children),
            is_empty=s.is_empty,
            span=s.span,
            finishes=tuple(self._finish(s, f) for f in s.finishes),
            doc=s.doc,
            clip=tuple(map(self.geometry, s.clip)),
            ground=s.ground.path if s.ground is not None else None,
        )

    def _params(self, s: Structure) -> Iterator[tuple[str, Scalar]]:
        """Yields every named number of a structure itself: its params, variables and arguments."""
        assert isinstance(s.scope, Scope)
        # The root shows the params of the file, too.
        scopes = list(s.scope.chain()) if s is self.model.root else [s.scope]
        for scope in reversed(scopes):
            for name, binding in scope.values.items():
                value: Value | None = None
                match binding:
                    case ParamBinding(known=known):
                        value = known
                    case VarBinding(value=known) if scope is s.scope:
                        value = known
                    case PassedBinding(tied=tied):
                        # A copy shares those of its source.
                        value = tied.get(s) or tied.get(binding.instance, binding.value)
                    case TextVal() | bool() if scope is s.scope:
                        value = binding
                if isinstance(value, Num | TextVal | bool):
                    yield name, self._scalar(value)

    def _orientation(self, s: Structure) -> str:
        match s.attributes.get("orientation"):
            case (TextVal(word),):
                return word
            case _:
                return self._orientation(s.parent) if s.parent is not None else "top"

    def _attributes(self, of: Structure | Geometry) -> dict[str, tuple[Scalar, ...]]:
        return {name: tuple(map(self._scalar, values)) for name, values in of.attributes.items()}

    def _looks(self, g: Geometry) -> dict[str, tuple[Scalar, ...]]:
        """Returns the look of a solid in a solid, for its geometry: an area of the body that both are."""
        looks: dict[str, tuple[Scalar, ...]] = {}
        s = g.owner if g.container is g.owner else None
        while s is not None and s.kind == "solid" and s.parent is not None and s.parent.kind == "solid":
            stated = self._attributes(s)
            names = ("opacity",) if stated.keys().isdisjoint(FILLING) else OF_AREAS
            looks = {n: v for n, v in stated.items() if n in names} | looks
            s = s.parent
        return looks

    def _scalar(self, value: Value) -> Scalar:
        match value:
            case Num(expression, _, _):
                return self.evaluate(expression)
            case TextVal(text):
                return text
            case bool():
                return value
            case _:
                return str(value)

    def _box(
        self, s: Structure, geometry: Iterable[SolvedGeometry], children: Iterable[SolvedStructure]
    ) -> solved.Box | None:
        corners: list[Bounds] = []
        if s.plan:
            left, bottom, width, height = s.plan
            for corner in (Place(left, bottom), Place(left + width, bottom + height)):
                x, y = self.place(corner, s)
                corners.append((x, y, x, y))
        return solved.Box.around((curve for g in geometry for curve in g.curves()), children, corners)

    # --- Geometry ------------------------------------------------------------------------------

    def _named(self, g: Geometry) -> SolvedGeometry:
        with blaming(lambda: g.span, "it came as far as this"):
            checkpoint()
            return self.geometry(g)

    def geometry(self, g: Geometry) -> SolvedGeometry:
        if g.type == "glyphs":
            return self._text(g)
        if g.trace is not None:
            return self._drawing(g)
        recipe = None
        if (of := g.recipe) is not None:
            operands = tuple(tuple(map(self.geometry, group)) for group in of.operands)
            numbers = {name: self._number(value) for name, value in of.numbers.items()}
            recipe = solved.Recipe(of.kind, operands, numbers, of.words)
        is_plain = not g.is_compound and not g.is_drawn_later and g.type != "point"
        curve = self._curve(g) if is_plain else None
        if is_plain and curve is None:
            parts = as_edges(g, map(_through, self._pieces(g)))
        else:
            parts = tuple(self.geometry(part) for part in own_geometry(g.parts, g))
        return self._solved(g, self._own_values(g, curve), parts, curve, recipe)

    def _solved(
        self,
        g: Geometry,
        values: Values,
        parts: tuple[SolvedGeometry, ...],
        curve: Curve | None = None,
        recipe: solved.Recipe | None = None,
    ) -> SolvedGeometry:
        source = g.source.path if g.source is not None else None
        looks = self._looks(g) | self._attributes(g)
        known = g.type, values, curve, parts, g.construction, g.span, recipe, source, looks
        return SolvedGeometry(g.name or g.type, g.path, *known)

    def _finish(self, s: Structure, finish: Finish) -> solved.Finish:
        at = self._at(finish.at, s) if finish.at is not None else None
        of = tuple(g.path for g in finish.of)
        sizes = tuple(map(self._number, finish.sizes))
        literal = Later(partial(_literal, self.model, finish))
        return solved.Finish(
            finish.kind, of, at, sizes, finish.text, finish.span, run=finish.run, literal=literal
        )

    def _text(self, g: Geometry) -> SolvedGeometry:
        """Returns a text with its characters as parts, and the curves of each as theirs."""
        height = self._number(g.fields["height"])
        start, turn, _, at = self._placing(g, height)
        bridge = self._bridge(g, height)
        glyphs = tuple(_glyph(g, f"glyph[{i}]", glyph, bridge, at) for i, glyph in enumerate(g.glyphs))
        return self._solved(g, {"start": start, "height": height, "angle": math.degrees(turn)}, glyphs)

    def _placing(self, g: Geometry, unit: float) -> tuple[Vec, float, float, Callable[[Vec], Vec]]:
        """Returns the start of a text or a drawing, its turn in radians, -1 if it is turned over and else 1,
        and where its points in units of its own lie.
        """
        x, y = start = self._at(g.fields["start"], g.owner)
        c, s = ex.exact_turn(self._direction(g))
        sense = -1.0 if clockwise(g, self.model.root) else 1.0

        def at(p: Vec) -> Vec:
            u, v = unit * p[0], sense * unit * p[1]
            return x + u * c - v * s, y + u * s + v * c

        return start, math.atan2(s, c), sense, at

    def _bridge(self, text: Geometry, height: float) -> float:
        """Returns the width of the bridges of a text in units of its height; 0 for none."""
        if text.bridge is None or height <= 0:
            return 0.0
        return text.bridge.value if text.bridge.dimension == PLAIN else text.bridge.value / height

    def _drawing(self, g: Geometry) -> SolvedGeometry:
        """Returns a drawing of another program, with its shapes as parts and the curves of each as theirs."""
        unit = self._number(g.fields["unit"])
        start, turn, sense, at = self._placing(g, unit)
        shapes = parts_of(g, at, unit, turn, sense)
        return self._solved(g, {"start": start, "unit": unit, "angle": math.degrees(turn)}, shapes)

    def _at(self, value: Value, owner: Structure) -> Vec:
        return self.place(xy(value), owner)

    def _direction(self, g: Geometry) -> float:
        return self._number(translate("angle", g.fields["angle"], g.owner, self.model.root))

    def _number(self, value: Value) -> float:
        return self.evaluate(number(value))

    def _own_values(self, g: Geometry, curve: Curve | None) -> Values:
        if curve is not None:
            return described(curve)[1]
        if g.is_compound:
            assert isinstance(g.scope, Scope)
            return self._values({name: g.scope.values[name] for name in g.arguments}, g.owner)
        return self._values(g.recipe.numbers if g.recipe and g.is_drawn_later else g.fields, g.owner)

    def _values(self, values: Mapping[str, NameBinding], owner: Structure) -> Values:
        found: Values = {}
        for name, value in values.items():
            if isinstance(value, PointVal):
                found[name] = self._at(value, owner)
            elif isinstance(value, Num):
                found[name] = self._number(translate(name, value, owner, self.model.root))
        return found

    def _curve(self, g: Geometry) -> Curve | None:
        """Returns the curve of a primitive; None for one made of lines and cubics."""
        core, at = g.fields, partial(self._at, owner=g.owner)
        match g.type:
            case "line" | "bezier":
                (points,) = self._pieces(g)
                return _through(points)
            case "circle":
                return curves.Circle(at(core["center"]), self._number(core["radius"]))
            case "ellipse":
                rx, ry = self._number(core["rx"]), self._number(core["ry"])
                return curves.Ellipse(at(core["center"]), rx, ry, self._direction(g) * DEGREE)
            case "arc":
                return self._arc(g)
            case _:
                return None

    def _pieces(self, g: Geometry) -> Iterator[list[Vec]]:
        """Yields the ends of the lines and the control points of the cubics that a primitive is made of."""
        for piece in pieces(g, g.owner):
            yield [self.place(at, g.owner) for at in piece]

    def _arc(self, g: Geometry) -> Curve:
        center, start, end = (self._at(g.fields[n], g.owner) for n in ("center", "start", "end"))
        first, last = (math.atan2(p[1] - center[1], p[0] - center[0]) for p in (start, end))
        is_clockwise = clockwise(g, self.model.root)
        turn = (first - last if is_clockwise else last - first) % math.tau
        turn = math.tau if turn < 1e-12 else turn
        radius = self._number(g.fields["radius"])
        return curves.Arc(center, radius, start, end, -turn if is_clockwise else turn)


def _glyph(
    text: Geometry, name: str, glyph: Glyph, bridge: float, at: Callable[[Vec], Vec]
) -> SolvedGeometry:
    """Returns a character, its curves as parts; `bridge`: the width of bridges per height, 0 for none."""
    checkpoint()
    outline = glyph.curves if glyph.is_nested else united_character(glyph.curves)
    outline = stencilled(outline, bridge) if bridge else outline
    edges = as_edges(text, (_through([at(p) for p in c]) for c in outline), f"{name}.")
    known = name, f"{text.path}.{name}", "glyph", Values(), None, edges, text.construction, text.span
    return SolvedGeometry(*known, filled=text.filled, stroked=glyph.is_stroked)


def _through(points: Sequence[Vec]) -> curves.Line | curves.Bezier:
    return curves.Line(*points) if len(points) == 2 else curves.Bezier(*points)


# --- Leaves curves and values without a place out of a solved model, so that all later numbers can be drawn,
# measured and written.


def with_places(model: SolvedModel) -> tuple[SolvedModel, list[Diagnostic]]:
    """Returns the model without curves and numbers that have no place, and diagnostics on them."""
    if all(map(_is_sound, model.root.walk())):
        return model, []
    notes: list[Diagnostic] = []
    return replace(model, root=_cleaned(model.root, notes)), notes


def _is_sound(structure: SolvedStructure) -> bool:
    frame, box = structure.frame, structure.box
    return (
        _is_within((frame.x, frame.y, frame.rotation))
        and (box is None or _is_within(box.bounds))
        and all(map(_has_place, structure.geometry))
    )


def _has_place(geometry: SolvedGeometry) -> bool:
    return (
        (geometry.curve.is_finite(LARGEST) if geometry.curve else _is_within(geometry.values.values()))
        and all(map(_has_place, geometry.parts))
        and (geometry.recipe is None or _is_possible(geometry))
    )


def _is_possible(outline: SolvedGeometry) -> bool:
    assert outline.recipe is not None
    return _is_within(outline.recipe.numbers.values()) and all(
        _has_place(g) for operand in outline.recipe.operands for g in operand
    )


def _is_within(value: object) -> bool:
    if isinstance(value, float):
        return abs(value) <= LARGEST
    return isinstance(value, str | int) or (isinstance(value, Iterable) and all(map(_is_within, value)))


def _cleaned(s: SolvedStructure, notes: list[Diagnostic]) -> SolvedStructure:
    for whole in s.geometry:
        if lost := list(_lost(whole)):
            is_whole = all(g in lost for g in whole.walk() if not g.parts)
            notes.append(unusable_note(s, lost[0], whole if is_whole else lost[0]))
    geometry = tuple(map(_stripped, s.geometry))
    children = tuple(_cleaned(child, notes) for child in s.structures)
    frame, box = s.frame, s.box
    if not _is_within((frame.x, frame.y, frame.rotation)):
        frame = solved.Frame(0.0, 0.0, 0.0, frame.mirrored)
    if box is None or not s.is_empty:
        box = solved.Box.around((c for g in geometry for c in g.curves() if c.is_finite()), children)
    elif not _is_within(box.bounds):
        box = None
    return replace(s, geometry=geometry, structures=children, frame=frame, box=box)


def _lost(geometry: SolvedGeometry) -> Iterator[SolvedGeometry]:
    """Yields the innermost parts that have no place."""
    inside = [lost for part in geometry.parts for lost in _lost(part)]
    yield from inside
    if not inside and not _has_place(geometry):
        yield geometry


def _stripped(geometry: SolvedGeometry) -> SolvedGeometry:
    """Returns a geometry with those of its parts and values that have a place; its name stays."""
    if _has_place(geometry):
        return geometry
    values = {name: value for name, value in geometry.values.items() if _is_within(value)}
    is_primitive = len(values) < len(geometry.values) and not geometry.parts
    return replace(
        geometry,
        values=values,
        curve=None if is_primitive else geometry.curve,
        parts=tuple(map(_stripped, geometry.parts)),
        recipe=geometry.recipe if geometry.recipe is not None and _is_possible(geometry) else None,
    )
