"""How far off a start may be: 10 seeds × noise of 0.1, 0.3, 0.6 and 1 times the feature size × the families,
at about 100 unknowns; 120 sketches for each contestant.

    python benchmarks/solver/robust.py [--peers] [--limit SECONDS]

A sketch counts when the judge is content with the result, whatever the contestant says.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.solver.families import FAMILIES
from benchmarks.solver.race import NAMES, OURS, Runner
from benchmarks.solver.sketch import Evaluator

UNKNOWNS = 100
NOISES = (0.1, 0.3, 0.6, 1.0)
SEEDS = range(100, 110)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--peers", action="store_true", help="everyone, not ours alone")
    parser.add_argument("--limit", type=float, default=10.0, help="seconds for one sketch")
    options = parser.parse_args()
    columns = [(family, noise) for family in FAMILIES for noise in NOISES]
    print("| solver | " + " | ".join(f"{family} {noise:g}" for family, noise in columns) + " | of 120 |")
    print("|---" + "|--:" * (len(columns) + 1) + "|")
    for name in (OURS, *NAMES) if options.peers else (OURS,):
        with Runner(name, options.limit) as runner:
            if runner.missing:
                print(f"| {name} | MISSING: {runner.missing} |")
                continue
            counts = [_solved(runner, family, noise) for family, noise in columns]
        print(f"| {name} | " + " | ".join(map(str, counts)) + f" | {sum(counts)} |", flush=True)


def _solved(runner: Runner, family: str, noise: float) -> int:
    """How many of the seeds are solved."""
    count, size = 0, FAMILIES[family].size_for(UNKNOWNS)
    with TemporaryDirectory() as folder:
        for seed in SEEDS:
            sketch, _ = FAMILIES[family].sketch(size, seed, noise)
            path = Path(folder) / f"{seed}.json"
            sketch.save(path)
            count += runner.run(path, Evaluator(sketch)).is_solved
    return count


if __name__ == "__main__":
    main()
