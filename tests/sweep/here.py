"""What the tests of sweeps have in common: a program, and an engine that carries calls out on the spot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from pathlib import Path
from typing import TypeVar

import pytest

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld
from aidl_lang.tools.sweeping.outputs import outputs
from aidl_lang.tools.sweeping.plan import axis, planned, read_table
from aidl_lang.tools.sweeping.session import Job, Sweep, opened, reproducing
from aidl_lang.tools.sweeping.working import Making

T = TypeVar("T")

PLATE = """\
/// A plate with a bore.
param width = 60mm in 40..120 step 20
param style = "round" in ["round", "square"]
param bored = true
@thickness(3mm)
solid plate {
    body = rectangle(center: origin, width: width, height: 30mm)
    if style == "round" { fillet(body, 5mm) }
    if bored { hole bore { rim = circle(center: (0, 0), radius: 5mm) } }
    assert body.width < 110mm, "it fits the sheet"
}
"""
SIGN = """\
param name = "Ada"
param width = 60mm in 40..400
@thickness(3mm)
solid sign {
    plate = rectangle(center: origin, width: width, height: 20mm)
    drawing letters { word = text(name, height: 8mm) }
    assert letters.width <= width - 6mm, "the name is too long"
    assert letters.height <= 16mm, "the name is too high"
}
"""


class Here:
    """Carries calls out at once, in this process, and counts them."""

    places = 2

    def __init__(self) -> None:
        self.calls = 0

    def submit(self, seconds: float, task: Callable[..., T], *arguments: object) -> Future[T]:
        self.calls += 1
        future: Future[T] = Future()
        try:
            future.set_result(task(*arguments))
        except Exception as error:  # noqa: BLE001 (handed over)
            future.set_exception(error)
        return future

    def close(self) -> None:
        pass


@pytest.fixture
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sweeps, the ends of params and what lies between are carried out in the test's own process."""
    monkeypatch.setattr("aidl_lang.common.processes.prepared", lambda preload: None)
    monkeypatch.setattr("aidl_lang.tools.sweeping.session.Guarded", lambda workers, preload: Here())
    monkeypatch.setattr("aidl_lang.tools.ends.Guarded", lambda workers, preload: Here())


def asked(
    folder: Path,
    values: Sequence[str] = ("width=40,80", "style=*"),
    names: Sequence[str] = (),
    text: str = PLATE,
    table: str | None = None,
    **more: object,
) -> Job:
    """A sweep in a folder, as it is to be run."""
    (folder / "plate.aidl").write_text(text)
    bundle, world, knobs = opened(SourceFile("plate.aidl", text), DiskWorld(folder), pipeline.Settings())
    rows = None
    if table is not None:
        (folder / "orders.csv").write_text(table, newline="")
        rows = read_table(folder / "orders.csv", knobs, world.reads)
    plan = planned(knobs, [axis(*each.split("=", 1), knobs) for each in values], rows)
    wanted = outputs([str(folder / name) for name in names], plan, world.reads)
    return Job(
        plan,
        bundle,
        world,
        Making(),
        wanted,
        lambda variant, name: reproducing("plate.aidl", plan, variant, name),
        timings=False,
        **more,
    )


def sweep(
    folder: Path,
    values: Sequence[str] = ("width=40,80", "style=*"),
    names: Sequence[str] = (),
    engine: Here | None = None,
    text: str = PLATE,
    **more: object,
) -> Sweep:
    """Runs a sweep in a folder to its end."""
    session = Sweep(asked(folder, values, names, text, **more), lambda: engine or Here())
    list(session)
    return session
