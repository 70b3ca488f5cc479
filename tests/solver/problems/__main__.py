"""`python -m tests.solver.problems FILE` solves one problem file.

Exit codes: 0 solved, 1 not solved, 2 the file cannot be read or is wrong.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from io import TextIOWrapper
from typing import Any

from aidl_lang.solver import Solution, Status, solve
from aidl_lang.solver.analysis import analyse
from tests.solver.problems.form import LONGEST_FILE, Case, FormError, read


def main(argv: Sequence[str] | None = None) -> int:
    """Runs the command line; wrong use of options raises `SystemExit(2)`."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    arguments = _parser().parse_args(argv)
    try:
        with open(arguments.file, encoding="utf-8") as file:
            case = read(file.read(LONGEST_FILE + 1))
    except FormError as mistake:
        return _refuse(arguments.file, str(mistake))
    except UnicodeDecodeError as mistake:
        return _refuse(arguments.file, f"byte {mistake.start} is not UTF-8")
    except OSError as mistake:
        return _refuse(arguments.file, mistake.strerror or str(mistake))
    solution, seconds = _timed(case, arguments.repeat or 1)
    told = _told(case, solution)
    if arguments.stages:
        told["stages"] = _stages(case, solution)
    if arguments.repeat:
        told["seconds"] = seconds
    text = json.dumps(told, indent=2, allow_nan=False) if arguments.json else "\n".join(_lines(told))
    sys.stdout.write(text + "\n")
    return 0 if solution.status is Status.SOLVED else 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m tests.solver.problems",
        description="Solves a problem file (tests/solver/problems/README.md).",
        epilog="Exit codes: 0 solved, 1 not solved, 2 the file cannot be read or is wrong.",
    )
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--stages", action="store_true", help="tell what was tried, in order")
    parser.add_argument("--repeat", type=_count, metavar="N", help="solve N times and tell the median time")
    return parser


def _count(text: str) -> int:
    count = int(text)
    if count < 1:
        raise argparse.ArgumentTypeError("at least once")
    return count


def _refuse(file: str, reason: str) -> int:
    sys.stderr.write(f"{file}: {reason}\n")
    return 2


def _timed(case: Case, times: int) -> tuple[Solution, float]:
    """Returns the solution, and the median of the seconds that it took."""
    seconds = []
    for _ in range(times):
        start = time.perf_counter()
        solution = solve(case.problem)
        seconds.append(time.perf_counter() - start)
    return solution, statistics.median(seconds)


def _told(case: Case, solution: Solution) -> dict[str, Any]:
    """Returns a solution as plain values for JSON; a residual that is not finite is None."""
    names, freedom = case.problem.names, analyse(case.problem, solution)

    def tags(indices: Iterable[int]) -> list[str]:
        return [case.tags[index] for index in indices]

    return {
        "status": str(solution.status),
        "degrees": freedom.degrees,
        "values": dict(zip(names, solution.values.tolist(), strict=True)),
        "constraints": [
            {"tag": tag, "holds": holds, "residual": residual if math.isfinite(residual) else None}
            for tag, holds, residual in zip(case.tags, solution.satisfied, solution.residuals, strict=True)
        ],
        "changed": [names[unknown] for unknown in solution.changed],
        "redundant": tags(found.constraint for found in freedom.redundant),
        "failures": [
            {
                "group": case.groups[failure.group],
                "reason": str(failure.reason),
                "conflict": tags(failure.conflict),
                "minimal": failure.minimal,
            }
            for failure in solution.failures
        ],
    }


def _stages(case: Case, solution: Solution) -> list[dict[str, Any]]:
    return [
        {
            "group": case.groups[stage.group],
            "stage": stage.stage,
            "unknowns": stage.unknowns,
            "rows": stage.rows,
            "succeeded": stage.succeeded,
        }
        for stage in solution.stages
    ]


def _lines(told: dict[str, Any]) -> Iterator[str]:
    """Yields the lines of the report for people."""
    yield told["status"]
    if told["degrees"] is not None:
        yield f"degrees of freedom: {told['degrees']}"
    yield from (f"  {name} = {value:.12g}" for name, value in told["values"].items())
    for c in told["constraints"]:
        residual = "no value" if c["residual"] is None else f"residual {c['residual']:.3g}"
        yield f"{c['tag']}: {'holds' if c['holds'] else 'does not hold'}, {residual}"
    if told["changed"]:
        yield f"sizes that changed: {', '.join(told['changed'])}"
    if told["redundant"]:
        yield f"redundant: {', '.join(told['redundant'])}"
    for failure in told["failures"]:
        which = "no fewer than" if failure["minimal"] else "somewhere among"
        yield f"{failure['group']} failed, {failure['reason']}: {which} {', '.join(failure['conflict'])}"
    for s in told.get("stages", ()):
        end = "succeeded" if s["succeeded"] else "failed"
        yield f"{s['group']}, {s['stage']}: {end} with {s['unknowns']} unknowns and {s['rows']} rows"
    if "seconds" in told:
        yield f"median time: {told['seconds'] * 1000:.3f} ms"


if __name__ == "__main__":
    sys.exit(main())
