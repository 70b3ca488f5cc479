"""`make fuzz MINUTES=2`: tries programs for so long, and ends with 1 if one of them broke something.

What breaks is made small and written to a folder, by its seed; a program that is mended moves from there to
`tests/fuzz/programs`, where it stays a test.
"""

from __future__ import annotations

import argparse
import json
import random
import resource
import sys
import time
import warnings
from collections import Counter
from pathlib import Path

from tests.fuzz.judge import Finding, Judge
from tests.fuzz.minimise import minimised
from tests.fuzz.sources import program

_MEMORY = 4 << 30
"""Bytes that one program and all it draws must do with."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=2.0)
    parser.add_argument("--seed", type=int, help="of the first program; the others follow it")
    parser.add_argument("--programs", type=int, help="so many, in place of a time")
    parser.add_argument("--out", type=Path, default=Path("build/fuzz"))
    arguments = parser.parse_args()
    first = arguments.seed if arguments.seed is not None else random.SystemRandom().randrange(1 << 32)
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    warnings.simplefilter("error")
    print(f"fuzzing from seed {first}", flush=True)
    run = _Run(arguments.out)
    begin, seed = time.monotonic(), first
    while (
        seed < first + arguments.programs
        if arguments.programs
        else time.monotonic() < begin + 60 * arguments.minutes
    ):
        run.take(seed)
        seed += 1
    run.report(time.monotonic() - begin)
    return 1 if run.findings else 0


class _Run:
    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.judge = Judge()
        self.sources: Counter[str] = Counter()
        self.findings: dict[tuple[str, str], list[int]] = {}
        self.slowest = (0.0, 0)

    def take(self, seed: int) -> None:
        source, text = program(seed)
        self.sources[source] += 1
        begin = time.process_time()
        found = self.judge.finding(text, seed)
        self.slowest = max(self.slowest, (time.process_time() - begin, seed))
        if found is None:
            return
        known = self.findings.setdefault(found.cause, [])
        known.append(seed)
        if len(known) == 1:
            self._keep(seed, text, found)

    def _keep(self, seed: int, text: str, found: Finding) -> None:
        """Write the smallest program that has the same finding."""
        judge = Judge()

        def alike(other: str) -> bool:
            again = judge.finding(other, seed)
            return again is not None and again.cause == found.cause

        small = minimised(text, alike, seconds=60.0)
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / f"{seed}.aidl").write_text(small, "utf-8")
        (self.folder / f"{seed}.txt").write_text(f"{found.stage}: {found.kind}\n\n{found.details}", "utf-8")
        print(f"seed {seed}: {found.stage}: {found.kind}\n{small}\n", flush=True)

    def report(self, seconds: float) -> None:
        told = {
            "seconds": round(seconds),
            "programs": dict(self.sources),
            "steps": dict(self.judge.counts),
            "slowest": {"seconds": round(self.slowest[0], 1), "seed": self.slowest[1]},
            "findings": {f"{stage}: {kind}": seeds for (stage, kind), seeds in self.findings.items()},
        }
        print(json.dumps(told, indent=1))


if __name__ == "__main__":
    sys.exit(main())
