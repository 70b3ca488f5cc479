from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from aidl_web.site import ROOT, WEB, built
from server.tests.preview.conftest import browser
from web.tests.places import MISSING, PYODIDE, Run

__all__ = ["browser"]


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the playground, built once for all tests of a process."""
    if MISSING:
        pytest.skip(MISSING)
    folder = tmp_path_factory.mktemp("site") / "playground"
    built(
        folder,
        str(PYODIDE),
        tmp_path_factory.mktemp("work") if not ROOT.joinpath("build").exists() else ROOT / "build" / "web",
    )
    return folder


@pytest.fixture(scope="session")
def run(site: Path) -> Run:
    def run(script: Path, *arguments: Path | str) -> str:
        command = ["node", str(WEB / "node" / "run.mjs"), str(site), str(script), *map(str, arguments)]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=580)
        assert done.returncode == 0, done.stderr[-3000:] + done.stdout[-1000:]
        return done.stdout

    return run
