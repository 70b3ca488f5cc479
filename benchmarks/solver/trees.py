"""Hierarchies, which is what AIDL's solver is made for, against the same rows in a single group.

    python benchmarks/solver/trees.py [--shapes tree-2,row-100,…] [--limit SECONDS] [--runs N]
    python benchmarks/solver/trees.py --one tree-3 [--flat] [--profile]

`assemblies.py` says what the shapes are. Each measurement is a process of its own. The first run warms up;
its memory is the most that it took on top of the problem, libraries that it loads included.
"""

from __future__ import annotations

import argparse
import cProfile
import gc
import json
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from statistics import median

from aidl_lang.solver import solve
from benchmarks.solver.assemblies import assembly, flattened, worst_violation
from benchmarks.solver.ours import SETTINGS
from benchmarks.solver.run import print_profile
from benchmarks.solver.sketch import TOLERANCE

SHAPES = ("tree-2", "tree-3", "tree-4", "tree-5", "tree-6", "row-10", "row-100", "row-1000")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--shapes", type=lambda text: text.split(","), default=list(SHAPES))
    parser.add_argument("--limit", type=float, default=120.0, help="seconds for each measurement")
    parser.add_argument("--runs", type=int, default=3, help="measured runs, after one to warm up")
    parser.add_argument("--one", metavar="SHAPE", help="measure in this process, and print JSON")
    parser.add_argument("--flat", action="store_true", help="with --one: in a single group")
    parser.add_argument("--profile", action="store_true", help="with --one: a profile of one more solve")
    options = parser.parse_args()
    if options.one:
        print(json.dumps(measure(options.one, options.flat, options.runs)))
        if options.profile:
            _profile(options.one, options.flat)
        return
    print("| shape | groups | unknowns | rows | solve ms | MB | flat ms | flat MB |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|")
    for shape in options.shapes:
        problem, _ = assembly(shape)
        sizes = [len(problem.parent), len(problem.initial), len(problem.rows.scale)]
        cells = [shape, *map(str, sizes)]
        for is_flat in (False, True):
            cells += _cells(_in_child(shape, is_flat, options.runs, options.limit))
        print("| " + " | ".join(cells) + " |", flush=True)


def measure(shape: str, is_flat: bool, runs: int) -> dict[str, object]:
    """The median seconds of some solves from nothing, the memory of the first in MB, and what came of it."""
    problem, root = assembly(shape)
    if is_flat:
        problem = flattened(problem)
    gc.collect()
    _forget_peak()
    before, memory, taken = _memory("VmRSS"), 0.0, []
    for run in range(runs + 1):
        gc.disable()
        start = time.perf_counter()
        solution = solve(problem, SETTINGS)
        taken.append(time.perf_counter() - start)
        gc.enable()
        if run == 0:
            memory = _memory("VmHWM") - before
    violation = worst_violation(root, solution.values)
    trouble = "" if violation < TOLERANCE else f"{solution.status}, off by {violation:.1e} mm"
    return {
        "solve": median(taken[1:]),
        "memory": memory,
        "trouble": trouble,
        "changed": len(solution.changed),
    }


def _profile(shape: str, is_flat: bool) -> None:
    problem, _ = assembly(shape)
    with cProfile.Profile() as profile:
        solve(flattened(problem) if is_flat else problem, SETTINGS)
    print_profile(profile)


def _memory(name: str) -> float:
    """Of this process in MB: what it has (`VmRSS`), the most it had since `_forget_peak` (`VmHWM`)."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) / 1024.0 for line in lines if line.startswith(name))


def _forget_peak() -> None:
    Path("/proc/self/clear_refs").write_text("5")


def _in_child(shape: str, is_flat: bool, runs: int, limit: float) -> Mapping[str, object]:
    command = [
        sys.executable,
        __file__,
        "--one",
        shape,
        "--runs",
        str(runs),
        *(["--flat"] if is_flat else []),
    ]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit, check=True)
    except subprocess.TimeoutExpired:
        return {"trouble": f"> {limit:g} s"}
    except subprocess.CalledProcessError as error:
        return {"trouble": f"crashed: {error.stderr.strip().splitlines()[-1]}"}
    found: dict[str, object] = json.loads(done.stdout)
    return found


def _cells(found: Mapping[str, object]) -> list[str]:
    if found["trouble"]:
        return [str(found["trouble"]), "–"]
    return [f"{1000.0 * float(str(found['solve'])):.0f}", f"{float(str(found['memory'])):.0f}"]


if __name__ == "__main__":
    main()
