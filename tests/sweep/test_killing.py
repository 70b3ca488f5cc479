"""A sweep that is killed at any moment goes on, and its table is whole."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.sweep.here import PLATE

VALUES = ["-D", "width=40..100/30", "-D", "style=*", "-o", "out/{width}-{style}.dxf", "--no-timings"]


def begin(folder: Path, table: str, *more: str) -> subprocess.Popen[bytes]:
    words = [sys.executable, "-m", "aidl_lang", "sweep", "plate.aidl", *VALUES, "-o", table, *more]
    with open(folder / "said", "wb") as said:
        return subprocess.Popen(words, cwd=folder, stderr=said, start_new_session=True)


def children_of(group: int) -> list[str]:
    """Returns the processes that a killed sweep has left."""
    told = subprocess.run(["ps", "-o", "pid=,stat=", "-g", str(group)], capture_output=True, text=True).stdout
    return [line for line in told.splitlines() if "Z" not in line.split()[1]]


def killed(folder: Path, times: int, seed: int) -> None:
    (folder / "plate.aidl").write_text(PLATE)
    whole = begin(folder, "whole.csv")
    assert whole.wait() == 0, (folder / "said").read_text()
    chance = random.Random(seed)
    for _ in range(times):
        run = begin(folder, "table.csv", "--resume")
        time.sleep(chance.uniform(0.3, 5.0))
        os.kill(run.pid, signal.SIGKILL)
        run.wait()
        until = time.monotonic() + 20
        while children_of(run.pid) and time.monotonic() < until:
            time.sleep(0.1)
        assert not children_of(run.pid)
        if (folder / "table.csv").exists():  # it was over before it was killed
            assert (folder / "table.csv").read_bytes() == (folder / "whole.csv").read_bytes()
            (folder / "table.csv").unlink()
    last = begin(folder, "table.csv", "--resume")
    assert last.wait() == 0, (folder / "said").read_text()
    assert (folder / "table.csv").read_bytes() == (folder / "whole.csv").read_bytes()
    assert len(list((folder / "out").glob("[!.]*.dxf"))) == 60
    assert not (folder / "table.csv.sweep").exists()


def test_a_killed_sweep_goes_on(tmp_path: Path) -> None:
    killed(tmp_path, 2, seed=1)


@pytest.mark.slow
def test_a_sweep_killed_twenty_times_goes_on(tmp_path: Path) -> None:
    killed(tmp_path, 20, seed=2)
