"""What a check takes: everything that is said of a program without solving it, stage by stage.

    python benchmarks/check.py [--runs N] [PROGRAM …]

Prints Markdown. Programs are a typical one of 100 lines, `organiser.aidl`, and the examples. They take turns
in one process; the first rounds are thrown away, and the medians reported. Time is processor time.

The peer is OpenSCAD on a program of 100 lines that draws the same, `organiser.scad`: from the text to a tree
of primitives with numbers in them (`-o x.csg`), beside the same on an empty file. It runs loops and modules
as a check does; but every place in it is worked out by hand, so there are no constraints to read, and types
and references are not checked before it runs. Both are measured as whole commands: OpenSCAD is nothing else.
"""

from __future__ import annotations

import argparse
import gc
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from statistics import median

from aidl_lang import parser, pipeline
from aidl_lang.checking import library
from aidl_lang.checking.resolve import resolve
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld
from aidl_lang.interp import interpret
from aidl_lang.typecheck import check as typecheck

HERE = Path(__file__).resolve().parent
TYPICAL = HERE / "organiser.aidl"
PEER = HERE / "organiser.scad"
EXAMPLES = tuple(sorted((HERE.parent / "examples").glob("*.aidl")))

STAGES = ("parse", "resolve", "typecheck", "interpret", "all")
GOAL = 20.0
"""Milliseconds for the typical program, all stages together."""

_WARM_UP = 2


def main() -> None:
    options = argparse.ArgumentParser(description="Measure what a check takes.")
    options.add_argument("programs", nargs="*", type=Path, default=[TYPICAL, *EXAMPLES])
    options.add_argument("--runs", type=int, default=15, help="runs of each measurement (default 15)")
    arguments = options.parse_args()
    runs = max(3, arguments.runs)
    print_stages(in_turn(arguments.programs, runs))
    print_commands(runs)


def in_turn(programs: Sequence[Path], runs: int) -> dict[Path, list[Mapping[str, float]]]:
    """Seconds of every stage of every run, after the warm-up."""
    rounds = [{program: stages(program) for program in programs} for _ in range(_WARM_UP + runs)]
    return {program: [each[program] for each in rounds[_WARM_UP:]] for program in programs}


def stages(program: Path) -> Mapping[str, float]:
    """Seconds of each stage of one check, and of a whole one, with what it takes to let go of it again."""
    source = SourceFile(program.name, program.read_text(encoding="utf-8"))
    world = DiskWorld(program.resolve().parent)
    marks = []

    def mark() -> None:
        marks.append(time.process_time())

    gc.collect()
    gc.disable()  # as in a check
    mark()
    parsed = parser.parse(source)
    mark()
    resolution = resolve(parsed.module, world, library.load())
    mark()
    checked = typecheck(resolution)
    mark()
    interpret(checked)
    mark()
    gc.enable()
    gc.collect()
    start = time.process_time()
    pipeline.check(source, world)
    taken = [after - before for before, after in pairwise(marks)]
    return dict(zip(STAGES, [*taken, time.process_time() - start], strict=True))


def print_stages(times: Mapping[Path, Sequence[Mapping[str, float]]]) -> None:
    print(f"| check, ms | lines | {' | '.join(STAGES)} | of {GOAL:.0f} ms |")
    print("|---|--:|" + "--:|" * (len(STAGES) + 1))
    for program, runs in times.items():
        lines = program.read_text(encoding="utf-8").count("\n")
        found = [1000 * median(run[stage] for run in runs) for stage in STAGES]
        shown = " | ".join(f"{ms:.1f}" for ms in found)
        print(f"| {program.stem} | {lines} | {shown} | {found[-1] / GOAL:.1f} |")
    print()


def print_commands(runs: int) -> None:
    """Whole processes, each on the typical program and on next to nothing."""
    with tempfile.TemporaryDirectory() as folder:
        aidl = [sys.executable, "-m", "aidl_lang", "check", "--no-solve"]
        openscad = ["openscad", "-o", str(Path(folder) / "out.csg")]
        empty = {".aidl": "solid empty { }\n", ".scad": "\n"}
        for suffix, text in empty.items():
            (Path(folder) / f"empty{suffix}").write_text(text, encoding="utf-8")
        commands = {
            "`aidl check --no-solve`": [[*aidl, str(TYPICAL)], [*aidl, str(Path(folder) / "empty.aidl")]],
            "`openscad -o x.csg` (peer)": [
                [*openscad, str(PEER)],
                [*openscad, str(Path(folder) / "empty.scad")],
            ],
        }
        print("| command, ms | 100 lines | empty | difference |\n|---|--:|--:|--:|")
        for name, (full, bare) in commands.items():
            if shutil.which(full[0]) is None:
                print(f"| {name} | not installed | | |")
                continue
            taken = [(_process(full), _process(bare)) for _ in range(_WARM_UP + runs)][_WARM_UP:]
            whole, least = (1000 * median(column) for column in zip(*taken, strict=True))
            difference = 1000 * median(a - b for a, b in taken)
            print(f"| {name} | {whole:.0f} | {least:.0f} | {difference:.0f} |")


def _process(command: Sequence[str]) -> float:
    """Seconds of processor time that a command takes."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


if __name__ == "__main__":
    main()
