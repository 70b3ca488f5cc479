"""Dimensions as they are drawn: nothing covers a value, ends are as far apart as it says, all can be read."""

from __future__ import annotations

import math
from xml.etree import ElementTree

import pytest
import shapely

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.export.job import Options
from aidl_lang.export.marks import Area, Curves, Group, Picture, Text
from aidl_lang.export.picture import picture
from aidl_lang.geometry.curves import Arc, Line
from tests.compiled import EXAMPLES, compiled

CAPITAL, DIGIT = 0.73, 0.64
"""Height and width of the digits of DejaVu Sans, relative to the size of the font."""

PLATE = """
solid plate {
    param width = 120mm
    body = rectangle(center: origin, width: width, height: 70)
    for i in 0..3 { hole bolt[i] { rim = circle(center: fixed((30 * i - 45, 20)), diameter: 6) } }
    hole eye { rim = circle(center: (0, -10), radius: 8) }
    fillet(body, 5)
    constrain eye.rim.center == body.bottom_left + (40, 25)
}
"""
TURNED = """
assembly kit {
    @detached
    solid plate at (10, 5) rotated 30deg {
        body = rectangle(center: origin, width: 40, height: 20)
        hole eye { rim = circle(center: (5, 2), radius: 3) }
        constrain eye.rim.center == body.bottom_left + (8, 6)
    }
    drawing marks {
        base = line(fixed((60, 0)), fixed((100, 0)))
        arm = line(base.start, length: 30, angle: guess(50deg))
        bow = arc(center: (0, -40), radius: 15, start_angle: 0deg, end_angle: 100deg)
        constrain angle(arm, base) == 40deg
    }
}
"""
NARROW = """
solid comb {
    back = rectangle(center: origin, width: 100, height: 10)
    for i in 0..9 {
        slit[i] = rectangle(center: (10 * i - 45, -10), width: 0.5 + 0.1 * i, height: 12)
    }
    constrain { for i in 0..9 { slit[i].bb.left == back.bb.left + 2 + 10 * i } }
}
"""
PROGRAMS = {path.stem: path.read_text() for path in EXAMPLES}
PROGRAMS |= {"plate": PLATE, "turned": TURNED, "narrow": NARROW}


def drawn(text: str, **options: object) -> Picture:
    from aidl_lang.export.job import Job

    part = compiled(text)
    assert part.model is not None
    assert part.drawing is not None
    chosen = Options(dimension=True, **options)  # type: ignore[arg-type]
    return picture(Job(part.model, part.drawing, options=chosen))


def dimensions(p: Picture) -> list[Group]:
    return [g for g in p.groups if "data-value" in g.attributes]


def value_of(group: Group) -> Text:
    (text,) = [m for m in group.marks if isinstance(m, Text)]
    return text


def tips(group: Group) -> list[tuple[float, float]]:
    arrows = [m.face.outer.pieces[0] for m in group.marks if isinstance(m, Area)]
    return [piece.start for piece in arrows if isinstance(piece, Line)]


def text_area(text: Text) -> shapely.Polygon:
    """The place that digits take on the sheet."""
    half = DIGIT * text.size * len(text.text) / 2
    flat = shapely.box(-half, 0, half, CAPITAL * text.size)
    turned = shapely.affinity.rotate(flat, text.angle, origin=(0, 0))
    return shapely.affinity.translate(turned, *text.at)


def arrow_areas(group: Group) -> list[shapely.Polygon]:
    faces = [m.face.outer.pieces for m in group.marks if isinstance(m, Area)]
    return [shapely.Polygon([p.start for p in pieces if isinstance(p, Line)]) for pieces in faces]


def lines_of(group: Group, role: str) -> list[shapely.LineString]:
    pieces = [p for m in group.marks if isinstance(m, Curves) and m.role == role for p in m.pieces]
    return [shapely.LineString([p.start, p.end]) for p in pieces if isinstance(p, Line)]


