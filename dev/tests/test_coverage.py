"""The table of what goes with what: no cell is a fault, and the page shows the present."""

from __future__ import annotations

import pytest

from aidl_dev.reference import coverage
from tests.amount import TRIES_ALL
from tests.documents import ROOT

PAGE = ROOT / "docs" / "reference" / "coverage.md"
ALL = coverage.constraints()
SAMPLE = ["tangent", "above"]
"""Those that every run checks, a constraint and a relation; with `AIDL_EXAMPLES` all are."""
CHOSEN = ALL if TRIES_ALL else SAMPLE


@pytest.mark.parametrize("name", CHOSEN)
def test_every_pair_works_or_is_refused(name: str) -> None:
    cells = list(coverage.cells(name))
    assert [(c.form, c.first, c.second, c.outcome) for c in cells if c.is_fault] == []
    assert any(c.outcome == "works" for c in cells)
    refused = [c for c in cells if c.outcome == "refused"]
    assert all(c.message.startswith("E0") and len(c.message) > 20 for c in refused)
    assert [c.message for c in refused if "things[" in c.message or "nested more" in c.message] == []
    assert coverage.table(name, cells) in PAGE.read_text("utf-8")


def test_a_cell_without_effect_is_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    """A form that mentions its second thing only in passing is caught."""
    monkeypatch.setitem(coverage.FORMS, "concentric", ("{name}(a, a) and b.center.x >= -1000",))
    kinds = {"circle": coverage.KINDS["circle"], "point": coverage.KINDS["point"]}
    monkeypatch.setattr(coverage, "KINDS", kinds)
    assert {c.outcome for c in coverage.cells("concentric")} == {"works"}
    monkeypatch.setitem(coverage.FORMS, "concentric", ("{name}(a, a, fixed((len([b]), 2)))",))
    assert {c.outcome for c in coverage.cells("concentric")} == {"without effect on b"}
