"""A folder with programs to vary, whose sweeps run in the test's own process."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import aidl as aidl
from tests.sweep.here import PLATE, SIGN
from tests.sweep.here import at_once as at_once


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, at_once: None) -> Path:
    """The working directory."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("NO_COLOR", "1")
    (tmp_path / "plate.aidl").write_text(PLATE)
    (tmp_path / "sign.aidl").write_text(SIGN)
    return tmp_path
