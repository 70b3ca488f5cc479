"""The table of docs/performance.md: AIDL's solver and its peers on the same sketches, in the same run.

python benchmarks/solver/run.py                             everyone, everything: takes a while
python benchmarks/solver/run.py --families chain --sizes 10,100 --peers ezpz,slvs
python benchmarks/solver/run.py --ours chain 1000           ours alone, in this process
python benchmarks/solver/run.py --ours chain 1000 --profile    … and where its time goes
"""

from __future__ import annotations

import argparse
import cProfile
import gc
import os
import platform
import pstats
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from datetime import date
from itertools import pairwise
from pathlib import Path
from statistics import median

import numpy as np
import scipy

from benchmarks.solver.families import FAMILIES, NOISE, SIZES
from benchmarks.solver.install_peers import DEFAULT
from benchmarks.solver.ours import Ours
from benchmarks.solver.race import NAMES, OURS, Runner, Times, race
from benchmarks.solver.sketch import Evaluator, Sketch

Results = dict[tuple[str, int], tuple[int, Mapping[str, Times]]]
"""By family and size, the number of unknowns and everyone's times."""


def main() -> None:
    options = _options()
    if options.ours:
        family, unknowns = options.ours
        sketch, _ = FAMILIES[family].sketch(
            FAMILIES[family].size_for(int(unknowns)), options.seed, options.noise
        )
        measure_ours(sketch, options.runs, options.profile)
        return
    results, runners = _race_all(options)
    print_machine(runners)
    _print_times(results, runners)
    _print_growth(results)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    listed = lambda text: text.split(",")  # noqa: E731
    parser.add_argument("--families", type=listed, default=list(FAMILIES), help=f"of {', '.join(FAMILIES)}")
    parser.add_argument("--sizes", type=listed, default=SIZES, help="unknowns, about")
    parser.add_argument("--peers", type=listed, default=list(NAMES), help=f"of {', '.join(NAMES)}")
    parser.add_argument("--peers-folder", type=Path, default=DEFAULT, help="where install_peers.py put them")
    parser.add_argument("--runs", type=int, default=7, help="measured runs, after one to warm up")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for one run")
    parser.add_argument("--budget", type=float, default=60.0, help="seconds after which no run is added")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--noise", type=float, default=NOISE, help="of the feature size")
    parser.add_argument("--ours", nargs=2, metavar=("FAMILY", "UNKNOWNS"), help="ours alone")
    parser.add_argument("--profile", action="store_true", help="with --ours: a profile of one solve")
    options = parser.parse_args()
    families = [options.ours[0]] if options.ours else options.families
    for name, known in ((f, FAMILIES) for f in families):
        if name not in known:
            parser.error(f"no family {name}; there are {', '.join(known)}")
    for name in options.peers:
        if name not in (*NAMES, ""):
            parser.error(f"no peer {name}; there are {', '.join(NAMES)}")
    for size in [options.ours[1]] if options.ours else options.sizes:
        if not str(size).isdigit() or int(size) < 1:
            parser.error(f"{size} is no number of unknowns")
    return options


# ---- ours alone -----------------------------------------------------------------------------------------


def measure_ours(sketch: Sketch, runs: int, is_profiled: bool) -> None:
    """Build and solve in this process, one line for each run, and a profile of one solve if asked."""
    ours, evaluator = Ours(), Evaluator(sketch)
    print(f"{sketch.name}: {sketch.unknowns} unknowns, {evaluator.equations} equations")
    taken: list[float] = []
    for _ in range(runs):
        gc.collect()
        gc.disable()
        start = time.perf_counter()
        built = ours.build(sketch)
        middle = time.perf_counter()
        said = ours.solve(built)
        end = time.perf_counter()
        gc.enable()
        taken.append(end - middle)
        residual, worst = evaluator.worst(np.array(ours.read(built)))
        print(
            f"build {1000 * (middle - start):9.2f} ms   solve {1000 * taken[-1]:9.2f} ms   "
            f"{said}, largest residual {residual:.1e} ({worst})",
            flush=True,
        )
        if sum(taken) > 60.0:
            break
    print(f"median solve {1000 * median(taken):.2f} ms, fastest {1000 * min(taken):.2f} ms")
    if is_profiled:
        built = ours.build(sketch)
        with cProfile.Profile() as profile:
            ours.solve(built)
        print_profile(profile)


