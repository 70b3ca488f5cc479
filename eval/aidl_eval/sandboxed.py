"""Runs untrusted Python that draws, by an interpreter that has the library; see `sandbox/lock.py`."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np

from aidl_eval import rendering, shapes, strict
from aidl_eval.regions import Regions
from aidl_eval.rendering import NOTHING, UNBOUNDED, Rendered
from aidl_lang.common.render.excerpt import escape
from aidl_lang.geometry.curves import Line, Piece
from aidl_lang.geometry.region import Polygon, polygon_area

_HOST = Path(__file__).with_name("sandbox") / "host.py"
_START = 60
"""Seconds in which a library must have been loaded."""


def interpreter(library: str) -> str:
    """Returns the interpreter that has a library: that of `AIDL_LIBRARY_PYTHON`, or else this one."""
    return os.environ.get(f"AIDL_{library.upper()}_PYTHON") or sys.executable


@cache
def missing(library: str, python: str) -> str | None:
    """Returns the reason why an interpreter cannot run programs of a library safely; None if it can."""
    variable = f"AIDL_{library.upper()}_PYTHON"
    probe = (
        f"import sys; sys.path.insert(0, {str(_HOST.parent)!r}); import lock; import {library}; "
        "print(lock.has_filter())"
    )
    try:
        done = subprocess.run(
            [python, "-I", "-c", probe],
            capture_output=True,
            text=True,
            timeout=_START,
            stdin=subprocess.DEVNULL,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"`{python}` (of {variable}) cannot be run: {error}"
    if done.returncode:
        said = (done.stderr.strip().splitlines() or ["it ended without a word"])[-1]
        return f"{library} is not there ({said[:200]}): name an interpreter that has it by {variable}"
    if done.stdout.strip() != "True":
        return "programs in Python are run on Linux alone, on x86-64 or ARM64, where they can be locked in"
    return None


def run(library: str, programs: Sequence[str], seconds: float | None = None) -> list[Rendered]:
    """Runs programs one after the other, each within the limits of `rendering`."""
    seconds = rendering.SECONDS if seconds is None else seconds
    request = {
        "library": library,
        "programs": [program.encode("utf-8", "replace").decode() for program in programs],
        "seconds": seconds,
        "memory": rendering.MEMORY,
        "output": rendering.OUTPUT,
    }
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as said:
        process = subprocess.Popen(
            [interpreter(library), "-I", "-B", str(_HOST)],
            cwd=folder,
            env={
                "HOME": folder,
                "PATH": "/usr/bin:/bin",
                "OMP_NUM_THREADS": "1",
                "OPENBLAS_NUM_THREADS": "1",
            },
            stdin=subprocess.PIPE,
            stdout=said,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        try:
            process.communicate(json.dumps(request).encode(), timeout=_START + seconds * len(programs))
        except subprocess.TimeoutExpired:
            pass
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        said.seek(0)
        try:
            found = json.loads(said.read())
        except (ValueError, RecursionError):
            found = [{"kind": "death"}] * len(programs)
    if not isinstance(found, list) or len(found) != len(programs):
        found = [None] * len(programs)
    return [_rendered(each, seconds) for each in found]


_Outline = list[tuple[float, float]]


@dataclass(frozen=True)
class _Said:
    """What a host says of a program: how it ended, or its errors, or parts, each faces by their outlines."""

    kind: str | None = None
    errors: list[str] = field(default_factory=list)
    parts: list[list[list[_Outline]]] = field(default_factory=list)
    lines: list[_Outline] = field(default_factory=list)


def _rendered(data: object, seconds: float) -> Rendered:
    """Returns what came of a program; it is strangers' data, and may be anything."""
    why = {
        "time": f"error: the program took longer than {seconds:g} s",
        "memory": f"error: the program took more than {rendering.MEMORY >> 30} GB of memory",
        "death": "error: the program ended its process: it took too much memory, or crashed the library",
    }
    try:
        said = strict.read(data, _Said)
    except strict.WrongError:
        return Rendered(errors=("error: the program handed over what is no drawing",))
    if said.kind in why:
        return Rendered(errors=(why[said.kind],))
    if said.errors:
        return Rendered(errors=tuple(escape(error[:1000]) for error in said.errors[:20]))
    outlines = [*said.lines, *(outline for part in said.parts for face in part for outline in face)]
    if not all(abs(c) < rendering.LARGEST for outline in outlines for point in outline for c in point):
        return Rendered(errors=(UNBOUNDED,))
    parts = [shapes.region([o for face in part for o in _directed(face)], "NonZero") for part in said.parts]
    drawn = Regions(tuple(filter(None, parts)), tuple(_line(line) for line in said.lines if len(line) > 1))
    return Rendered(drawn) if drawn else Rendered(errors=(f"{NOTHING}: hand it to `show_object(…)`",))


def _directed(face: list[_Outline]) -> Iterator[Polygon]:
    """Yields the outlines of a face, the outer one counter-clockwise and its holes clockwise."""
    for number, corners in enumerate(face):
        if len(corners) > 2:
            outline = np.array(corners, float)
            is_reversed = (polygon_area(outline) > 0) == bool(number)
            yield outline[::-1] if is_reversed else outline


def _line(points: _Outline) -> tuple[Piece, ...]:
    return tuple(Line(a, b) for a, b in pairwise(points) if a != b)
