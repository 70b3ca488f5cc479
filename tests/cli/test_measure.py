"""`aidl measure`: what it tells of a program, as text, as JSON and to Python."""

from __future__ import annotations

import json
import math
from itertools import combinations
from pathlib import Path

import pytest

import aidl_lang
from aidl_lang.common.materials import densities, density, similar
from tests.commands import Aidl

BOX = """\
@material("6 mm birch plywood") @thickness(6mm)
assembly box {
    solid floor {
        board = rectangle(center: fixed((0, 0)), width: 100, height: 40)
        hole drain { rim = circle(center: fixed((30, 0)), radius: 5) }
        boss = circle(center: fixed((-50, 0)), radius: 4)
        solid rib { bar = rectangle(center: fixed((0, 21)), width: 10, height: 4) }
    }
    solid lid { board = rectangle(center: fixed((0, 60)), width: 100, height: 20) }
    @material("aluminum") @thickness(2mm)
    solid pin { rod = circle(center: fixed((0, -25)), radius: 5) }
    drawing mark { stroke = line(start: fixed((0, 0)), end: fixed((5, 5))) }
}
"""


@pytest.fixture
def box(folder: Path) -> str:
    (folder / "box.aidl").write_text(BOX)
    return "box.aidl"


def test_far_bodies_are_compared_too(aidl: Aidl) -> None:
    """More discs than the drawing compares pair by pair."""
    row = "assembly row { for i in 0..29 { @detached solid d[i] at (30 * i, 0) { c = circle(radius: 10) } } }"
    document = json.loads(aidl("measure", "-", "--json", stdin=row).out)
    assert document["all_pairs"]
    gaps = {(p["a"], p["b"]): p["gap"] for p in document["pairs"]}
    names = [f"row.d[{i}]" for i in range(30)]
    assert gaps == pytest.approx(
        {(names[i], names[k]): 30 * (k - i) - 20 for i, k in combinations(range(30), 2)}
    )


def test_json(aidl: Aidl, box: str) -> None:
    document = json.loads(aidl("measure", box, "--json").out)
    assert list(document) == ["units", "whole", "parts", "pairs", "all_pairs", "alone", "diagnostics"]
    floor, lid, pin = document["parts"]
    cap = 16 * math.pi / 2  # half of the boss stands out of the board
    area = 100 * 40 - 25 * math.pi + cap + 10 * 3
    assert floor["area"] == pytest.approx(area, rel=1e-11)
    assert (floor["kind"], floor["bodies"], floor["pieces"], floor["holes"]) == ("body", 1, 1, 1)
    assert floor["box"] == {"left": -54, "right": 50, "top": 23, "bottom": -20}
    assert (floor["width"], floor["height"]) == (104, 43)
    assert floor["volume"] == pytest.approx(6 * area)
    assert floor["mass"] == pytest.approx(6 * area * 0.68e-3)
    assert floor["wall"]["length"] == pytest.approx(8)  # the boss, from side to side
    assert floor["gap"] == {
        "length": 10,
        "from": pytest.approx(floor["gap"]["from"]),
        "to": pytest.approx(floor["gap"]["to"]),
        "part": "box.floor",
    }
    assert lid["inertia"] == {
        "xx": pytest.approx(100 * 20**3 / 12),
        "yy": pytest.approx(20 * 100**3 / 12),
        "xy": pytest.approx(0, abs=1e-6),
        "polar": pytest.approx(100 * 20 * (100**2 + 20**2) / 12),
        "principal": pytest.approx([20 * 100**3 / 12, 100 * 20**3 / 12]),
        "angle": 90,
    }
    assert (pin["material"], pin["density"], pin["thickness"]) == ("aluminum", 2700, 2)
    whole = document["whole"]
    assert (whole["path"], whole["kind"], whole["bodies"]) == ("box", "bodies", 3)
    assert whole["mass"] == pytest.approx(sum(p["mass"] for p in document["parts"]))
    assert whole["area"] == pytest.approx(sum(p["area"] for p in document["parts"]))
    assert whole["wall"]["part"] == "box.floor"
    assert [pair["relation"] for pair in document["pairs"]] == ["touching", "apart", "apart"]
    assert document["pairs"][1]["gap"] == 27
    assert (document["all_pairs"], document["alone"]) == (True, ["box.lid"])
    assert [d["code"] for d in document["diagnostics"]] == ["W0705"]


