"""Fasteners seen from the side: areas, widths and counts by the formulas of the standards, for every size."""

from __future__ import annotations

import math
from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Polygon

from aidl_lang import Model
from tests.amount import tries
from tests.compiled import model

#        d, pitch, flats, hex head, nut, washer d, thickness, cap d, sunk d, pan d, height, crown
TABLE = {
    "m2": (2, 0.4, 4, 1.4, 1.6, 5, 0.3, 3.8, 4.4, 4, 1.6, 3.2),
    "m2.5": (2.5, 0.45, 5, 1.7, 2, 6, 0.5, 4.5, 5.5, 5, 2.1, 4),
    "m3": (3, 0.5, 5.5, 2, 2.4, 7, 0.5, 5.5, 6.72, 5.6, 2.4, 5),
    "m4": (4, 0.7, 7, 2.8, 3.2, 9, 0.8, 7, 8.96, 8, 3.1, 6.5),
    "m5": (5, 0.8, 8, 3.5, 4.7, 10, 1, 8.5, 11.2, 9.5, 3.7, 8),
    "m6": (6, 1, 10, 4, 5.2, 12, 1.6, 10, 13.44, 12, 4.6, 10),
    "m8": (8, 1.25, 13, 5.3, 6.8, 16, 1.6, 13, 17.92, 16, 6, 13),
    "m10": (10, 1.5, 16, 6.4, 8.4, 20, 2, 16, 22.4, 20, 7.5, 16),
    "m12": (12, 1.75, 18, 7.5, 10.8, 24, 2.5, 18, 26.88, None, None, None),
}
HEADS = ("hex", "socket", "pan", "countersunk")

sizes = st.sampled_from(sorted(TABLE))
lengths = st.integers(12, 250)


def built(**calls: str) -> Model:
    """Returns an assembly of parts, each of which has its origin at (3, 4)."""
    parts = "; ".join(f"{name} = {call} at fixed((3, 4))" for name, call in calls.items())
    found = model(f"@detached assembly a {{ {parts} }}")
    assert found.ok
    assert found.diagnostics == []
    return found


def measured(made: Model, part: str) -> tuple[float, tuple[float, float, float, float], dict[str, int]]:
    """Area, box about the origin of the part, and how many strokes there are of each name."""
    drawing = made._compiled.drawing
    measures = drawing.measures[f"a.{part}"]
    left, bottom, right, top = measures.box
    own = [s.geometry for s in drawing.strokes if s.geometry.startswith(f"a.{part}.")]
    counts = Counter(name.rpartition(".")[2].partition("[")[0] for name in own)
    return measures.area, (left - 3, bottom - 4, right - 3, top - 4), counts


def drop_of(flats: float) -> float:
    """How much lower the corners of a hexagon are than its top, chamfered at 30 degrees."""
    return (flats / math.sqrt(3) - flats / 2) / math.sqrt(3)


def head_of(size: str, head: str) -> tuple[float, float, float, float]:
    """Width, height above the seat, depth below it, and area of a head."""
    d, _, flats, k, _, _, _, cap, sunk, pan, pan_height, crown = TABLE[size]
    if head == "hex":
        corners = 2 / math.sqrt(3) * flats
        return corners, k, 0, corners * k - (corners - flats) / 2 * drop_of(flats)
    if head == "socket":
        return cap, d, 0, cap * d - (d / 10) ** 2
    if head == "countersunk":
        depth = (sunk - d) / 2
        return sunk, 0, depth, (sunk + d) / 2 * depth
    half_angle = math.asin(pan / 2 / crown)
    side = pan_height - crown * (1 - math.cos(half_angle))
    return pan, pan_height, 0, pan * side + crown**2 * (half_angle - math.sin(2 * half_angle) / 2)


def thread_of(size: str, head: str, length: float) -> float:
    """The length b of the thread in ISO 4014, 4762, 10642 and 7045."""
    d = TABLE[size][0]
    if head == "hex":
        return 2 * d + (6 if length <= 125 else 12 if length <= 200 else 25)
    return (25 if d <= 3 else 38) if head == "pan" else 2 * d + 12


@tries(40)
@given(sizes, st.sampled_from(HEADS), lengths, st.sampled_from(["lines", "teeth", "none"]))
def test_a_bolt_is_as_its_standard_says(size: str, head: str, length: int, thread: str) -> None:
    if size == "m12" and head == "pan":
        return
    d, pitch = TABLE[size][:2]
    depth = 17 / 24 * math.cos(math.radians(30)) * pitch
    width, height, sunk, head_area = head_of(size, head)
    area, box, counts = measured(
        built(part=f'bolt("{size}", {length}, head: {head}, thread: {thread})'), "part"
    )
    assert box == pytest.approx((-width / 2, -length, width / 2, height), abs=1e-6)
    begin = max(sunk + pitch / 2, length - thread_of(size, head, length))
    turns = 0 if thread == "none" else math.floor((length - depth - begin) / pitch + 1e-9)
    assert counts.get("turn", 0) == turns
    # A groove between two crests is a triangle; there are as many on the right, and one less on the left.
    grooves = (2 * turns - 1) * pitch * depth / 2 if thread == "teeth" else 0
    assert area == pytest.approx(head_area + d * (length - sunk) - depth**2 - grooves, rel=1e-6)


