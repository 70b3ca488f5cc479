"""Finished corners and outlines made of others, in JSON and SVG."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile

SCHEMA = json.loads((Path(__file__).parents[2] / "docs" / "model.schema.json").read_text(encoding="utf-8"))

PROGRAM = """
solid plate {
    body = rectangle(center: fixed((0, 0)), width: 60, height: 40)
    fillet(body.top_left, 10)
    chamfer(body.bottom_right, 6, 3)
    bite = ellipse(center: fixed((30, 20)), rx: 12, ry: 6)
    rest = cut(body, bite)
}
"""


def exported(suffix: str) -> str:
    compiled = pipeline.compile(SourceFile("plate.aidl", PROGRAM))
    assert compiled.ok, compiled.diagnostics
    return compiled.export(suffix).decode()


def test_the_document_lists_finishes_and_keeps_the_edges_sharp() -> None:
    document = json.loads(exported(".json"))
    jsonschema.validate(document, SCHEMA)
    root = document["root"]
    assert root["finishes"] == [
        {"kind": "fillet", "at": [-30.0, 20.0], "radius": 10.0},
        {"kind": "chamfer", "at": [30.0, -20.0], "size": 6.0, "second": 3.0},
    ]
    assert root["geometry"]["body"]["parts"]["top"]["end"] == [-30.0, 20.0]


def test_derived_outlines_have_their_exact_curves_as_parts() -> None:
    rest = json.loads(exported(".json"))["root"]["geometry"]["rest"]
    kinds = sorted(part["type"] for part in rest["parts"].values())
    assert (rest["type"], kinds) == ("difference", ["arc", "ellipse_arc", *["line"] * 5])


def test_arcs_stay_arcs_in_pictures() -> None:
    path = exported(".svg")
    assert "A10 10" in path.replace(",", " ")
    assert "A12 6" in path.replace(",", " ")
