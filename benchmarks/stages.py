"""Where the time of a compile goes: milliseconds of each stage, in a warm process.

    python benchmarks/stages.py [--runs N] [--facts] [FOLDER_OR_PROGRAM …]

Without one, the gallery and the other examples. Prints a Markdown table with a column for each folder: the
median over its programs, the worst in brackets. `between` is what no stage counts, most of it the collection
of garbage, `write` the SVG, `whole` the way from the text to its bytes; with `--facts`, whatever is told of
the drawing is worked out as well. Each program is compiled once to warm up, then N times; a stage counts with
its least time. Programs that do not draw are left out, and named.
"""

from __future__ import annotations

import argparse
import gc
import os
import sys
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from statistics import median

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy is loaded; as the command does

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"


def main() -> None:
    parser = argparse.ArgumentParser(description="Measure the stages of a compile.")
    parser.add_argument("places", nargs="*", type=Path, default=[EXAMPLES / "gallery", EXAMPLES])
    parser.add_argument("--runs", type=int, default=5, help="compiles of each program (default 5)")
    parser.add_argument("--facts", action="store_true", help="read all that is told of the drawing")
    arguments = parser.parse_args()
    columns = {
        place.stem: [row for path in _programs(place) if (row := _row(path, arguments.runs, arguments.facts))]
        for place in arguments.places
    }
    columns = {name: rows for name, rows in columns.items() if rows}
    stages = dict.fromkeys(stage for rows in columns.values() for row in rows for stage in row)
    print("| ms | " + " | ".join(f"{name}, {len(rows)} programs" for name, rows in columns.items()) + " |")
    print("|---|" + "--:|" * len(columns))
    for stage in stages:
        print(f"| {stage} | " + " | ".join(_cell(rows, stage) for rows in columns.values()) + " |")


def _programs(place: Path) -> Iterable[Path]:
    return sorted(place.glob("*.aidl")) if place.is_dir() else [place]


def _cell(rows: Iterable[Mapping[str, float]], stage: str) -> str:
    taken = [1e3 * row.get(stage, 0.0) for row in rows]
    return f"{median(taken):.0f} ({max(taken):.0f})"


def _row(path: Path, runs: int, facts: bool) -> dict[str, float] | None:
    """Returns the seconds of each stage, the whole as the last; None if the program does not draw."""
    source, world = SourceFile(path.name, path.read_text(encoding="utf-8")), DiskWorld(path.resolve().parent)
    least: dict[str, float] = {}
    for run in range(runs + 1):
        gc.collect()
        began = time.perf_counter()
        made = pipeline.compile(source, world)
        if made.drawing is None or made.status != "solved":
            print(f"{path} is left out: {made.status}", file=sys.stderr)
            return None
        if facts:
            made.find()
        compiled = time.perf_counter()
        made.export(".svg")
        ended = time.perf_counter()
        known = sum(made.timings.values())
        rest = compiled - began - known
        taken = {**made.timings, "between": rest, "write": ended - compiled, "whole": ended - began}
        if run:
            least = {stage: min(least.get(stage, s), s) for stage, s in taken.items()}
    return least


if __name__ == "__main__":
    main()