def print_profile(profile: cProfile.Profile) -> None:
    for order in ("cumulative", "tottime"):
        pstats.Stats(profile, stream=sys.stdout).strip_dirs().sort_stats(order).print_stats(25)


# ---- everyone -------------------------------------------------------------------------------------------


def _race_all(options: argparse.Namespace) -> tuple[Results, list[Runner]]:
    """A peer that fails at one size of a family does not start at larger ones."""
    results: Results = {}
    with ExitStack() as stack:
        names = [OURS, *(name for name in options.peers if name)]
        runners = [stack.enter_context(Runner(name, options.limit, options.peers_folder)) for name in names]
        for family in options.families:
            out: set[str] = set()
            for unknowns in sorted(map(int, options.sizes)):
                racing = [runner for runner in runners if runner.name not in out]
                size = FAMILIES[family].size_for(unknowns)
                sketch, _ = FAMILIES[family].sketch(size, options.seed, options.noise)
                times = race(racing, sketch, options.runs, options.budget)
                results[family, unknowns] = (sketch.unknowns, times)
                out |= {name for name, taken in times.items() if taken.trouble and name != OURS}
                print(f"{family} {sketch.unknowns} measured", file=sys.stderr)
    return results, runners


def print_machine(runners: Sequence[Runner]) -> None:
    """What the numbers depend on."""
    print(f"{date.today()}, {_processor()}, {os.cpu_count()} cores, {platform.system()}, one thread each.")
    print(f"Python {platform.python_version()}, NumPy {np.__version__}, SciPy {scipy.__version__}.")
    said = (f"{r.name} {'MISSING (' + r.missing + ')' if r.missing else r.version}" for r in runners)
    print(", ".join(said) + ".\n")


def _processor() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else ():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def _print_times(results: Results, runners: Sequence[Runner]) -> None:
    peers = [runner.name for runner in runners if runner.name != OURS]
    print("Median ms to solve; in brackets how many times as long ours takes.\n")
    _print_row(["family", "unknowns", "**AIDL**", *peers])
    print("|---|--:|" + "--:|" * (len(peers) + 1))
    for (family, _), (unknowns, times) in results.items():
        ours = times[OURS]
        cells = [ours.trouble or f"**{_ms(ours.solve)}**"]
        _print_row([family, str(unknowns), *cells, *(_solve_cell(times.get(name), ours) for name in peers)])
    print(
        "\nMedian ms to build the problem from the sketch, and for ours to count degrees of freedom after.\n"
    )
    _print_row(["family", "unknowns", "**AIDL**", "degrees", *peers])
    print("|---|--:|" + "--:|" * (len(peers) + 2))
    for (family, _), (unknowns, times) in results.items():
        degrees = times[OURS].analyse
        cells = [_build_cell(times.get(OURS)), _ms(degrees) if degrees is not None else "–"]
        _print_row([family, str(unknowns), *cells, *(_build_cell(times.get(name)) for name in peers)])
    print()


def _print_row(cells: Sequence[str]) -> None:
    print("| " + " | ".join(cells) + " |")


def _solve_cell(times: Times | None, ours: Times) -> str:
    if times is None:
        return "–"
    if times.trouble or ours.trouble:
        return times.trouble or _ms(times.solve)
    ratio = ours.solve / times.solve
    return f"{_ms(times.solve)} ({ratio:.0f})" if ratio >= 10.0 else f"{_ms(times.solve)} ({ratio:.2g})"


def _build_cell(times: Times | None) -> str:
    return "–" if times is None or times.trouble else _ms(times.build)


def _ms(seconds: float) -> str:
    """Three digits, no exponent."""
    value = 1000.0 * seconds
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def _print_growth(results: Results) -> None:
    """The exponent of ours: the slope of log time over log unknowns, from one size to the next."""
    print("How our time to solve grows with the unknowns: the exponent from one size to the next.\n")
    _print_row(["family", "from", "to", "exponent"])
    print("|---|--:|--:|--:|")
    for family in dict.fromkeys(family for family, _ in results):
        points = [
            (unknowns, times[OURS].solve)
            for (name, _), (unknowns, times) in results.items()
            if name == family and not times[OURS].trouble
        ]
        for (n, t), (m, u) in pairwise(points):
            _print_row([family, str(n), str(m), f"{np.log(u / t) / np.log(m / n):.2f}"])


if __name__ == "__main__":
    main()
