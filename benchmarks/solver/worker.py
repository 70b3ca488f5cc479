"""One solver in a process of its own: each line on standard input is the path of a sketch, each on standard
output what came of it, as JSON:

    {"version": …} or {"missing": why}                              once, at the start
    {"build": s, "solve": s, "analyse": s, "said": …, "x": […]}     seconds; `analyse` only if there is such
    {"unsupported": type}                                           a type of constraint it does not have

A quick sketch is solved over and over for some 50 ms, each time from nothing, and the medians are reported:
the first run after a pause finds every cache cold. Whatever goes wrong ends the process, with a traceback on
standard error.
"""

from __future__ import annotations

import gc
import json
import os
import sys
import time
from functools import lru_cache
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks.solver.contestant import Contestant, UnsupportedError
from benchmarks.solver.sketch import Sketch, load

TURN = 0.05
"""Seconds for which a quick sketch is solved again and again."""

_load = lru_cache(maxsize=1)(load)


def main() -> None:
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # native libraries may print: that is no answer

    def say(answer: dict[str, object]) -> None:
        print(json.dumps(answer), file=answers, flush=True)

    try:
        contestant = _contestant(sys.argv[1])
    except ImportError as error:
        say({"missing": str(error)})
        return
    say({"version": contestant.version})
    for line in sys.stdin:
        say(_run(contestant, Path(line.rstrip("\n"))))


def _contestant(name: str) -> Contestant:
    if name == "ours":
        from benchmarks.solver.ours import Ours

        return Ours()
    from benchmarks.solver.peers import PEERS

    return PEERS[name]()


def _run(contestant: Contestant, path: Path) -> dict[str, object]:
    """As AIDL compiles: without pauses to collect garbage."""
    sketch = _load(path)
    taken: list[dict[str, float]] = []
    gc.collect()
    gc.disable()
    try:
        start = time.perf_counter()
        while not taken or time.perf_counter() - start < TURN:
            times, said, built = _once(contestant, sketch)
            taken.append(times)
    except UnsupportedError as unsupported:
        return {"unsupported": str(unsupported)}
    finally:
        gc.enable()
    warm = taken[1:] or taken
    medians = {stage: median(times[stage] for times in warm) for stage in taken[0]}
    return {**medians, "said": said, "x": contestant.read(built)}


def _once(contestant: Contestant, sketch: Sketch) -> tuple[dict[str, float], str, Any]:
    times = {}
    start = time.perf_counter()
    built = contestant.build(sketch)
    times["build"] = time.perf_counter() - start
    start = time.perf_counter()
    said = contestant.solve(built)
    times["solve"] = time.perf_counter() - start
    start = time.perf_counter()
    if contestant.analyse(built):
        times["analyse"] = time.perf_counter() - start
    return times, said, built


if __name__ == "__main__":
    main()
