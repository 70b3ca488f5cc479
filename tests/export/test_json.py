"""The JSON document: its schema, its numbers, its bytes."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import shapely
import shapely.affinity
import shapely.geometry

import aidl_lang
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.export.job import Job, Options
from aidl_lang.export.json import to_json
from aidl_lang.geometry.curves import Bezier, Ellipse, Line
from aidl_lang.geometry.drawing import draw
from aidl_lang.geometry.solved import Box, Change, ConstraintReport, Mobility, SolvedModel
from tests.compiled import LIGHTER
from tests.compiled import model as model_of
from tests.geometry.models import arc, circle, model, primitive, rectangle, structure

SCHEMA = json.loads((Path(__file__).parents[2] / "docs" / "model.schema.json").read_text(encoding="utf-8"))
SOURCE = SourceFile("x.aidl", "assembly a {\n    b.above(c)\n}\n")
SPAN = Span(SOURCE, 17, 27)


def everything() -> SolvedModel:
    root = structure(
        "assembly",
        "a",
        structure(
            "solid",
            "b",
            rectangle("r", 0, 0, 10, 10),
            primitive("axis", Line((0, 0), (1 / 3, 0)), construction=True),
            structure("hole", "h[0]", circle("c", 5, 5, 2)),
            color=("red",),
        ),
        structure("solid", "c", primitive("e", Ellipse((20, 0), 3, 2, 0.1)), detached=()),
        structure(
            "drawing",
            "d",
            primitive("z", Bezier((0, 0), (1, 1), (2, 1), (3, 0))),
            primitive("y", arc((0, 0), 1, 0, 90)),
        ),
        structure("solid", "plan", box=Box(0, 0, 10, 10)),
    )
    constraint = ConstraintReport("a", "b.above(c)", SPAN, -0.0, True, lambda: ("a.b", "a.c"))
    soft = replace(constraint, soft=True, residual=float("nan"), satisfied=False)
    changed = (Change("a.b.r.width", 9.0, 10.0, None),)
    mobility = Mobility(1, ("a.c.e.rx",))
    return replace(model(root), constraints=(constraint, soft), changed=changed, mobility=lambda: mobility)


def test_the_document_follows_its_schema():
    m = everything()
    drawing, found = draw(m)
    place = Diagnostic(
        "E0101", "wrong", SPAN, "here", (Label(SPAN, "there"),), ("do",), Fix("mend", (Edit(SPAN, "x"),))
    )
    options = Options(timings={"solve": 0.25})
    document = json.loads(to_json(Job(m, drawing, lambda: [*found.everything(), place], options)).data)
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    jsonschema.validate(document, SCHEMA)
    assert document["timings"] == {"solve": 0.25}
    assert [c["residual"] for c in document["constraints"]] == [0.0, None]
    assert document["root"]["structures"][0]["geometry"]["axis"]["end"] == [0.333333333333, 0.0]
    (pair,) = document["pairs"]
    assert pair == {"a": "a.b", "b": "a.c", "relation": "apart", "gap": pair["gap"]}


def test_readings_of_ambiguous_calls_are_told():
    program = """drawing d {
        a = circle(center: (0, 0), radius: 5)
        b = circle(center: (9, 0), radius: 3)
        constrain tangent(b, a)
    }"""
    (reading,) = json.loads(aidl_lang.compile(program).to_json())["readings"]
    assert reading == {"text": "tangent(b, a)", "line": 4, "column": 19, "reading": "taken as 8 (1 of 3)"}


def regions(program: str) -> tuple[dict[str, Any], float]:
    document = json.loads(model_of(program).to_json())
    jsonschema.validate(document, SCHEMA)
    return document["regions"], document["tolerance"]


PLATE = """solid plate {
    body = slot(center: origin, length: 60, width: 20)
    hole bore { rim = circle(center: fixed((20, 0)), radius: 4) }
    hole eye { rim = ellipse(center: fixed((-15, 0)), rx: 6, ry: 3, angle: 30deg) }
}"""


def test_the_exact_outlines_of_a_region():
    found, _ = regions(PLATE)
    (face,) = found["plate"]["faces"]
    outer = face["outer"]
    assert sorted(piece["type"] for piece in outer) == ["arc", "arc", "line", "line"]
    for piece, after in zip(outer, outer[1:] + outer[:1], strict=True):
        assert piece["end"] == after["start"]
    assert all(p["radius"] == 10 and p["clockwise"] is False for p in outer if p["type"] == "arc")
    assert {"type": "circle", "center": [20.0, 0.0], "radius": 4.0} in [h[0] for h in face["holes"]]
    (eye,) = (h[0] for h in face["holes"] if h[0]["type"] == "ellipse")
    assert eye == {"type": "ellipse", "center": [-15.0, 0.0], "rx": 6.0, "ry": 3.0, "angle": 30.0}
    area = 40 * 20 + math.pi * (100 - 16 - 18)
    assert found["plate"]["area"] == pytest.approx(area, rel=1e-11)
    assert found["plate"]["centroid"][0] == pytest.approx(math.pi * (15 * 18 - 20 * 16) / area, rel=1e-9)


def test_shapely_reads_the_polygons():
    found, tolerance = regions(PLATE)
    assert tolerance == 0.06
    polygons = shapely.geometry.shape(found["plate"]["geometry"])
    assert polygons.is_valid
    (polygon,) = polygons.geoms
    assert polygon.exterior.is_ccw
    assert [hole.is_ccw for hole in polygon.interiors] == [False, False]
    exact = shapely.LineString([(-20, 0), (20, 0)]).buffer(10, quad_segs=2000)
    exact -= shapely.Point(20, 0).buffer(4, quad_segs=2000)
    eye = shapely.affinity.scale(shapely.Point(0, 0).buffer(1, quad_segs=2000), 6, 3)
    exact -= shapely.affinity.translate(shapely.affinity.rotate(eye, 30, origin=(0, 0)), -15, 0)
    assert shapely.hausdorff_distance(polygons, exact) <= tolerance


@pytest.mark.parametrize("path", LIGHTER)
def test_polygons_of_the_examples_have_the_areas_of_the_regions(path: Path):
    found, tolerance = regions(path.read_text("utf-8"))
    for region in found.values():
        polygons = shapely.geometry.shape(region["geometry"])
        assert polygons.is_valid
        rings = [ring for p in polygons.geoms for ring in (p.exterior, *p.interiors)]
        assert len(rings) == region["loops"]
        assert all(p.exterior.is_ccw and not any(h.is_ccw for h in p.interiors) for p in polygons.geoms)
        assert polygons.area == pytest.approx(region["area"], abs=tolerance * region["perimeter"])
        box, bounds = region["bb"], polygons.bounds
        sides = (box["left"], box["bottom"], box["right"], box["top"])
        assert bounds == pytest.approx(sides, abs=tolerance)