def test_paths_name_structures_holes_and_outlines(aidl: Aidl, box: str) -> None:
    paths = ("floor", "box.floor.drain", "floor.rib", "floor.boss", "LID")
    parts = json.loads(aidl("measure", box, *paths, "--json").out)["parts"]
    assert [(p["path"], p["kind"]) for p in parts] == [
        ("box.floor", "body"),
        ("box.floor.drain", "hole"),
        ("box.floor.rib", "solid"),
        ("box.floor.boss", "geometry"),
        ("box.lid", "body"),
    ]
    assert [p["area"] for p in parts[1:4]] == pytest.approx([25 * math.pi, 40, 16 * math.pi])
    assert [p["mass"] for p in parts[1:4]] == [None, None, None]


def test_a_wrong_program_ends_as_with_compile(aidl: Aidl) -> None:
    for name in ("wrong.aidl", "unsolvable.aidl"):
        result = aidl("measure", name)
        assert (result.code, result.out) == (1, "")
        assert "error[" in result.err


def test_forty_bodies(aidl: Aidl) -> None:
    program = (
        "assembly a { for i in 0..39 { @detached solid s[i] { c = circle(center: fixed((30 * i, 0)), "
        "radius: 5 + i / 10) } } }"
    )
    lines = aidl("measure", "-", stdin=program).out.splitlines()
    table = lines[lines.index("") + 1 :]
    assert len(table) == 1 + 40 + 1 + 20 + 2
    assert table[-2] == "and 760 more pairs, 16.3 mm apart or further"
    assert table[-1].endswith(" and 34 more")
    many = aidl("measure", "-", stdin=program.replace("0..39", "0..100")).out.splitlines()
    assert many[-2] == "pairs that are far from each other are not listed"


def test_odd_names_do_not_reach_the_terminal(aidl: Aidl, folder: Path) -> None:
    (folder / "s.aidl").write_text(
        '@thickness(2mm) @material("oak\x1b[31m </svg>")\nsolid s { c = circle(center: origin, radius: 1) }\n'
    )
    result = aidl("measure", "s.aidl")
    assert "\x1b" not in result.out + result.err


def test_from_python() -> None:
    model = aidl_lang.compile(BOX)
    whole, pin = model.measure(), model.measure("pin")
    assert (whole.path, whole.bodies) == ("box", 3)
    assert pin.mass == pytest.approx(25 * math.pi * 2 * 2.7e-3)
    assert model.measure("lid", densities={"birch plywood": 700}).mass == pytest.approx(100 * 20 * 6 * 0.7e-3)
    with pytest.raises(KeyError):
        model.measure("nothing")
    with pytest.raises(ValueError, match="wrong"):
        aidl_lang.compile("solid s { c = circel(radius: 1) }").measure()


# --- Materials -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        *(("6 mm birch plywood", 680), ("Birch-Plywood", 680), ("plywood, 4mm", 600)),
        *(("Stainless Steel 304", 7930), ("mild_steel", 7850), ("Aluminum 6061-T6", 2700)),
        *(("PLEXIGLASS", 1190), ("polystyrene foam", 30), ("pineapple", None), ("", None)),
    ],
)
def test_the_longest_name_in_the_text_counts(text: str, expected: float | None) -> None:
    assert density(text) == expected


def test_own_densities_come_first() -> None:
    assert density("Dry Oak", {"oak": 700}) == 700
    assert density("ash", {"oak": 700}) == density("ash")


def test_the_table_is_plausible() -> None:
    assert len(densities()) > 100
    assert all(name == name.casefold().strip() for name in densities())
    assert all(10 < value < 20_000 for value in densities().values())
    assert similar("alumnium sheet")[0] == "aluminium"


LEGS = """\
@material("oak") @thickness(18mm)
assembly table {
    @quantity(4) solid leg { bar = rectangle(center: origin, width: 50, height: 400) }
    solid top { bar = rectangle(center: (0, 210), width: 500, height: 20) }
}
"""


def test_all_pieces_of_a_part_weigh() -> None:
    whole, leg = (aidl_lang.compile(LEGS).measure(*path) for path in ([], ["leg"]))
    assert (whole.mass, leg.mass, leg.quantity) == (pytest.approx(1166.4), pytest.approx(259.2), 4)


@pytest.mark.usefixtures("at_once")
def test_a_variant_weighs_with_all_its_pieces() -> None:
    one = '@quantity(3) @material("oak") @thickness(10mm) solid s { param w = 20 in 10..30; '
    one += "r = rectangle(center: origin, width: w, height: 10) }"
    (variant,) = aidl_lang.sweep(one, {"w": [20]}, jobs=1)
    assert variant.measures["mass"] == pytest.approx(3 * 20 * 10 * 10 * 0.72e-3)
