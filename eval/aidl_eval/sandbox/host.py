"""Runs programs one after the other, each in a locked copy of this process that has its library loaded.

Reads a request as JSON from its input: `library`, `programs`, `seconds`, `memory`, `output`. Writes one
result for each program, as JSON. A program is exec'd in the copy alone; the host sees only what it wrote.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import json
import math
import os
import signal
import sys
import tempfile
import time
import traceback
from typing import Any

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import drawn
import lock

_MODULES = (
    "math cmath random itertools functools operator collections collections.abc dataclasses typing enum copy "
    "string re fractions decimal statistics bisect heapq numbers abc types warnings contextlib textwrap "
    "linecache tokenize encodings.idna colorsys time datetime numpy numpy.linalg json"
).split()
_FILE = "<program>"
_LONGEST = 300


def main() -> None:
    request = json.load(sys.stdin)
    lock.leave_network()
    allowed = _load(request["library"])
    if isinstance(allowed, str):
        json.dump([{"errors": [allowed], "kind": "missing"}] * len(request["programs"]), sys.stdout)
        return
    found = [_run(request, program, allowed) for program in request["programs"]]
    json.dump(found, sys.stdout)


def _load(library: str) -> frozenset[str] | str:
    """Returns the names of what programs may import; a reason if the library is not there."""
    try:
        importlib.import_module(library)
    except ImportError as error:
        return f"{library} cannot be imported: {error}"
    drawn.warm_up(library)
    for name in _MODULES:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    return frozenset({library, *(name.partition(".")[0] for name in _MODULES)}) - {"linecache", "tokenize"}


def _run(request: dict[str, Any], program: str, allowed: frozenset[str]) -> dict[str, Any]:
    with tempfile.TemporaryFile() as result:
        child = os.fork()
        if child == 0:
            try:
                _child(request, program, allowed, result.fileno())
            finally:
                os._exit(1)
        status = _wait(child, request["seconds"])
        if status is None:
            return {"errors": [], "kind": "time"}
        result.seek(0)
        try:
            said = json.loads(result.read(request["output"]))
        except (ValueError, RecursionError):
            said = None
    if isinstance(said, dict):
        return said
    late = os.WIFSIGNALED(status) and os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL)
    return {"errors": [], "kind": "time" if late else "death"}


def _wait(child: int, seconds: float) -> int | None:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return status
        time.sleep(0.01)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return None


def _child(request: dict[str, Any], program: str, allowed: frozenset[str], result: int) -> None:
    os.dup2(result, 1)
    os.closerange(2, 4096)
    sys.stdin = sys.stdout = sys.stderr = io.StringIO()
    lock.lock(request["memory"], math.ceil(request["seconds"]), request["output"])
    try:
        said = _executed(request["library"], program, allowed)
        data = json.dumps(said, allow_nan=False).encode()
    except MemoryError:
        data = b'{"errors": [], "kind": "memory"}'
    except ValueError:
        data = b'{"errors": ["error: a coordinate is not a finite number"]}'
    while data:
        data = data[os.write(1, data) :]
    os._exit(0)


class _Imports:
    """Refuses to import what is not loaded, with a word about what is."""

    def __init__(self, allowed: frozenset[str]) -> None:
        self.allowed = allowed

    def find_spec(self, name: str, path: object = None, target: object = None) -> None:
        if name.partition(".")[0] not in self.allowed:
            listed = ", ".join(sorted(self.allowed))
            raise ImportError(f"`{name}` cannot be imported here; there are {listed}")


def _executed(library: str, program: str, allowed: frozenset[str]) -> dict[str, Any]:
    shown: list[Any] = []

    def show_object(shape: Any, *about: Any, **more: Any) -> Any:
        shown.append(shape)
        return shape

    names: dict[str, Any] = {"__name__": "__main__", "show_object": show_object, "show": show_object}
    sys.meta_path.insert(0, _Imports(allowed))
    try:
        exec(compile(program, _FILE, "exec"), names)
        if not shown and (result := names.get("result")) is not None:
            shown.append(result)
        found: dict[str, Any] = drawn.collected(shown)
        return found
    except MemoryError:
        raise
    except drawn.NotFlat as reason:
        return {"errors": [f"error: {reason}"]}
    except BaseException as error:  # noqa: BLE001 (a program may raise anything)
        return {"errors": [_told(error)]}


def _told(error: BaseException) -> str:
    if isinstance(error, SyntaxError) and error.filename == _FILE:
        line, said = error.lineno, error.msg
    else:
        frames = [f for f in traceback.extract_tb(error.__traceback__, limit=200) if f.filename == _FILE]
        line, said = (frames[-1].lineno if frames else None), str(error)
    place = f" (line {line})" if line else ""
    said = " ".join(said.split())[:_LONGEST]
    return f"error{place}: {type(error).__name__}" + (f": {said}" if said else "")


if __name__ == "__main__":
    main()
