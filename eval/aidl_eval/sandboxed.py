"""Runs untrusted Python that draws, by an interpreter that has the library; see `sandbox/lock.py`."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from aidl_eval import rendering, shapes
from aidl_eval.regions import Regions
from aidl_eval.rendering import NOTHING, UNBOUNDED, Rendered
from aidl_lang.common.processes import Guarded, Limit, LimitError, limit_met
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
    if sys.platform == "win32":
        return "programs in Python cannot be locked in on Windows"
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


def _rendered(said: object, seconds: float) -> Rendered:
    """Returns what came of a program; it is strangers' data, and may be anything."""
    why = {
        "time": f"error: the program took longer than {seconds:g} s",
        "memory": f"error: the program took more than {rendering.MEMORY >> 30} GB of memory",
        "death": "error: the program ended its process: it took too much memory, or crashed the library",
    }
    if not isinstance(said, dict):
        return Rendered(errors=(_NOT_DRAWN,))
    if isinstance(kind := said.get("kind"), str) and kind in why:
        return Rendered(errors=(why[kind],))
    if isinstance(errors := said.get("errors"), list) and errors:
        return Rendered(errors=tuple(escape(str(error)[:1000]) for error in errors[:20]))
    try:
        drawn = _drawing().submit(seconds, _regions, *_checked(said)).result()
    except _UnboundedError:
        return Rendered(errors=(UNBOUNDED,))
    except (KeyError, TypeError, ValueError):
        return Rendered(errors=(_NOT_DRAWN,))
    except (LimitError, MemoryError) as error:
        return Rendered(errors=(_MET[limit_met(error) or Limit.DEATH].format(seconds),))
    return Rendered(drawn) if drawn else Rendered(errors=(f"{NOTHING}: hand it to `show_object(…)`",))


_NOT_DRAWN = "error: the program handed over what is no drawing"
_MET = {
    Limit.TIME: "error: working out what is drawn took longer than {:g} s: its outlines cross too often",
    Limit.MEMORY: "error: working out what is drawn took too much memory",
    Limit.DEATH: "error: working out what is drawn ended its process: it took too much memory",
}


@cache
def _drawing() -> Guarded:
    """Returns the process that works out what is drawn: one step of that has no end that could be set."""
    return Guarded(1, __name__, rendering.MEMORY)


class _UnboundedError(Exception):
    """Raised for a coordinate that is too large."""


_Face: TypeAlias = list[Polygon]


def _checked(said: dict[str, Any]) -> tuple[list[list[_Face]], list[Polygon]]:
    """Returns the parts, each its faces by their outlines, and the lines of what a program handed over.
    Raises KeyError and TypeError for all that is not exactly that.
    """
    parts = [[[_points(o) for o in _list(face)] for face in _list(part)] for part in _list(said["parts"])]
    return parts, [_points(line) for line in _list(said["lines"])]


def _list(said: object) -> list[Any]:
    if not isinstance(said, list):
        raise TypeError
    return said


def _points(outline: object) -> Polygon:
    found = [_list(point) for point in _list(outline)]
    if any(len(point) != 2 or type(c) not in (int, float) for point in found for c in point):
        raise TypeError
    if not all(abs(c) < rendering.LARGEST for point in found for c in point):
        raise _UnboundedError
    return np.array(found, float).reshape(-1, 2)


def _regions(given: list[list[_Face]], lines: list[Polygon]) -> Regions:
    parts = [shapes.region([o for face in part for o in _directed(face)], "NonZero") for part in given]
    return Regions(tuple(filter(None, parts)), tuple(_line(line) for line in lines if len(line) > 1))


def _directed(face: _Face) -> Iterator[Polygon]:
    """Yields the outlines of a face, the outer one counter-clockwise and its holes clockwise."""
    for number, outline in enumerate(face):
        if len(outline) > 2:
            is_reversed = (polygon_area(outline) > 0) == bool(number)
            yield outline[::-1] if is_reversed else outline


def _line(points: Polygon) -> tuple[Piece, ...]:
    corners = [(float(x), float(y)) for x, y in points]
    return tuple(Line(a, b) for a, b in pairwise(corners) if a != b)
