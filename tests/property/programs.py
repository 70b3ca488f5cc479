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


KINDS = ("rectangle", "circle", "trapezoid", "triangle", "outline", "bow", "row")

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
    match draw(st.sampled_from(kinds)):
        case "rectangle":
            return (f"{name} = rectangle(center: ({x}, {y}), width: {a}, height: {b})",)
        case "circle":
            return (f"{name} = circle(center: ({x}, {y}), radius: {a} + unit)",)
        case "trapezoid":
            return (
                f"{name} = trapezoid(center: ({x}, {y}), bottom_width: {a}, top_width: {b}, height: {a})",
            )
        case "triangle":
            return (f"{name} = triangle(center: ({x}, {y}), base: {a}, height: {b})",)
        case "outline":
            return (
                f"{name} = line(({x}, {y}), ({x + a}, {y}))",
                f"{name}_up = line({name}.end, ({x + a}, {y + b}))",
                f"{name}_back = line({name}_up.end, {name}.start)",
            )
        case "row":
            return (f"for i in 0..2 {{ {name}[i] = circle(center: ({x} + {3 * a} * i, {y}), radius: {a}) }}",)
        case _:
            return (
                f"{name} = arc(center: ({x}, {y}), radius: {a}, start_angle: 0deg, end_angle: 180deg)",
                f"{name}_chord = line({name}.end, {name}.start)",
            )


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
