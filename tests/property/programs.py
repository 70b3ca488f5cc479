"""Random small programs that are well-formed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from hypothesis import strategies as st

SIZES = st.integers(2, 40)
PLACES = st.integers(-60, 60)


@dataclass(frozen=True)
class Part:
    """A structure of a random program: its name, kind, geometry and constraints, one statement each."""

    name: str
    kind: str
    geometry: tuple[str, ...]
    constraints: tuple[str, ...]
    placement: str = ""

    def text(self, geometry: Sequence[str] | None = None, constraints: Sequence[str] | None = None) -> str:
        inside = [*(self.geometry if geometry is None else geometry)]
        held = self.constraints if constraints is None else constraints
        if held:
            inside.append("constrain { " + ", ".join(held) + " }")
        return f"{self.kind} {self.name}{self.placement} {{\n    " + "\n    ".join(inside) + "\n}"


@dataclass(frozen=True)
class Sketch:
    """A random program: an assembly of parts with relations between them."""

    parts: tuple[Part, ...]
    relations: tuple[str, ...]

    def text(self, parts: Sequence[str] | None = None, relations: Sequence[str] | None = None) -> str:
        body = "\n".join(parts if parts is not None else [p.text() for p in self.parts])
        held = self.relations if relations is None else relations
        return (
            "assembly model {\nparam unit = 3 in 1..9\n"
            + body
            + "\nconstrain {\n"
            + "\n".join(held)
            + "\n}\n}\n"
        )


DRAWN = {
    "rectangle": "{n} = rectangle(center: ({x}, {y}), width: {a}, height: {b})",
    "circle": "{n} = circle(center: ({x}, {y}), radius: {a} + unit)",
    "trapezoid": "{n} = trapezoid(center: ({x}, {y}), bottom_width: {a}, top_width: {b}, height: {a})",
    "triangle": "{n} = triangle(center: ({x}, {y}), base: {a}, height: {b})",
    "outline": "{n} = line(({x}, {y}), ({right}, {y}))|{n}_up = line({n}.end, ({right}, {top}))"
    "|{n}_back = line({n}_up.end, {n}.start)",
    "bow": "{n} = arc(center: ({x}, {y}), radius: {a}, start_angle: 0deg, end_angle: 180deg)"
    "|{n}_chord = line({n}.end, {n}.start)",
    "row": "for i in 0..2 {{ {n}[i] = circle(center: ({x} + {pitch} * i, {y}), radius: {a}) }}",
}
"""Geometry named `n`, its statements apart by bars."""
KINDS = tuple(DRAWN)

RELATIONS = (
    "{a}.above({b})",
    "{a}.below({b}, gap: {g})",
    "{a}.left_of({b}, gap: {g} - unit)",
    "{a}.right_of({b}, at_least: {g})",
    "{a}.centered_in({b})",
    "centered_horizontally({a}, {b})",
    "align_bottom({a}, {b})",
    "align_left({a}, {b}, inset: {g})",
    "{a}.stacked_on({b})",
)

COMPARISONS = (
    "{a}.bb.center_x >= {b}.bb.right + {g}",
    "{a}.bb.top == {b}.bb.bottom",
    "{a}.left == -{b}.right",
)


@st.composite
def geometry(draw: st.DrawFn, name: str, kinds: tuple[str, ...]) -> tuple[str, ...]:
    """One to three statements that draw something named `name`."""
    x, y, a, b = draw(PLACES), draw(PLACES), draw(SIZES), draw(SIZES)
    numbers = {"x": x, "y": y, "a": a, "b": b, "right": x + a, "top": y + b, "pitch": 3 * a}
    return tuple(DRAWN[draw(st.sampled_from(kinds))].format(n=name, **numbers).split("|"))


@st.composite
def part(draw: st.DrawFn, name: str) -> Part:
    first = draw(geometry("edge", KINDS))
    second = draw(st.one_of(st.just(()), geometry("mark", KINDS[:-1])))
    relations = [r for r in RELATIONS if not (first[0].startswith("for") and "align" in r)]
    constraints = (
        [draw(st.sampled_from(relations)).format(a="mark", b="edge", g=draw(SIZES))] if second else []
    )
    turn = draw(st.sampled_from(("", "", " rotated 30deg", " at (5, 5)")))
    return Part(name, draw(st.sampled_from(("solid", "drawing"))), first + second, tuple(constraints), turn)


@st.composite
def sketches(draw: st.DrawFn, least: int = 2, most: int = 3) -> Sketch:
    """Each part is related at most once to those before it, so that positions alone satisfy everything."""
    count = draw(st.integers(least, most))
    parts = tuple(draw(part(f"part_{i}")) for i in range(count))
    relations = []
    for i in range(1, count):
        other = draw(st.integers(0, i - 1))
        relation = draw(st.sampled_from(RELATIONS + COMPARISONS))
        relations.append(relation.format(a=f"part_{i}", b=f"part_{other}", g=draw(SIZES)))
    return Sketch(parts, tuple(relations))


GEOMETRIC = (
    "horizontal({a})",
    "vertical({a})",
    "parallel({a}, {b})",
    "perpendicular({a}, {b})",
    "equal_length({a}, {b})",
    "{a}.length == {g}",
    "distance({a}.start, {b}.end) >= {g}",
    "{a}.midpoint.y == {b}.start.y",
    "angle({a}, {b}, {g}deg)",
    "coincident({a}.midpoint, {b})",
    "tangent({a}, ring)",
    "ring.center == {a}.midpoint",
    "distance(ring, {a}) == {g}",
    "{a}.dx <= -{b}.dy",
)


@st.composite
def outlines(draw: st.DrawFn) -> tuple[list[str], list[str]]:
    """A closed outline of shared points and a circle, and relations that may contradict each other."""
    count = draw(st.integers(3, 5))
    points = [(20 * i + draw(st.integers(-8, 8)), draw(st.integers(-40, 40))) for i in range(count)]
    drawing = [f"p{i} = ({x}, {y})" for i, (x, y) in enumerate(points)]
    drawing += [f"edge{i} = line(p{i}, p{(i + 1) % count})" for i in range(count)]
    drawing.append(f"ring = circle(center: ({draw(PLACES)}, {draw(PLACES)}), radius: guess({draw(SIZES)}))")
    constraints = []
    for _ in range(draw(st.integers(1, 4))):
        i, shift = draw(st.integers(0, count - 1)), draw(st.integers(1, count - 1))
        relation = draw(st.sampled_from(GEOMETRIC))
        constraints.append(
            relation.format(a=f"edge{i}", b=f"edge{(i + shift) % count}", g=draw(st.integers(5, 60)))
        )
    return drawing, constraints


def outline_text(drawing: Sequence[str], constraints: Sequence[str]) -> str:
    return "\n".join(["drawing d {", *drawing, "constrain {", *constraints, "}", "}"]) + "\n"
