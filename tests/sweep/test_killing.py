"""A sweep that is killed at any moment goes on, and its table is whole; so is that of one whose workers are
killed.
"""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from tests.sweep.here import PLATE

VALUES = ["-D", "width=40..100/12", "-D", "style=*", "-o", "out/{width}-{style}.dxf", "--no-timings"]


def begin(folder: Path, table: str, *more: str) -> subprocess.Popen[bytes]:
    words = [sys.executable, "-m", "aidl_lang", "sweep", "plate.aidl", *VALUES, "-o", table, *more]
    with open(folder / "said", "wb") as said:
        return subprocess.Popen(words, cwd=folder, stderr=said, start_new_session=True)


def children_of(group: int) -> list[str]:
    """Returns the processes that a killed sweep has left."""
    told = subprocess.run(["ps", "-o", "pid=,stat=", "-g", str(group)], capture_output=True, text=True).stdout
    return [line for line in told.splitlines() if "Z" not in line.split()[1]]


def workers_of(run: subprocess.Popen[bytes]) -> list[int]:
    """Returns the processes that compile for a sweep: its grandchildren."""
    told = subprocess.run(
        ["ps", "-o", "pid=,ppid=", "-g", str(run.pid)], capture_output=True, text=True
    ).stdout
    parents = {int(pid): int(parent) for pid, parent in map(str.split, told.splitlines())}
    return [pid for pid, parent in parents.items() if parents.get(parent) == run.pid]


def without_workers(folder: Path, sweeps: int, seed: int, *, widths: int, times: int) -> None:
    """Kills so many workers at random instants of each sweep."""
    chance, kills = random.Random(seed), 0
    (folder / "plate.aidl").write_text(PLATE)
    values = ["-D", f"width=40..100/{widths}", "-D", "style=*", "-o", "table.csv", "--no-timings"]
    words = [sys.executable, "-m", "aidl_lang", "sweep", "plate.aidl", *values, "--jobs", "2"]
    whole = b""
    for number in range(sweeps + 1):
        with open(folder / "said", "wb") as said:
            run = subprocess.Popen(words, cwd=folder, stderr=said, start_new_session=True)
        left = times if number else 0
        while left and run.poll() is None:
            time.sleep(chance.uniform(0.0, 0.15))
            for worker in chance.sample(found := workers_of(run), min(1, len(found))):
                with suppress(ProcessLookupError):
                    os.kill(worker, signal.SIGKILL)
                    left, kills = left - 1, kills + 1
        assert run.wait(120) == 0, (folder / "said").read_text()
        whole = whole or (folder / "table.csv").read_bytes()
        assert (folder / "table.csv").read_bytes() == whole
    assert whole.count(b"\n") == 1 + 2 * widths
    assert kills > times // 2 * sweeps


def test_workers_that_are_killed_are_replaced(tmp_path: Path) -> None:
    without_workers(tmp_path, 1, seed=3, widths=20, times=4)


@pytest.mark.slow
def test_workers_are_killed_at_two_hundred_instants(tmp_path: Path) -> None:
    without_workers(tmp_path, 20, seed=4, widths=50, times=10)


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
    assert len(list((folder / "out").glob("[!.]*.dxf"))) == 24
    assert not (folder / "table.csv.sweep").exists()


def test_a_killed_sweep_goes_on(tmp_path: Path) -> None:
    killed(tmp_path, 1, seed=1)


@pytest.mark.slow
def test_a_sweep_killed_twenty_times_goes_on(tmp_path: Path) -> None:
    killed(tmp_path, 20, seed=2)
