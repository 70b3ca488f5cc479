"""Whole commands beside OpenSCAD on programs that draw the same things.

    python benchmarks/commands.py [--runs N] [FOLDER]

FOLDER holds pairs, `NAME.aidl` and `NAME.scad`; without one it is this folder. Prints Markdown: seconds of
the processor's time from start to exit, medians of runs in turn, and of a compile in a warm process.
"""

from __future__ import annotations

import argparse
import gc
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld

HERE = Path(__file__).resolve().parent


def main() -> None:
    parser = argparse.ArgumentParser(description="Measure whole commands beside OpenSCAD.")
    parser.add_argument("folder", nargs="?", type=Path, default=HERE)
    parser.add_argument("--runs", type=int, default=5, help="runs of each command (default 5)")
    arguments = parser.parse_args()
    pairs = [
        (program, peer)
        for program in sorted(arguments.folder.glob("*.aidl"))
        if (peer := program.with_suffix(".scad")).exists()
    ]
    print("| program | aidl, s | OpenSCAD, s | times | aidl warm, ms |\n|---|--:|--:|--:|--:|")
    rows = [_row(program, peer, max(1, arguments.runs)) for program, peer in pairs]
    for (program, _), row in zip(pairs, rows, strict=True):
        print(f"| {program.stem} |" + _cells(row))
    if len(rows) > 1:
        print("| *median* |" + _cells(tuple(map(median, zip(*rows, strict=True)))))


Row = tuple[float, float, float, float]


def _cells(row: tuple[float, ...]) -> str:
    ours, peer, times, warm = row
    return f" {ours:.2f} | {peer:.3f} | {times:.1f} | {1e3 * warm:.0f} |"


def _row(program: Path, peer: Path, runs: int) -> Row:
    with tempfile.TemporaryDirectory() as folder:
        output = str(Path(folder) / "out.svg")
        ours = [sys.executable, "-m", "aidl_lang", "compile", str(program), "--quiet", "-o", output]
        theirs = ["openscad", "-o", output, str(peer)]
        taken = [(_processor(ours), _processor(theirs)) for _ in range(runs + 1)][1:]
    aidl, openscad = (median(column) for column in zip(*taken, strict=True))
    return aidl, openscad, aidl / openscad, _warm(program, runs)


def _processor(command: list[str]) -> float:
    """Seconds of the processor's time that a command takes."""
    # With bytecode kept, as in every installation: the first run writes it, and is thrown away.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, capture_output=True, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def _warm(program: Path, runs: int) -> float:
    source = SourceFile(program.name, program.read_text(encoding="utf-8"))
    world = DiskWorld(program.resolve().parent)
    return median([_timed(lambda: pipeline.compile(source, world)) for _ in range(runs + 1)][1:])


def _timed(do: Callable[[], object]) -> float:
    gc.collect()
    start = time.process_time()
    do()
    return time.process_time() - start


if __name__ == "__main__":
    main()
