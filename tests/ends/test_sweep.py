"""Programs at the ends of their params: what is said, and that it is so."""

from __future__ import annotations

import os
import threading
from dataclasses import replace

import pytest

from aidl_lang import pipeline
from aidl_lang.building.state import BuildingLimits
from aidl_lang.common.source import SourceFile
from aidl_lang.tools import ends
from aidl_lang.tools.ends import Sweep, SweepJob, Tried, sentence, sweep
from tests.sweep.here import at_once as at_once

PLATE = """\
solid plate {
    param width = 60mm in 40..120
    param soft = 3mm in 1..31
    param holes = 3 in 1..9
    body = rectangle(center: origin, width: width, height: 94)
    fillet(body, soft)
    hole cut { row = linear_array(circle(radius: 3), n: holes, pitch: 10) }
    constrain cut.left == body.left + 4
    assert width < 94, "taller than wide"
    assert cut.right < body.right
}
"""


def swept(text: str, **limits: object) -> Sweep:
    job = SweepJob("plate.aidl", text, None, replace(pipeline.Settings(), **limits))
    compiled = pipeline.compile(SourceFile("plate.aidl", text))
    assert compiled.ok, compiled.diagnostics
    return sweep(job, compiled.knobs, compiled.diagnostics)


@pytest.mark.usefixtures("at_once")
def test_limits_work_as_they_are_printed_and_the_next_values_do_not() -> None:
    source = SourceFile("plate.aidl", PLATE)
    limits = [each for each in swept(PLATE).turned if each.works is not None]
    assert len(limits) == 3
    for each in limits:
        works, beyond = f"{each.works:.12g}{each.knob.unit}", f"{each.beyond[0]:.12g}{each.knob.unit}"
        assert pipeline.compile(source, params={each.knob.path: works}).ok
        assert not pipeline.compile(source, params={each.knob.path: beyond}).ok


@pytest.mark.usefixtures("at_once")
def test_limits_hold_as_for_any_compile() -> None:
    text = """\
drawing d {
    param count = 3 in 1..100000
    for i in 1..count { for j in 1..count { a[i, j] = circle(center: (i, j), radius: 0.1) } }
}
"""
    (upper,) = [each for each in swept(text, building=BuildingLimits(entities=30)).turned if not each.ok]
    assert sentence(upper, "plate.aidl") == (
        "at `count = 100000` line 3: this program builds more than 30 structures and geometries; "
        "all is well up to 5"
    )


def _ends_process(*_: object) -> Tried:
    os._exit(3)


def _devours(*_: object) -> Tried:
    raise MemoryError


def _hangs(*_: object) -> Tried:
    threading.Event().wait(600)
    return Tried(ok=True)


@pytest.mark.parametrize(
    ("breaking", "said"),
    [
        (_ends_process, "the program ends the process that compiles it"),
        (_devours, "the program needs more memory than there is for it"),
        (_hangs, "the program takes longer than a compile may"),
    ],
)
def test_process_that_breaks_is_a_result(
    monkeypatch: pytest.MonkeyPatch, breaking: object, said: str
) -> None:
    monkeypatch.setattr(ends, "tried", breaking)
    monkeypatch.setattr(SweepJob, "seconds", 0.2 if breaking is _hangs else 30.0)
    turned = swept("solid a { param r = 2 in 1..3; b = circle(center: origin, radius: r) }").turned
    assert [sentence(each, "plate.aidl") for each in turned] == [f"at `r = {r}` {said}" for r in (1, 3)]
