"""Programs at the ends of their params: what is said, and that it is so."""

from __future__ import annotations

import os
import threading
from dataclasses import replace

import pytest

from aidl_lang import pipeline
from aidl_lang.building.state import BuildingLimits
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from aidl_lang.tools import ends
from aidl_lang.tools.ends import Sweep, SweepJob, Tried, sentence, sweep

PLATE = """\
solid plate {
    param width = 60mm in 40..120
    param height = 94mm in 20..200
    param soft = 3mm in 1..31
    param holes = 3 in 1..9
    param look = "plain" in ["plain", "split"]
    param hollow = false
    param odd = 3
    body = rectangle(center: origin, width: width, height: height)
    fillet(body, soft)
    hole cut { row = linear_array(circle(radius: 3), n: holes, pitch: 10) }
    constrain cut.left == body.left + 4
    if hollow { hole h { m = circle(center: (0, 20), radius: odd) } }
    if look == "split" { constrain { cut.center_y == 1; cut.center_y == 2 } }
    assert height > width, "taller than wide"
    assert cut.right < body.right
}
"""


def swept(text: str, files: dict[str, str] | None = None, **limits: object) -> Sweep:
    job = SweepJob("plate.aidl", text, MemoryWorld(files or {}), replace(pipeline.Settings(), **limits))
    compiled = pipeline.compile(SourceFile("plate.aidl", text), job.world)
    assert compiled.ok, compiled.diagnostics
    return sweep(job, compiled.knobs, compiled.diagnostics)


def test_what_fails_is_told_with_how_far_it_holds() -> None:
    found = swept(PLATE)
    *others, split = (text for each in found.turned if (text := sentence(each, "plate.aidl")))
    assert split.startswith('at `look = "split"` line 14: `cut.center_y == 1`')
    assert others == [
        "at `width = 120mm` the assert in line 15 fails (94 is not > 120); "
        "`height > width` holds up to 93.99mm",
        "at `height = 20mm` the assert in line 15 fails (20 is not > 60); "
        "`height > width` holds down to 60.01mm",
        "at `soft = 31mm` `fillet(body, soft)` in line 10 does not fit; it fits up to 30mm",
        "at `holes = 9` the assert in line 16 fails (60 is not < 30); `cut.right < body.right` holds up to 6",
    ]
    assert [(t.knob.path, t.value) for t in found.turned if t.ok] == [
        ("width", 40.0),
        ("height", 200.0),
        ("soft", 1.0),
        ("holes", 1.0),
        ("hollow", True),
    ]
    assert ([k.path for k in found.rangeless], found.left, found.ok) == (["odd"], 0, False)


def test_limits_work_as_they_are_printed_and_the_next_values_do_not() -> None:
    source = SourceFile("plate.aidl", PLATE)
    limits = [each for each in swept(PLATE).turned if each.works is not None]
    assert len(limits) == 4
    for each in limits:
        works, beyond = f"{each.works:.12g}{each.knob.unit}", f"{each.beyond[0]:.12g}{each.knob.unit}"
        assert pipeline.compile(source, params={each.knob.path: works}).ok
        assert not pipeline.compile(source, params={each.knob.path: beyond}).ok


def test_another_fault_may_come_first() -> None:
    text = """\
solid plate {
    param width = 60mm in 40..120
    body = rectangle(center: origin, width: width, height: 94)
    assert width < 110
    assert body.width * 2 <= 140, "fits the sheet"
}
"""
    (upper,) = [each for each in swept(text).turned if not each.ok]
    assert sentence(upper, "plate.aidl") == (
        "at `width = 120mm` the assert in line 4 fails (120 is not < 110); "
        "the assert in line 5 fails (120 * 2 = 240, which is not <= 140); all is well up to 70mm, "
        "and at 70.01mm the assert in line 5 fails (70.01 * 2 = 140.02, which is not <= 140)"
    )


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
    monkeypatch.setattr(SweepJob, "seconds", 3.0)
    turned = swept("solid a { param r = 2 in 1..3; b = circle(center: origin, radius: r) }").turned
    assert [sentence(each, "plate.aidl") for each in turned] == [f"at `r = {r}` {said}" for r in (1, 3)]
