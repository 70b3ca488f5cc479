"""The loop of a fuzzer: tries what follows from one seed after the other, and ends with 1 if something broke.

What breaks is made small and written to a folder, by its seed: the first of each cause. What is mended moves
from there to `tests/fuzz/programs` or `tests/fuzz/files`, where it stays a test.
"""

from __future__ import annotations

import argparse
import json
import random
import resource
import sys
import time
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from tests.fuzz.minimise import minimised

_MEMORY = 4 << 30
"""Bytes that one program or file and all that is made of it must do with."""
_SMALL = 60.0
"""Seconds for which something smaller is sought that breaks in the same way."""

Found = tuple[str, str]
"""What is alike for findings with one cause, as far as one can tell; and the details."""


def options(about: str | None) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--minutes", type=float, default=2.0)
    parser.add_argument("--programs", type=int, help="so many, in place of a time")
    parser.add_argument("--seed", type=int, help="of the first; the others follow it")
    parser.add_argument("--out", type=Path, default=Path("build/fuzz"), help="where what breaks is kept")
    return parser


def fuzz(
    arguments: argparse.Namespace,
    made: Callable[[int], tuple[str, str]],
    finding: Callable[[str, str, int], Found | None],
    encoding: str = "utf-8",
) -> int:
    """`made` gives the kind and the text of a seed; a kind that begins with a dot is the suffix of a file."""
    first = arguments.seed if arguments.seed is not None else random.SystemRandom().randrange(1 << 32)
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    warnings.simplefilter("error")
    print(f"fuzzing from seed {first}", flush=True)
    tried, causes = Counter[str](), dict[str, list[int]]()
    begin, seed, slowest = time.monotonic(), first, (0.0, 0)
    while (
        seed < first + arguments.programs
        if arguments.programs
        else time.monotonic() < begin + 60 * arguments.minutes
    ):
        kind, text = made(seed)
        tried[kind] += 1
        started = time.process_time()
        found = finding(kind, text, seed)
        slowest = max(slowest, (time.process_time() - started, seed))
        if found is not None:
            causes.setdefault(found[0], []).append(seed)
            if len(causes[found[0]]) == 1:
                _keep(arguments.out, seed, kind, text, found, finding, encoding)
        seed += 1
    told = {
        "seconds": round(time.monotonic() - begin),
        "tried": dict(tried),
        "slowest": {"seconds": round(slowest[0], 1), "seed": slowest[1]},
        "findings": causes,
    }
    print(json.dumps(told, indent=1))
    return 1 if causes else 0


def _keep(
    folder: Path,
    seed: int,
    kind: str,
    text: str,
    found: Found,
    finding: Callable[[str, str, int], Found | None],
    encoding: str,
) -> None:
    def alike(other: str) -> bool:
        again = finding(kind, other, seed)
        return again is not None and again[0] == found[0]

    small = minimised(text, alike, seconds=_SMALL)
    folder.mkdir(parents=True, exist_ok=True)
    suffix = kind if kind.startswith(".") else ".aidl"
    (folder / f"{seed}{suffix}").write_bytes(small.encode(encoding))
    (folder / f"{seed}.txt").write_text("\n\n".join(found), "utf-8")
    print(f"seed {seed}: {found[0]}\n{small[:400]}\n", file=sys.stdout, flush=True)
