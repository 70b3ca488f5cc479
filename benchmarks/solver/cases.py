"""Solves test cases in the sketch format and compares with what they expect.

    python benchmarks/solver/cases.py FOLDER [--peers]

`expected` of a case may give points, point_y, circles (radius) and radii, each by index, distances between
two points, and `satisfiable`. A case is

    matched     satisfied, and everything expected is where it should be
    satisfied   satisfied, but another solution than the expected one
    explained   not satisfiable, and a conflict is named
    failed      anything else

A peer is not asked to explain.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.solver.ours import Ours
from benchmarks.solver.race import NAMES, Runner
from benchmarks.solver.sketch import TOLERANCE, Evaluator, Floats, Sketch, load

EXPECTED = 1e-4
"""How exactly expected values are given, in millimetres."""
LIMIT = 20.0


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--peers", action="store_true", help="the peers as well, in one line each")
    options = parser.parse_args()
    try:
        cases = [load(path) for path in sorted(options.folder.glob("*.json"))]
    except ValueError as error:
        parser.error(str(error))
    if not cases:
        parser.error(f"no *.json in {options.folder}")
    verdicts = Counter[str]()
    for sketch in cases:
        verdict, why = judge_ours(sketch)
        verdicts[verdict] += 1
        print(f"{verdict:10} {sketch.name}{': ' + why if why else ''}")
    print(f"\nours: {_summary(verdicts)}, of {len(cases)}")
    if options.peers:
        for name in NAMES:
            with Runner(name, LIMIT) as runner:
                print(f"{name}: {'MISSING' if runner.missing else _summary(_judge_peer(runner, cases))}")
    return 1 if verdicts["failed"] else 0


def _summary(verdicts: Counter[str]) -> str:
    return ", ".join(f"{count} {verdict}" for verdict, count in sorted(verdicts.items()))


def judge_ours(sketch: Sketch) -> tuple[str, str]:
    """The verdict, and details for all but the plain good ones."""
    ours = Ours()
    built = ours.build(sketch)
    ours.solve(built)
    assert built.solution is not None
    if not sketch.expected.get("satisfiable", True):
        stated = [c["t"] for c in sketch.constraints]
        named = [[stated[i] for i in f.conflict if i < len(stated)] for f in built.solution.failures]
        explained = any(named) and not all(built.solution.satisfied)
        return ("explained" if explained else "failed"), f"in conflict: {named}"
    return judge(sketch, built.solution.values)


def judge(sketch: Sketch, x: Floats) -> tuple[str, str]:
    """Whether these values satisfy a sketch, and are the expected ones."""
    residual, worst = Evaluator(sketch).worst(x)
    if not residual < TOLERANCE:
        return "failed", f"{worst} off by {residual:.1e}"
    off = max(_deviations(sketch, x), default=0.0)
    return ("matched", "") if off < EXPECTED else ("satisfied", f"{off:.3g} mm from what is expected")


def _deviations(sketch: Sketch, x: Floats) -> Iterator[float]:
    """How far each expected number is off."""
    expected, places = sketch.expected, x[: 2 * len(sketch.points)].reshape(-1, 2)
    radii = x[2 * len(sketch.points) :]
    for index, place in expected.get("points", {}).items():
        yield float(np.abs(places[int(index)] - place).max())
    for index, y in expected.get("point_y", {}).items():
        yield abs(float(places[int(index), 1]) - y)
    for index, circle in expected.get("circles", {}).items():
        yield abs(float(radii[int(index)]) - circle["radius"])
    for index, radius in expected.get("radii", {}).items():
        yield abs(float(radii[int(index)]) - radius)
    for a, b, distance in expected.get("distances", ()):
        yield abs(math.dist(places[a], places[b]) - distance)


def _judge_peer(runner: Runner, cases: list[Sketch]) -> Counter[str]:
    verdicts = Counter[str]()
    with TemporaryDirectory() as folder:
        path = Path(folder) / "case.json"
        for index, sketch in enumerate(cases):
            if sketch.expected.get("satisfiable", True):
                sketch.save(path := path.with_name(f"{index}.json"))
                answer = runner.run(path, Evaluator(sketch))
                if answer.trouble:
                    verdicts["unsupported" if answer.trouble.startswith("unsupported") else "failed"] += 1
                else:
                    verdicts[judge(sketch, np.array(answer.x))[0]] += 1
    return verdicts


if __name__ == "__main__":
    sys.exit(main())
