"""Running the command line within the test's own process, in a folder of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import aidl as aidl
from tests.sweep.here import at_once as at_once

GOOD = """\
/// How wide the plate is.
param width = 40 in 20..200 step 5

solid plate {
    edge = rectangle(center: origin, width: width, height: 20)
}
"""
WRONG = "solid plate {\n    edge = rectangle(center: origin, width: wdth, height: 20)\n}\n"
UNSOLVABLE = """\
solid plate {
    edge = circle(center: origin, radius: 5)
    constrain edge.radius == 6
    constrain edge.radius == 7
}
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, at_once: None) -> Path:
    """An empty working directory with three programs in it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("NO_COLOR", "1")
    for name, text in (("good", GOOD), ("wrong", WRONG), ("unsolvable", UNSOLVABLE)):
        (tmp_path / f"{name}.aidl").write_text(text)
    return tmp_path
