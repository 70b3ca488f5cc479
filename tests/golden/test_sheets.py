"""What stands on drawing sheets: of the workshop's examples and of small parts, against `sheets.txt`.

A line is a program, or the name of one in the workshop; under it, for each of its sheets, stand the
dimensions and the cells of the table of holes. `make accept` writes down what comes. From what stands there
each part can be made: nothing is left out, and nothing is said twice. Look that this stays so.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld
from aidl_lang.export.drafting import Draft, drafted
from aidl_lang.export.job import Job
from aidl_lang.export.marks import Picture, Text
from tests.documents import ROOT

PAGE = Path(__file__).with_name("sheets.txt")
ACCEPT = bool(os.environ.get("AIDL_ACCEPT"))
WORKSHOP = ROOT / "examples" / "workshop"


def rows() -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for line in PAGE.read_text("utf-8").splitlines():
        if line.startswith("    "):
            found[next(reversed(found))].append(line.strip())
        else:
            found[line] = []
    return found


def values(page: Picture) -> Iterator[str]:
    """The texts of dimensions in order, then those of the table."""
    groups = [g for g in page.groups if g.attributes.get("class") == "dimension"]
    yield from sorted(m.text for g in groups for m in g.marks if isinstance(m, Text))
    yield from (m.text for g in page.groups if g.name == "holes" for m in g.marks if isinstance(m, Text))


def sheets(program: str) -> list[str]:
    file = WORKSHOP / program
    text = file.read_text("utf-8") if program.endswith(".aidl") else f"solid s {{ {program} }}"
    found = pipeline.compile(SourceFile("sheet.aidl", text), DiskWorld(WORKSHOP))
    assert found.model is not None
    assert found.drawing is not None
    return [", ".join(values(page)) for page in drafted(Job(found.model, found.drawing), Draft())]


DEAR = {"pi_case.aidl"}


@pytest.mark.parametrize(
    "program", [pytest.param(p, id=p[:60], marks=[pytest.mark.slow] if p in DEAR else []) for p in rows()]
)
def test_values_on_the_sheets(program: str) -> None:
    assert sheets(program) == rows()[program] or ACCEPT


def test_every_example_of_the_workshop_has_its_values() -> None:
    assert {path.name for path in WORKSHOP.glob("*.aidl")} <= rows().keys()


@pytest.mark.skipif(not ACCEPT, reason="writes only with AIDL_ACCEPT=1")
def test_accept() -> None:
    lines = [line for program in rows() for line in (program, *(f"    {s}" for s in sheets(program)))]
    PAGE.write_text("\n".join(lines) + "\n", "utf-8")
