"""The gallery: within a hundred lines, canonical, and without a message whatever a knob is turned to."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import aidl_lang
from aidl_lang.building.model import Knob
from tests.amount import some
from tests.compiled import lighter, model
from tests.documents import ROOT

PROGRAMS = sorted((ROOT / "examples/gallery").glob("*.aidl"))
DEAR = {path.stem for path in PROGRAMS} - {"chess_rook"}
"""Programs whose ends are slow to try; all are drawn on every run."""
MOST_LINES = 100
TURN = 0.25

Value = float | str | bool


def ends(knob: Knob) -> list[Value]:
    return list(knob.choices) or [v for v in (knob.low, knob.high) if v is not None]


def turned(knob: Knob) -> Iterator[float]:
    """A quarter less and more, as far as the range goes and on its steps."""
    if knob.low is None or knob.high is None or isinstance(knob.value, str):
        return
    for factor in (1 - TURN, 1 + TURN):
        value = min(max(knob.value * factor, knob.low), knob.high)
        step = knob.step
        yield value if step is None else knob.low + round((value - knob.low) / step) * step


def told(path: Path, settings: dict[str, Value]) -> list[str]:
    made = aidl_lang.compile(path.read_text("utf-8"), params=settings)
    return [f"{settings}: {d.code} {d.message}" for d in made.diagnostics]


def test_the_gallery_has_what_its_page_says() -> None:
    assert len(PROGRAMS) == 18
    readme = (ROOT / "README.md").read_text("utf-8")
    assert [path.stem for path in PROGRAMS if f"docs/images/gallery/{path.stem}.svg" not in readme] == []


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_a_program_is_short_and_canonical(path: Path) -> None:
    text = path.read_text("utf-8")
    assert len(text.splitlines()) <= MOST_LINES
    assert aidl_lang.format(text) == text


@pytest.mark.parametrize("path", lighter(PROGRAMS, DEAR))
def test_a_program_is_without_fault_at_the_ends_of_its_knobs(path: Path) -> None:
    made = model(path.read_text("utf-8"))
    assert [d.message for d in made.diagnostics] == []
    assert len(made.params) >= 3
    turned_to = [{knob.path: value} for knob in made.params.values() for value in ends(knob)]
    assert [each for settings in some(turned_to, 2) for each in told(path, settings)] == []


@pytest.mark.slow
@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_a_program_is_without_fault_a_quarter_further(path: Path) -> None:
    knobs = model(path.read_text("utf-8")).params.values()
    faults = [each for knob in knobs for value in turned(knob) for each in told(path, {knob.path: value})]
    assert faults == []