def check(p: Picture) -> None:
    """What holds of every sheet."""
    groups = dimensions(p)
    texts = [text_area(value_of(g)) for g in groups]
    arrows = [a for g in groups for a in arrow_areas(g)]
    lines = [line for g in groups for role in ("dimension", "extension") for line in lines_of(g, role)]
    tree = shapely.STRtree([*texts, *arrows, *lines])
    for index, text in enumerate(texts):
        for other in tree.query(text, "intersects"):
            shape = tree.geometries[other]
            assert other == index or text.intersection(shape).area + text.intersection(shape).length < 1e-9
        assert shapely.box(*p.box).contains(text)
    for group in groups:
        check_value(group)


def check_value(group: Group) -> None:
    kind, value = group.attributes["data-kind"], float(group.attributes["data-value"])
    text = value_of(group)
    assert -90 < text.angle <= 90
    said = text.text.partition("× ")[2] or text.text
    assert float(said.strip("⌀R°")) == pytest.approx(value, abs=0.0051, rel=0.051 if value < 0.1 else 1e-9)
    ends = tips(group)
    if kind in ("horizontal", "vertical", "aligned"):
        (x0, y0), (x1, y1) = ends
        assert math.dist(*ends) == pytest.approx(value, rel=1e-6)
        assert {"horizontal": y1 - y0, "vertical": x1 - x0}.get(kind, 0) == pytest.approx(0, abs=1e-9 * value)
        way = math.degrees(math.atan2(y1 - y0, x1 - x0))
        assert math.sin(math.radians(way - text.angle)) == pytest.approx(0, abs=1e-6)
    elif kind == "angle":
        (arc,) = [p for m in group.marks if isinstance(m, Curves) for p in m.pieces if isinstance(p, Arc)]
        a, b = (math.atan2(y - arc.center[1], x - arc.center[0]) for x, y in ends)
        assert math.degrees((b - a) % math.tau) == pytest.approx(value, abs=1e-6)
    else:
        assert len(ends) == 1


@pytest.mark.parametrize("name", PROGRAMS)
def test_values_can_be_read(name: str):
    p = drawn(PROGRAMS[name])
    assert len(dimensions(p)) >= 2
    assert "dimensions-left-out" not in [g.name for g in p.groups]
    check(p)


def test_programs_can_tell_what_is_dimensioned():
    svg = pipeline.compile(SourceFile("a.aidl", PLATE)).export(".svg", Options(dimension=True))
    groups = [g.attrib for g in ElementTree.fromstring(svg).iter() if g.get("class") == "dimension"]
    width = next(g for g in groups if g.get("data-param") == "width")
    assert width["data-of"] == "plate.body.width"
    assert (width["data-kind"], width["data-value"], width["data-origin"]) == ("horizontal", "120", "param")


def test_short_lengths_stand_nearer_than_long_ones():
    """No extension line crosses a dimension line."""
    text = """solid s {
        body = rectangle(center: origin, width: 60, height: 20)
        tab = rectangle(center: (0, -15), width: 20, height: 10)
        constrain { tab.top == body.bottom; tab.center_x == body.center_x }
    }"""
    groups = dimensions(drawn(text))
    assert sorted(g.attributes["data-value"] for g in groups) == ["10", "20", "20", "30", "60"]
    extensions = [e for g in groups for e in lines_of(g, "extension")]
    assert not any(line.crosses(e) for g in groups for line in lines_of(g, "dimension") for e in extensions)


# --- Hostile programs ------------------------------------------------------------------------------


def test_too_many_are_counted():
    rims = "\n".join(
        f"hole h{i} {{ rim = circle(center: fixed(({5 * i - 105}, 0)), radius: {1 + i / 100}) }}"
        for i in range(43)
    )
    p = drawn(f"solid s {{ body = rectangle(center: origin, width: 220, height: 60)\n{rims} }}")
    check(p)
    (note,) = [
        m.text for g in p.groups if g.name == "dimensions-left-out" for m in g.marks if isinstance(m, Text)
    ]
    assert note == f"{45 - len(dimensions(p))} more dimensions not shown"
    assert len(dimensions(p)) <= 40
    assert {"220", "60"} <= {value_of(g).text for g in dimensions(p)}
