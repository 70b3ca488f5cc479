"""End-to-end measurements: the cold command beside its named peers, the warm compile, each stage, and the
standard library.

    python benchmarks/run.py [--runs N] [PROGRAM]

Prints Markdown. All figures are medians after a warm-up; peers run in turn with the command, so that a busy
moment of the machine meets all of them.
"""

from __future__ import annotations

import argparse
import gc
import os
import platform
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from statistics import median, quantiles

from aidl_lang import pipeline
from aidl_lang.checking import library
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld

ROOT = Path(__file__).resolve().parent.parent
TELEPHONE = ROOT / "examples" / "telephone.aidl"
GALLERY = ROOT / "examples" / "gallery"
STAGES = ("interpret", "solve", "regions")
"""Those that take most of the time."""


def main() -> None:
    parser = argparse.ArgumentParser(description="Measure AIDL from end to end.")
    parser.add_argument("program", nargs="?", type=Path, default=TELEPHONE)
    parser.add_argument("--runs", type=int, default=15, help="runs of each measurement (default 15)")
    arguments = parser.parse_args()
    runs = max(3, arguments.runs)
    print(f"{machine()}. Medians of {runs} runs, with quartiles.\n")
    print_cold(arguments.program, runs)
    print_warm(arguments.program, runs)
    print_library(runs)
    print_gallery(runs)


def machine() -> str:
    """The machine in a line."""
    cpu = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [
            line.partition(":")[2].strip() for line in info.read_text().splitlines() if "model name" in line
        ]
        cpu = names[0] if names else cpu
    return f"{cpu}, {os.cpu_count()} cores, {platform.system()}, Python {platform.python_version()}"


def print_cold(program: Path, runs: int) -> None:
    """Whole processes, from start to exit."""
    with tempfile.TemporaryDirectory() as folder:
        output = str(Path(folder) / "out.svg")
        compile_it = ["-m", "aidl_lang", "compile", str(program), "--quiet", "-o", output]
        commands = {
            "`python -c pass` (peer)": ["-c", "pass"],
            '`python -c "import numpy"` (peer)': ["-c", "import numpy"],
            "`aidl --version`": ["-m", "aidl_lang", "--version"],
            f"`aidl check --no-solve {program.name}`": [
                "-m",
                "aidl_lang",
                "check",
                "--no-solve",
                str(program),
            ],
            f"`aidl compile {program.name}`": compile_it,
        }
        _print_table("process", sample({name: partial(_process, c) for name, c in commands.items()}, runs))


def print_warm(program: Path, runs: int) -> None:
    """Compiles within one process, and the stages they consist of."""
    source = SourceFile(program.name, program.read_text(encoding="utf-8"))
    world = DiskWorld(program.resolve().parent)
    stages: dict[str, list[float]] = {}

    def compile_it() -> None:
        compiled = pipeline.compile(source, world)
        for stage, seconds in compiled.timings.items():
            stages.setdefault(stage, []).append(seconds)

    compiled = pipeline.compile(source, world)
    calls = {"compile": compile_it, "export to SVG": lambda: compiled.export(".svg")}
    times = sample(calls, runs)
    parts = {f"- {stage}": taken[1:] for stage, taken in stages.items()}
    _print_table(f"{program.name}, warm", {"compile": times.pop("compile"), **parts, **times})


def print_library(runs: int) -> None:
    """Building the standard library, opening it and decoding it, and its size."""
    names = library.load().callables
    count = sum(len(overloads) for overloads in names.values())
    text = sum(len(source.text.encode()) for source in library.load().sources)
    calls: dict[str, Callable[[], object]] = {
        "built: parsed and turned into data": library.built,
        "opened": library.load.__wrapped__,
        "opened, every definition decoded": _decode_all,
    }
    gc.disable()  # as while a program is compiled
    try:
        _print_table("library", sample(calls, runs))
    finally:
        gc.enable()
    print(
        f"The library has {count} definitions of {len(names)} names in {text} bytes of text; "
        f"as data it has {len(library.built())} bytes."
    )


def print_gallery(runs: int) -> None:
    """Prints what the programs of the gallery take, compiled anew in a process that goes on."""
    print(f"| gallery, warm | compile | {' | '.join(STAGES)} |\n|---|" + "---:|" * (1 + len(STAGES)))
    rows = []
    for path in sorted(GALLERY.glob("*.aidl")):
        source, taken = SourceFile(path.name, path.read_text("utf-8")), []
        for _ in range(runs + 1):
            start = time.perf_counter()
            stages = pipeline.compile(source).timings
            taken.append((time.perf_counter() - start, *(stages.get(stage, 0.0) for stage in STAGES)))
        rows.append(tuple(map(median, zip(*taken[1:], strict=True))))
        print(f"| {path.stem} | {' | '.join(map(_milliseconds, rows[-1]))} |")
    print(
        f"| *median* | {' | '.join(_milliseconds(median(column)) for column in zip(*rows, strict=True))} |\n"
    )


def _decode_all() -> None:
    for overloads in library.load.__wrapped__().callables.values():
        for overload in overloads:
            assert overload.node


def sample(calls: Mapping[str, Callable[[], object]], runs: int) -> dict[str, list[float]]:
    """Seconds of each call, taken in turn, the first round thrown away."""
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(runs + 1):
        for name, call in calls.items():
            start = time.perf_counter()
            call()
            times[name].append(time.perf_counter() - start)
    return {name: taken[1:] for name, taken in times.items()}


def _process(command: list[str]) -> None:
    # With bytecode kept, as in every installation: the first round writes it, and is thrown away.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    subprocess.run([sys.executable, *command], check=True, capture_output=True, env=environment)


def _print_table(title: str, times: dict[str, list[float]]) -> None:
    print(f"| {title} | median | quartiles |\n|---|---:|---:|")
    for name, taken in times.items():
        low, _, high = quantiles(taken, n=4)
        print(f"| {name} | {_milliseconds(median(taken))} | {_milliseconds(low)} – {_milliseconds(high)} |")
    print()


def _milliseconds(seconds: float) -> str:
    return f"{1000 * seconds:.1f} ms"


if __name__ == "__main__":
    main()