def test_nuts_and_washers_are_as_their_standards_say() -> None:
    every = {f"{kind}{n}": f'{kind}("{size}")' for n, size in enumerate(TABLE) for kind in ("nut", "washer")}
    made = built(**every)
    for n, (_, _, flats, _, nut, washer, thickness, *_) in enumerate(TABLE.values()):
        corners = 2 / math.sqrt(3) * flats
        area, box, counts = measured(made, f"nut{n}")
        assert box == pytest.approx((-corners / 2, 0, corners / 2, nut), abs=1e-6)
        assert area == pytest.approx(corners * nut - (corners - flats) * drop_of(flats), rel=1e-6)
        assert counts == {"faces": 1}
        area, box, _ = measured(made, f"washer{n}")
        assert box == pytest.approx((-washer / 2, 0, washer / 2, thickness), abs=1e-6)
        assert area == pytest.approx(washer * thickness, rel=1e-6)


@tries(30)
@given(st.floats(1.5, 12), st.floats(3.5, 20))
def test_a_wood_screw_is_pointed(diameter: float, slenderness: float) -> None:
    length = diameter * slenderness
    made = built(part=f"wood_screw({diameter!r}, {length!r})")
    area, box, _ = measured(made, "part")
    assert box == pytest.approx((-diameter, -length, diameter, 0), rel=1e-6, abs=1e-6)
    region = made._compiled.drawing.regions["a.part"]
    (face,) = region.faces
    outline = Polygon([piece.start for piece in face.outer.pieces])
    assert outline.is_valid
    assert outline.area == pytest.approx(area, rel=1e-6)
    r = diameter / 2
    thread = 0.6 * length
    most = 3 * r * r + diameter * (length - r) - diameter / 2 * 1.8 * diameter
    assert most - 0.3 * diameter * thread < area < most + 0.01 * diameter**2
    (point,) = (x for x, y in outline.exterior.coords[:-1] if y == pytest.approx(4 - length))
    assert point == pytest.approx(3)


@pytest.mark.parametrize(
    ("call", "same"),
    [
        ('cap_screw("m5", 25)', 'bolt("m5", 25, head: socket)'),
        ('machine_screw("m4", 16)', 'bolt("m4", 16, head: pan)'),
        ('machine_screw("m4", 16, head: countersunk)', 'bolt("m4", 16, head: "countersunk")'),
        ("bolt(2.5, 12)", 'bolt("M2.5", 12)'),
        ("bolt(m6, 12)", 'bolt("m6", length: 12)'),
        ("nut(8mm)", 'nut("m8")'),
        ('bolt("m6", 12, thread_length: 1000)', 'bolt("m6", 12)'),
    ],
)
def test_names_of_the_same(call: str, same: str) -> None:
    (area, box, counts), (other, others_box, others) = (
        measured(built(part=each), "part") for each in (call, same)
    )
    assert area == pytest.approx(other)
    assert box == pytest.approx(others_box)
    assert counts == others


def test_its_points_place_it() -> None:
    """In a solid, mirrored, turned, along a line, and with its length found by constraints."""
    found = model("""
assembly hinge {
    var reach = 20
    solid leaf at fixed((0, 0)) { body = rectangle(center: fixed((0, 0)), width: 80, height: 10) }
    pin = bolt("m6", reach)
    solid pins { part = bolt("m6", 27) }
    other = mirror(pins, about: y_axis)
    level = cap_screw("m4", 20) at (0, 60) rotated 90deg
    construction way = line(fixed((-20, 40)), fixed((20, 40)))
    row = along(nut("m5"), way, n: 3)
    constrain {
        pins.part.seat == leaf.body.top_right - (10, 0)
        pin.seat == leaf.body.top_center
        pin.tip.y == leaf.body.bottom - 17
        level.tip == (20, 80)
    }
}""")
    assert {d.code for d in found.diagnostics} <= {"W0705"}
    points = {
        "hinge.pin.tip": (0, -22),
        "hinge.pins.part.tip": (30, -22),
        "hinge.other.part.tip": (-30, -22),
        "hinge.pins.part.crown": (30, 9),
        "hinge.level.part.seat": (0, 80),
        "hinge.row[0].crown": (-20, 44.7),
        "hinge.row[2].seat": (20, 40),
    }
    solved = found._compiled.model
    every = {g.path: g.values.get("at") for s in solved.root.walk() for g in s.geometry}
    assert set(points) <= set(every), sorted(every)
    for path, place in points.items():
        assert every[path] == pytest.approx(place, abs=1e-6), path
