"""A folder with programs to vary, whose sweeps run in the test's own process."""

from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang.tools.sweeping import session
from tests.commands import aidl as aidl
from tests.sweep.here import PLATE, SIGN, Here


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working directory. What is started as a process of its own has workers, as its user has."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("NO_COLOR", "1")
    (tmp_path / "plate.aidl").write_text(PLATE)
    (tmp_path / "sign.aidl").write_text(SIGN)
    monkeypatch.setattr(session, "Guarded", lambda workers, preload: Here())
    return tmp_path
