"""A scheduler of Dask and its workers on loopback, as processes of their own."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path


def free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


class LocalCluster:
    """Starts and ends schedulers and workers; each is a group of processes, which ends as one."""

    def __init__(self, folder: Path, workers: int) -> None:
        self.folder, self.port = folder, free_port()
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.workers: list[subprocess.Popen[bytes]] = []
        self.scheduler = self._scheduler()
        for _ in range(workers):
            self.add_worker()

    def _scheduler(self) -> subprocess.Popen[bytes]:
        words = ["scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard", "--no-show"]
        begun = self._begin("scheduler", *words)
        until = time.monotonic() + 60
        while time.monotonic() < until:
            with socket.socket() as asked:
                if asked.connect_ex(("127.0.0.1", self.port)) == 0:
                    return begun
            time.sleep(0.1)
        raise AssertionError((self.folder / "scheduler.log").read_text())

    def add_worker(self) -> None:
        words = ["worker", self.address, "--host", "127.0.0.1", "--nthreads", "1"]
        self.workers.append(self._begin(f"worker{len(self.workers)}", *words, "--no-dashboard"))

    def _begin(self, name: str, *words: str) -> subprocess.Popen[bytes]:
        with open(self.folder / f"{name}.log", "ab") as log:
            return subprocess.Popen(
                [str(Path(sys.executable).with_name("dask")), *words],
                cwd=self.folder,
                stdout=log,
                stderr=log,
                start_new_session=True,
                env={**os.environ, "DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "False"},
            )

    def kill_worker(self) -> None:
        """Kills the oldest worker with its nanny, in the middle of whatever it does."""
        _kill(self.workers.pop(0))

    def restart(self) -> None:
        """Kills the scheduler and all workers, and starts them anew at the same address."""
        count = len(self.workers)
        self.close()
        time.sleep(1)
        self.scheduler = self._scheduler()
        for _ in range(count):
            self.add_worker()

    def close(self) -> None:
        for process in (*self.workers, self.scheduler):
            _kill(process)
        self.workers = []


def _kill(process: subprocess.Popen[bytes]) -> None:
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
