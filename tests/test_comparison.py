"""What a comparison of two models finds, against what was done to them."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import aidl_lang
from aidl_lang.export.comparison import Comparison, GeometryChange, StructureChange, Version, compare
from aidl_lang.export.comparison.changes import Fields, Move, Sort
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import SolvedStructure
from tests import compiled
from tests.amount import tries
from tests.documents import ROOT
from tests.geometry.models import circle, model, polygon, structure

PARAMS: dict[str, dict[str, str | float]] = {
    "telephone": {"width": 200},
    "motor_bracket": {"motor": "nema23"},
    "lighthouse": {"stripes": 4},
}


def difference(before: str, after: str) -> Comparison:
    models = [aidl_lang.compile(text) for text in (before, after)]
    assert [d.message for m in models for d in m.diagnostics if d.is_error] == []
    return aidl_lang.diff(*models)


def of(comparison: Comparison, path: str) -> StructureChange:
    """The only entry for a path."""
    (found,) = [s for s in comparison.structures if s.path == path]
    return found


def paths(comparison: Comparison) -> list[str]:
    return [s.path for s in comparison.structures]


def near(fields: Fields) -> dict[str, object]:
    """Fields to compare with numbers worked out by hand."""
    return {name: tuple(_near(value) for value in pair) for name, pair in fields.items()}


def _near(value: object) -> object:
    if isinstance(value, tuple):
        return tuple(map(_near, value))
    return pytest.approx(value, abs=1e-8) if isinstance(value, float) else value


PLATE = "solid plate {{ edge = rectangle(center: fixed({at}), width: {width}, height: 20) {more} }}"


def plate(at: str = "(0, 0)", width: float = 40, more: str = "") -> str:
    return PLATE.format(at=at, width=width, more=more)


# --- Kinds of change -------------------------------------------------------------------------------


def test_turned() -> None:
    arm = """
    assembly a {{
        solid base {{ foot = square(center: fixed((0, -50)), size: 9) }}
        solid arm rotated {angle}deg {{
            bar = rectangle(center: fixed((20, 0)), width: 40, height: 6)
            hole pin {{ rim = circle(center: fixed((35, 0)), radius: 2) }}
        }}
    }}"""
    found = difference(arm.format(angle=10), arm.format(angle=55))
    move = of(found, "a.arm").move
    assert move is not None
    assert move.turn == pytest.approx(45)
    assert not move.mirrored
    assert move.fixed_point == pytest.approx((0, 0), abs=1e-9)
    assert paths(found) == ["a", "a.arm"]


def test_an_ellipse_turns_by_its_axis() -> None:
    text = "solid s {{ e = ellipse(center: fixed((5, 0)), rx: 8, ry: 3, angle: fixed({angle}deg)) }}"
    (change,) = difference(text.format(angle=10), text.format(angle=170)).structures
    assert change.move is not None
    assert change.move.turn == pytest.approx(-20)  # the shorter way: an ellipse turned by 180° is the same


def test_appeared_and_vanished() -> None:
    cord = "solid cord { c = circle(center: fixed((0, 90)), radius: 3) }"
    label = "solid label { r = square(center: fixed((0, -90)), size: 4) }"
    found = difference(f"assembly t {{ {plate()} {label} }}", f"assembly t {{ {plate()} {cord} }}")
    assert (of(found, "t.cord").sort, of(found, "t.label").sort) == ("appeared", "vanished")
    assert near(of(found, "t.cord").sizes) == {
        "width": (None, 6),
        "height": (None, 6),
        "area": (None, 9 * math.pi),
        "perimeter": (None, 6 * math.pi),
        "centroid": (None, (0, 90)),
    }
    assert near(of(found, "t.label").sizes)["area"] == (16, None)


@pytest.mark.parametrize("x", [0, 12])
def test_renamed(x: float) -> None:
    part = "solid {name} {{ c = circle(center: fixed(({x}, 90)), radius: 3) }}"
    texts = [part.format(name="old", x=0), part.format(name="new", x=x)]
    found = difference(*(f"assembly t {{ {plate()} {text} }}" for text in texts))
    change = of(found, "t.new")
    assert (change.sort, change.was) == ("changed", "t.old")
    assert change.move == (Move(12.0, 0.0) if x else None)
    assert "t.old" not in paths(found)


def test_renamed_geometry() -> None:
    text = (
        "solid s {{ {a} = circle(center: origin, radius: 3) {b} = circle(center: fixed((9, 0)), radius: 3) }}"
    )
    (change,) = difference(text.format(a="p", b="q"), text.format(a="p", b="z")).structures
    assert change.geometry == (GeometryChange("z", "circle", was="q"),)
    assert change.sizes == {}


def test_params_and_attributes() -> None:
    before = (
        '@material("steel") @thickness(3mm) @detached '
        "solid s { param w = 40 in 10..90 edge = square(size: 20) assert w > 0 }"
    )
    after = before.replace("steel", "brass").replace("3mm", "4mm").replace("@detached", '@layer("cut")')
    change = of(difference(before, after.replace("40", "50")), "s")
    assert change.params == {"w": (40.0, 50.0)}
    assert change.settings == {
        "@material": ("steel", "brass"),
        "@thickness": (3.0, 4.0),
        "@layer": (None, "cut"),
        "@detached": (True, None),
    }
    assert (change.sizes, change.move, change.geometry) == ({}, None, ())


def test_fillets() -> None:
    found = of(difference(plate(more="fillet(edge, 2)"), plate(more="fillet(edge, 3)")), "plate")
    assert found.settings == {"fillet of edge": (2.0, 3.0)}
    assert near(found.sizes)["area"] == (800 - 4 * (4 - math.pi), 800 - 9 * (4 - math.pi))
    assert found.geometry == ()


def test_a_line_and_an_arc() -> None:
    text = """
    drawing d {{
        l = line(fixed((0, 0)), fixed(({x}, 4)))
        a = arc(center: fixed((9, 9)), radius: 2, start_angle: 0deg, end_angle: fixed({end}deg))
    }}"""
    (change,) = difference(text.format(x=3, end=90), text.format(x=4, end=180)).structures
    line, arc = change.geometry
    assert near(line.fields)["end"] == ((3, 4), (4, 4))
    assert near(line.fields)["length"] == (5, math.sqrt(32))
    assert near(arc.fields) == {"end": ((9, 11), (7, 9)), "sweep": (90, 180)}


def test_letters_have_an_outline_alone() -> None:
    text = 'drawing d {{ t = text("{}", height: 5) }}'
    (change,) = difference(text.format("on"), text.format("no")).structures
    (letters,) = change.geometry
    assert (letters.is_outline_changed, letters.fields, letters.move) == (True, {}, None)


def test_contacts() -> None:
    lid = "solid lid {{ r = rectangle(center: fixed((0, {y})), width: 10, height: 4) }}"
    touching, apart, over = (f"assembly t {{ {plate()} {lid.format(y=y)} }}" for y in (12, 14, 11))
    (change,) = difference(touching, apart).contacts
    assert (change.a, change.b) == ("t.plate", "t.lid")
    assert change.before is not None
    assert change.after is not None
    assert (change.before.relation, change.after.relation) == ("touching", "apart")
    assert change.after.gap == pytest.approx(2)
    (change,) = difference(apart, over).contacts
    assert change.after is not None
    assert change.after.relation == "overlapping"
    assert change.after.area == pytest.approx(10)


def test_plans_have_boxes() -> None:
    text = """
    assembly a {{
        solid s {{ c = circle(center: fixed((0, -9)), radius: 1) }}
        solid plan {{ todo }}
        constrain {{ plan.left == {x}; plan.bottom == 0; plan.width == {w}; plan.height == 5 }}
    }}"""
    moved = difference(text.format(x=0, w=10), text.format(x=4, w=10))
    assert _same_move(of(moved, "a.plan").move, Move(4.0, 0.0))
    assert near(of(difference(text.format(x=0, w=10), text.format(x=0, w=12)), "a.plan").sizes) == {
        "width": (10, 12)
    }


def test_a_second_root_puts_the_first_into_an_assembly() -> None:
    found = difference(
        plate(), f"{plate()} @detached solid lid {{ c = circle(center: fixed((0, 0)), radius: 1) }}"
    )
    assert [(s.path, s.sort) for s in found.structures] == [("text.lid", "appeared")]


# --- Telling little --------------------------------------------------------------------------------

ARM = """
assembly a {{
    solid base {{ foot = square(center: fixed((0, -50)), size: 9) }}
    assembly arm at ({x}, 0) {{
        solid bar {{ r = rectangle(center: fixed((0, 0)), width: 40, height: 6) }}
        solid knob {{ c = circle(center: fixed((15, {y})), radius: {r}) }}
        solid cap {{ c = circle(center: fixed((-15, 9)), radius: 2) }}
    }}
}}
"""


def test_what_did_not_go_along_is_told() -> None:
    found = difference(ARM.format(x=0, y=9, r=2), ARM.format(x=6, y=20, r=2))
    assert of(found, "a.arm").move == Move(6.0, 0.0)
    assert of(found, "a.arm.knob").move == Move(6.0, 11.0)
    still = ARM.replace("fixed((15", "fixed((9")
    assert of(difference(ARM.format(x=0, y=9, r=2), still.format(x=6, y=9, r=2)), "a.arm.knob").move == Move()


def test_no_majority_no_motion() -> None:
    text = """
    assembly a {{
        assembly b {{
            solid c {{ k = circle(center: fixed(({x}, 0)), radius: 1) }}
            solid d {{ k = circle(center: fixed((9, 0)), radius: 1) }}
        }}
        solid e {{ k = circle(center: fixed((0, 40)), radius: 1) }}
    }}"""
    found = difference(text.format(x=0), text.format(x=3))
    assert [(s.path, s.move) for s in found.structures if s.move] == [("a.b.c", Move(3.0, 0.0))]


def test_rounding_is_no_difference() -> None:
    assert difference(plate(), plate("(0.00001, 0)", 40.00001)).is_equal  # 1e-6 of 40 mm is 4e-5 mm
    assert not difference(plate(), plate("(0.0001, 0)")).is_equal


# --- Every example ---------------------------------------------------------------------------------


@pytest.mark.parametrize("path", compiled.FEW)
def test_every_example_equals_itself(path: Path) -> None:
    assert aidl_lang.diff(compiled.example(path.stem), aidl_lang.compile(path)).is_equal


@pytest.mark.parametrize("name", PARAMS)
def test_the_other_way_round(name: str) -> None:
    a, b = compiled.example(name), aidl_lang.compile(ROOT / "examples" / f"{name}.aidl", PARAMS[name])
    assert a.ok
    assert b.ok
    there, back = aidl_lang.diff(a, b), aidl_lang.diff(b, a)
    assert not there.is_equal
    assert {(c.a, c.b, c.before, c.after) for c in there.contacts} == {
        (c.a, c.b, c.after, c.before) for c in back.contacts
    }
    mirrored = {s.path: s for s in map(_reversed, back.structures)}
    assert mirrored.keys() == set(paths(there))
    for s in there.structures:
        other = mirrored[s.path]
        assert (other.sort, other.was) == (s.sort, s.was)
        assert _same_move(other.move, s.move)
        assert near(s.sizes) == other.sizes
        assert near(s.params) == other.params
        assert near(s.settings) == other.settings
        assert [(g.name, g.sort) for g in sorted(other.geometry, key=lambda g: g.name)] == [
            (g.name, g.sort) for g in sorted(s.geometry, key=lambda g: g.name)
        ]


def _reversed(s: StructureChange) -> StructureChange:
    sorts: dict[Sort, Sort] = {"changed": "changed", "appeared": "vanished", "vanished": "appeared"}

    def turned(fields: Fields) -> Fields:
        return {name: (b, a) for name, (a, b) in fields.items()}

    return replace(
        s,
        path=s.was or s.path,
        was=s.path if s.was else None,
        sort=sorts[s.sort],
        move=_inverse(s.move),
        sizes=turned(s.sizes),
        params=turned(s.params),
        settings=turned(s.settings),
        geometry=tuple(replace(g, sort=sorts[g.sort]) for g in s.geometry),
    )


def _inverse(move: Move | None) -> Move | None:
    if move is None:
        return None
    back = Move(turn=move.turn if move.mirrored else -move.turn, mirrored=move.mirrored)
    x, y = back((move.dx, move.dy))
    return replace(back, dx=-x, dy=-y)


def _same_move(a: Move | None, b: Move | None) -> bool:
    if a is None or b is None:
        return a is b
    return all(math.dist(a(p), b(p)) < 1e-6 for p in ((0.0, 0.0), (100.0, 0.0), (0.0, 100.0)))


# --- Random motions --------------------------------------------------------------------------------

NUMBERS = st.floats(-100, 100, allow_nan=False)
MOVES = st.builds(Move, NUMBERS, NUMBERS, st.floats(-179, 180), st.booleans())
L_SHAPE = [(0.0, 0.0), (40.0, 0.0), (40.0, 10.0), (10.0, 10.0), (10.0, 30.0), (0.0, 30.0)]


def _version(moves: list[Move]) -> Version:
    def part(i: int, move: Move) -> SolvedStructure:
        corners = [move((x + 60 * i, y)) for x, y in L_SHAPE]
        x, y = move((60.0 * i + 20, 5.0))
        hole = structure("hole", "eye", circle("rim", x, y, 3))
        return structure("solid", f"part[{i}]", polygon("edge", *corners), hole)

    anchor = structure("solid", "anchor", circle("c", 7, -500, 5))
    solved = model(structure("assembly", "all", anchor, *(part(i, move) for i, move in enumerate(moves))))
    return Version(solved, draw(solved)[0])


@tries(60)
@given(st.lists(MOVES, min_size=1, max_size=3))
def test_random_motions_are_found(moves: list[Move]) -> None:
    found = compare(_version([Move()] * len(moves)), _version(moves))
    told = {s.path: s for s in found.structures}
    around = told.pop("all").move if "all" in told else None
    for i, move in enumerate(moves):
        corners: list[Vec] = [(x + 60 * i, y) for x, y in L_SHAPE]
        change = told.pop(f"all.part[{i}]", None)
        seen = (around or Move()) if change is None else change.move
        assert seen is not None
        assert change is None or not (change.sizes or change.geometry)
        assert all(math.dist(seen(p), move(p)) < 4e-6 * found.size for p in corners)
    assert told.keys() <= {"all.anchor"}
