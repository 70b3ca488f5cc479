"""Runs contestants side by side, each in a process of its own, and judges what they answer.

A contestant that takes longer than the limit for one run is killed, and started again for the next sketch.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from types import TracebackType
from typing import Any

import numpy as np

from benchmarks.solver.install_peers import DEFAULT
from benchmarks.solver.sketch import TOLERANCE, Evaluator, Sketch

ROOT = Path(__file__).resolve().parents[2]
OURS = "ours"
NAMES = ("planegcs", "python-solvespace", "slvs", "ezpz", "scipy", "scipy-sparse")
"""The peers in the order of the tables."""
START = 60.0
"""Seconds within which a contestant must be there."""

_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


@dataclass(frozen=True)
class Answer:
    """What came of one sketch. Times in seconds; `trouble` is why there is nothing to judge, or "".

    `residual` is the largest one by the judge, `worst` the type of constraint it belongs to; `said` is what
    the contestant thinks.
    """

    trouble: str = ""
    build: float = 0.0
    solve: float = 0.0
    analyse: float | None = None
    said: str = ""
    x: tuple[float, ...] = ()
    residual: float = np.inf
    worst: str = ""

    @property
    def is_solved(self) -> bool:
        return not self.trouble and self.residual < TOLERANCE


class Runner:
    """One contestant. `missing` says why it cannot take part, or is ""."""

    def __init__(self, name: str, limit: float, peers: Path = DEFAULT) -> None:
        self.name, self.limit = name, limit
        self.missing, self.version = "", ""
        self._command = _command(name, peers)
        self._process: subprocess.Popen[str] | None = None
        self._is_late = False
        if not Path(self._command[0]).exists():
            self.missing = f"{self._command[0]} does not exist"
        else:
            self._start()

    def __enter__(self) -> Runner:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop()

    def run(self, path: Path, evaluator: Evaluator) -> Answer:
        """Solves the sketch that was saved at `path`, once."""
        if self._process is None and not self.missing:
            self._start()
        process = self._process
        if self.missing or process is None:
            return Answer("missing")
        assert process.stdin is not None
        process.stdin.write(f"{path}\n")
        process.stdin.flush()
        answer = self._answer(process, self.limit)
        if answer is None:
            return Answer(f"> {self.limit:g} s" if self._is_late else "crashed")
        if "x" not in answer:
            return Answer(": ".join(str(part) for pair in answer.items() for part in pair))
        residual, worst = evaluator.worst(np.array(answer["x"], dtype=np.float64))
        return Answer("", **{**answer, "x": tuple(answer["x"])}, residual=residual, worst=worst)

    def _start(self) -> None:
        self._process = subprocess.Popen(
            self._command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            env={**os.environ, **_ONE_THREAD, "PYTHONPATH": str(ROOT)},
        )
        greeting = self._answer(self._process, START) or {"missing": "it does not start"}
        self.missing, self.version = greeting.get("missing", ""), greeting.get("version", "")

    def _stop(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None

    def _answer(self, process: subprocess.Popen[str], limit: float) -> dict[str, Any] | None:
        """None if it took too long or broke down; the process is gone then."""
        self._is_late = False

        def end() -> None:
            self._is_late = True
            process.kill()

        watchdog = threading.Timer(limit, end)
        watchdog.start()
        assert process.stdout is not None
        line = process.stdout.readline()
        watchdog.cancel()
        if not line:
            self._stop()
            return None
        found: dict[str, Any] = json.loads(line)
        return found


def _command(name: str, peers: Path) -> list[str]:
    if name == "ezpz":
        return [str(peers / "ezpz" / "release" / "ezpz-peer")]
    python = sys.executable if name == OURS else str(peers / "bin" / "python")
    return [python, "-m", "benchmarks.solver.worker", name]


@dataclass
class Times:
    """The measured runs of one contestant on one sketch, the first one thrown away if there are more."""

    answers: list[Answer] = field(default_factory=list)

    @property
    def kept(self) -> list[Answer]:
        return self.answers[1:] or self.answers

    @property
    def spent(self) -> float:
        return sum(answer.build + answer.solve for answer in self.answers)

    @property
    def trouble(self) -> str:
        """Why its times do not count, or "": what one run got wrong, the contestant got wrong."""
        for answer in self.answers:
            if answer.trouble:
                return answer.trouble
            if not answer.is_solved:
                return f"{answer.said}, off by {answer.residual:.0e}"
        return ""

    @property
    def build(self) -> float:
        return median(answer.build for answer in self.kept)

    @property
    def solve(self) -> float:
        return median(answer.solve for answer in self.kept)

    @property
    def analyse(self) -> float | None:
        taken = [answer.analyse for answer in self.kept if answer.analyse is not None]
        return median(taken) if taken else None


def race(runners: Sequence[Runner], sketch: Sketch, runs: int, budget: float) -> Mapping[str, Times]:
    """All contestants on one sketch, in turn, so that noise hits all alike; one that has used up `budget`
    seconds, or failed, rests from then on.
    """
    evaluator = Evaluator(sketch)
    times = {runner.name: Times() for runner in runners}
    with TemporaryDirectory() as folder:
        path = Path(folder) / "sketch.json"
        for _ in range(runs + 1):
            sketch.save(path)
            for runner in runners:
                taken = times[runner.name]
                if not taken.answers or (not taken.trouble and taken.spent < budget):
                    taken.answers.append(runner.run(path, evaluator))
    return times
