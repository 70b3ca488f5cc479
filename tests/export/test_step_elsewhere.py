"""STEP files in other CAD systems: CadQuery and FreeCAD read the volumes that are measured. Left out where
they are missing: CadQuery is bound to another Open CASCADE, so `AIDL_CADQUERY` names a Python that has it.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

import aidl_lang
from tests.compiled import EXAMPLES

CADQUERY = os.environ.get("AIDL_CADQUERY")
FREECAD = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
THICKNESS = 3.0
BY_CADQUERY = """
import cadquery, json, sys
read = cadquery.importers.importStep(sys.argv[1])
cadquery.exporters.export(read, sys.argv[2])
print(json.dumps(sorted(solid.Volume() for solid in read.solids().vals())))
"""
BY_FREECAD = """
import Part, json, os
read = Part.read(os.environ["AIDL_STEP"])
read.exportStep(os.environ["AIDL_BACK"])
print("\\n" + json.dumps(sorted(solid.Volume for solid in read.Solids)))
"""
"""`Import.insert` would have the names too; the console of FreeCAD 0.20 breaks down at it, whoever wrote the
file.
"""


@pytest.fixture(params=["motor_bracket", "finger_box"])
def step(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[Path, list[float]]:
    """The file of an example, and the volumes that are measured of its bodies."""
    (path,) = (each for each in EXAMPLES if each.stem == request.param)
    model = aidl_lang.compile(path)
    model.save(tmp_path / "part.step", thickness=THICKNESS)
    drawing = model._compiled.drawing
    assert drawing is not None
    bodies = [model.measure(body.path) for body in drawing.bodies]
    return tmp_path / "part.step", sorted(body.area * (body.thickness or THICKNESS) for body in bodies)


def volumes(*command: str | Path, **more: str) -> list[float]:
    """What a script prints in its last line."""
    said = subprocess.run(
        command, env={**os.environ, **more}, capture_output=True, text=True, timeout=300, check=True
    )
    last = [line for line in said.stdout.splitlines() if line.startswith("[")][-1]
    return [float(volume) for volume in json.loads(last)]


@pytest.mark.skipif(CADQUERY is None, reason="AIDL_CADQUERY names no Python with CadQuery")
def test_cadquery_reads_the_volumes(step: tuple[Path, list[float]]) -> None:
    assert CADQUERY is not None
    path, measured = step
    back = path.with_name("back.step")
    assert volumes(CADQUERY, "-c", BY_CADQUERY, path, back) == pytest.approx(measured, rel=1e-9)
    assert volumes(CADQUERY, "-c", BY_CADQUERY, back, path) == pytest.approx(measured, rel=1e-9)


@pytest.mark.skipif(FREECAD is None, reason="there is no FreeCAD here")
def test_freecad_reads_the_volumes(step: tuple[Path, list[float]]) -> None:
    assert FREECAD is not None
    path, measured = step
    back, script = path.with_name("back.step"), path.with_name("read.py")
    script.write_text(BY_FREECAD)
    for source, target in ((path, back), (back, path)):
        found = volumes(FREECAD, script, AIDL_STEP=str(source), AIDL_BACK=str(target))
        assert found == pytest.approx(measured, rel=1e-9)
