"""A sweep that is killed at any moment goes on, and its table is whole; so is that of one whose workers are
killed. Whole ones are made in this process.
"""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path

import pytest

from aidl_lang.tools.cli import main


def words(widths: int, *outputs: str) -> list[str]:
    named = [word for name in outputs for word in ("-o", name)]
    return ["sweep", "plate.aidl", "-D", f"width=40..100/{widths}", "-D", "style=*", "--no-timings", *named]


def begin(arguments: Sequence[str]) -> subprocess.Popen[bytes]:
    with open("said", "wb") as said:
        command = [sys.executable, "-m", "aidl_lang", *arguments]
        return subprocess.Popen(command, stderr=said, start_new_session=True)


def processes_of(group: int) -> dict[int, tuple[int, str]]:
    """Returns the parent and the state of each process of a group."""
    told = subprocess.run(
        ["ps", "-o", "pid=,ppid=,stat=", "-g", str(group)], capture_output=True, text=True
    ).stdout
    return {int(pid): (int(parent), state) for pid, parent, state in map(str.split, told.splitlines())}


def without_workers(folder: Path, sweeps: int, seed: int, *, widths: int, times: int) -> None:
    """Kills so many workers, the grandchildren of a sweep, at random instants of each sweep."""
    chance, kills = random.Random(seed), 0
    assert main(words(widths, "table.csv")) == 0
    whole = (folder / "table.csv").read_bytes()
    for _ in range(sweeps):
        run, left = begin([*words(widths, "table.csv"), "--jobs", "2"]), times
        while left and run.poll() is None:
            time.sleep(chance.uniform(0.0, 0.15))
            found = processes_of(run.pid)
            workers = [pid for pid, (parent, _) in found.items() if found.get(parent, (0,))[0] == run.pid]
            for worker in chance.sample(workers, min(1, len(workers))):
                with suppress(ProcessLookupError):
                    os.kill(worker, signal.SIGKILL)
                    left, kills = left - 1, kills + 1
        assert run.wait(120) == 0, (folder / "said").read_text()
        assert (folder / "table.csv").read_bytes() == whole
    assert whole.count(b"\n") == 1 + 2 * widths
    assert kills > times // 2 * sweeps


def test_workers_that_are_killed_are_replaced(folder: Path) -> None:
    without_workers(folder, 1, seed=3, widths=20, times=4)


@pytest.mark.slow
def test_workers_are_killed_at_two_hundred_instants(folder: Path) -> None:
    without_workers(folder, 20, seed=4, widths=50, times=10)


def killed(folder: Path, waits: Sequence[Callable[[], object]], *, widths: int) -> None:
    """Begins a sweep and kills it after each wait; what the last one leaves is gone on with."""
    drawings = "out/{width}-{style}.svg"
    assert main(words(widths, drawings, "whole.csv")) == 0
    for path in (folder / "out").iterdir():
        path.unlink()
    again = [*words(widths, drawings, "table.csv"), "--resume"]
    for wait in waits:
        run = begin(again)
        wait()
        os.kill(run.pid, signal.SIGKILL)
        run.wait()
        until = time.monotonic() + 20
        while any("Z" not in state for _, state in processes_of(run.pid).values()):
            assert time.monotonic() < until, "it left processes behind"
            time.sleep(0.1)
        if (folder / "table.csv").exists():  # it was over before it was killed
            assert (folder / "table.csv").read_bytes() == (folder / "whole.csv").read_bytes()
            (folder / "table.csv").unlink()
    assert main(again) == 0
    assert (folder / "table.csv").read_bytes() == (folder / "whole.csv").read_bytes()
    assert len(list((folder / "out").glob("[!.]*.svg"))) == 2 * widths
    assert not (folder / "table.csv.sweep").exists()


def test_a_killed_sweep_goes_on(folder: Path) -> None:
    def has_drawn() -> None:
        until = time.monotonic() + 60
        while not list((folder / "out").glob("[!.]*.svg")):
            assert time.monotonic() < until, (folder / "said").read_text()
            time.sleep(0.01)

    killed(folder, [has_drawn], widths=4)


@pytest.mark.slow
def test_a_sweep_killed_twenty_times_goes_on(folder: Path) -> None:
    chance = random.Random(2)
    killed(folder, [partial(time.sleep, chance.uniform(0.3, 5.0)) for _ in range(20)], widths=12)
