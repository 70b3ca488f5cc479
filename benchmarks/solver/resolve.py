"""Solving again after a change of one parameter, as under `aidl watch`.

    python benchmarks/solver/resolve.py [FILE] [--param NAME] [--values 150,155,…] [--runs N]

Everything runs in one process that has compiled the program before; the whole recompile is measured, and of
it the stage `solve` alone.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median

from aidl_lang import pipeline
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld
from aidl_lang.solver.hierarchy import Memory

TELEPHONE = Path(__file__).resolve().parents[2] / "examples" / "telephone.aidl"


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("file", type=Path, nargs="?", default=TELEPHONE)
    parser.add_argument("--param", default="width")
    parser.add_argument("--values", type=lambda text: text.split(","), default=["150", "155", "160", "165"])
    parser.add_argument("--runs", type=int, default=20)
    options = parser.parse_args()
    whole, solving = measure(options.file, options.param, options.values, options.runs)
    print(f"| {options.file.name}, {options.param} changed | median ms |\n|---|--:|")
    print(f"| recompile | {1000.0 * median(whole):.1f} |\n| of it, solve | {1000.0 * median(solving):.1f} |")


def measure(file: Path, param: str, values: Sequence[str], runs: int) -> tuple[list[float], list[float]]:
    """Seconds of each recompile, and of the solving in it. Raises ValueError if one does not solve."""
    source, world = SourceFile(file.name, file.read_text(encoding="utf-8")), DiskWorld(file.resolve().parent)
    whole, solving = [], []
    memory = Memory()
    _recompile(source, world, {}, memory)
    for run in range(runs):
        value = values[run % len(values)]
        start = time.perf_counter()
        compiled = _recompile(source, world, {param: value}, memory)
        whole.append(time.perf_counter() - start)
        if not compiled.ok:
            raise ValueError(f"{file.name} with {param}={value}: {compiled.status}")
        solving.append(compiled.timings["solve"])
    return whole, solving


def _recompile(
    source: SourceFile, world: DiskWorld, params: Mapping[str, str | float | bool], memory: Memory
) -> pipeline.Compiled:
    return pipeline.compile(source, world, params, memory=memory)


if __name__ == "__main__":
    main()
