"""The linkage of the workshop: it closes at every angle, its parts fit, and every file has them apart."""

from __future__ import annotations

import io
import math
from collections import Counter
from functools import cache
from pathlib import Path

import ezdxf
import numpy as np
import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.compiled import Compiled
from aidl_lang.export.job import Options
from tests.export.readers import read_meshes, united

FILE = Path(__file__).parents[1] / "examples" / "workshop" / "linkage.aidl"
CRANK, COUPLER, ROCKER, BASE = 40.0, 110.0, 80.0, 100.0
PLY = 3.0


@cache
def linkage(turn: float = 60.0, **params: float) -> Compiled:
    return pipeline.compile(SourceFile(FILE.name, FILE.read_text("utf-8")), params={"turn": turn, **params})


def joint(made: Compiled, path: str) -> np.ndarray:
    assert made.model is not None
    found = next(g for s in made.model.root.walk() for g in s.geometry if g.path == f"linkage.{path}")
    return np.array(found.values["center"])


def rocker_end(turn: float) -> np.ndarray:
    """Where two circles meet, above the base: as a school book has it."""
    a = CRANK * np.array([math.cos(math.radians(turn)), math.sin(math.radians(turn))])
    b = np.array([BASE, 0.0])
    d = np.linalg.norm(b - a)
    along = (COUPLER**2 - ROCKER**2 + d**2) / (2 * d)
    up = math.sqrt(COUPLER**2 - along**2)
    way = (b - a) / d
    return a + along * way + up * np.array([-way[1], way[0]])


@pytest.mark.parametrize("turn", [0, 60, 150, 250])
def test_it_closes_at_every_angle(turn: float) -> None:
    made = linkage(turn)
    assert made.ok
    assert made.diagnostics == []
    assert made.model is not None
    assert made.model.degrees == 0
    assert joint(made, "coupler.far.rim") == pytest.approx(rocker_end(turn), abs=1e-6)
    for a, b in (("crank.far.rim", "coupler.near.rim"), ("rocker.far.rim", "rocker_pin.rod")):
        assert joint(made, a) == pytest.approx(joint(made, b), abs=1e-6)


def test_each_layer_has_whole_parts() -> None:
    document = ezdxf.read(io.StringIO(linkage().export(".dxf").decode()))
    found = Counter((e.dxf.layer, e.dxftype()) for e in document.modelspace())
    assert found == {
        ("base", "LWPOLYLINE"): 1,
        ("base", "CIRCLE"): 2,
        ("crank and rocker", "LWPOLYLINE"): 2,
        ("crank and rocker", "CIRCLE"): 4,
        ("coupler", "LWPOLYLINE"): 1,
        ("coupler", "CIRCLE"): 2,
        ("pins", "CIRCLE"): 4,
    }
    radii = {(e.dxf.layer, round(e.dxf.radius, 6)) for e in document.modelspace().query("CIRCLE")}
    assert radii == {("base", 3.1), ("crank and rocker", 3.1), ("coupler", 3.1), ("pins", 3.0)}


def test_the_sheets_have_every_part_once() -> None:
    made = linkage().exported(".dxf", Options(sheet=(300.0, 200.0)))
    counts: Counter[str] = Counter()
    for data in (made.data, *made.further):
        document = ezdxf.read(io.StringIO(data.decode()))
        counts.update(e.dxf.layer for e in document.modelspace())
    assert counts == {"pins": 4, "base": 3, "coupler": 3, "crank and rocker": 6}


def test_no_two_bodies_fill_the_same_place() -> None:
    bodies = read_meshes(linkage().export(".stl"), ".stl")
    assert len(bodies) == 8
    heights = {name.removeprefix("linkage."): body.bounds[:, 2].tolist() for name, body in bodies.items()}
    assert heights["base"] == pytest.approx([0, PLY])
    assert heights["crank"] == heights["rocker"] == pytest.approx([PLY, 2 * PLY])
    assert heights["coupler"] == pytest.approx([2 * PLY, 3 * PLY])
    assert heights["crank_pivot"] == pytest.approx([0, 2 * PLY])
    assert heights["rocker_pin"] == pytest.approx([PLY, 3 * PLY])
    assert all(body.is_watertight for body in bodies.values())
    volume = sum(body.volume for body in bodies.values())
    assert united(bodies.values()).volume == pytest.approx(volume, rel=1e-6)
