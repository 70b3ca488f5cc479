"""The JSON document: its schema, its numbers, its bytes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import jsonschema
import pytest

import aidl_lang
from aidl_lang.diagnostics import Diagnostic, Edit, Fix, Label
from aidl_lang.export import Job, export
from aidl_lang.export.json import to_dict, to_json
from aidl_lang.export.numbers import fixed, significant
from aidl_lang.geometry.curves import Bezier, Ellipse, Line
from aidl_lang.geometry.drawing import draw
from aidl_lang.solved import Box, Change, ConstraintReport, SolvedModel
from aidl_lang.source import SourceFile, Span
from tests.geometry.models import arc, circle, compound, model, primitive, rectangle, structure

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
    constraint = ConstraintReport("a", "b.above(c)", SPAN, -0.0, True, ("a.b", "a.c"))
    soft = replace(constraint, soft=True, residual=float("nan"), satisfied=False)
    changed = (Change("a.b.r.width", 9.0, 10.0, None),)
    return replace(
        model(root), constraints=(constraint, soft), free=("a.c.e.rx",), changed=changed, degrees=1
    )


def test_the_document_follows_its_schema():
    m = everything()
    drawing, notes = draw(m)
    place = Diagnostic(
        "E0101", "wrong", SPAN, "here", (Label(SPAN, "there"),), ("do",), Fix("mend", (Edit(SPAN, "x"),))
    )
    document = json.loads(to_json(m, drawing, [*notes, place], {"solve": 0.25}))
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    jsonschema.validate(document, SCHEMA)
    assert document["timings"] == {"solve": 0.25}


def test_members():
    m = everything()
    document = to_dict(m, draw(m)[0])
    assert list(document)[:6] == ["aidl", "units", "status", "root", "constraints", "dof"]
    b = document["root"]["structures"][0]
    assert b["bb"] == {"left": 0.0, "right": 10.0, "top": 10.0, "bottom": 0.0}
    assert b["geometry"]["axis"]["end"] == [0.333333333333, 0.0]
    assert b["geometry"]["r"]["parts"]["edges[0]"] == {
        "type": "line",
        "start": [0.0, 0.0],
        "end": [10.0, 0.0],
    }
    assert document["regions"]["a.b"] == {"area": 87.4336293856, "perimeter": 52.5663706144, "loops": 2}
    assert document["pairs"] == [
        {"a": "a.b", "b": "a.c", "relation": "apart", "gap": significant(draw(m)[0].pairs[0].gap or 0)}
    ]
    assert document["constraints"][0] == {
        "path": "a", "text": "b.above(c)", "line": 2, "column": 5, "residual": 0.0, "satisfied": True,
    }  # fmt: skip
    assert document["constraints"][1]["residual"] is None
    assert "timings" not in document


def test_a_schema_that_means_something():
    m = everything()
    document = to_dict(m, draw(m)[0])
    document["root"]["structures"][0]["geometry"]["r"]["typo"] = 1
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(document, SCHEMA)


def test_lists_of_numbers_stay_in_one_line():
    m = everything()
    text = to_json(m, draw(m)[0])
    assert '"start": [0, 0],' in text
    assert json.loads(text) == to_dict(m, draw(m)[0])


def test_places_of_diagnostics():
    m = everything()
    note = Diagnostic("N0601", "so", SPAN)
    (entry,) = to_dict(m, draw(m)[0], [note])["diagnostics"]
    assert entry == {
        "code": "N0601", "severity": "note", "message": "so", "hints": [],
        "file": "x.aidl", "line": 2, "column": 5, "end_line": 2, "end_column": 15,
        "label": "", "secondary": [], "fix": None,
    }  # fmt: skip


def test_the_same_bytes_each_time():
    m = everything()
    for suffix in (".json", ".svg"):
        one, other = (export(Job(m, draw(m)[0]), suffix).data for _ in range(2))
        assert one == other
        assert b"-0.0," not in one


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-0.0, "0"),
        (-1e-9, "0"),
        (1.5, "1.5"),
        (100.0, "100"),
        (1 / 3, "0.333333"),
        (1e7, "10000000"),
    ],
)
def test_fixed_decimals(value: float, text: str):
    assert fixed(value) == text


def test_compound_shapes_nest():
    m = model(structure("solid", "s", compound("outer", Line((0, 0), (1, 0)), type_="path")))
    jsonschema.validate(to_dict(m, draw(m)[0]), SCHEMA)


def test_readings_of_ambiguous_calls_are_told():
    program = """drawing d {
        a = circle(center: (0, 0), radius: 5)
        b = circle(center: (9, 0), radius: 3)
        constrain tangent(b, a)
    }"""
    (reading,) = json.loads(aidl_lang.compile(program).to_json())["readings"]
    assert reading == {"text": "tangent(b, a)", "line": 4, "column": 19, "reading": "taken as 8 (1 of 3)"}
