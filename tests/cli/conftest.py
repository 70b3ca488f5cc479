"""Running the command line within the test's own process, in a folder of its own."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from aidl_lang.cli import main

GOOD = """\
/// How wide the plate is.
param width = 40 in 20..200 step 5

solid plate {
    edge = rectangle(center: origin, width: width, height: 20)
}
"""
WRONG = "solid plate {\n    edge = rectangle(center: origin, width: wdth, height: 20)\n}\n"
UNSOLVABLE = """\
solid plate {
    edge = circle(center: origin, radius: 5)
    constrain edge.radius == 6
    constrain edge.radius == 7
}
"""


@dataclass(frozen=True)
class Result:
    code: int
    out: str
    err: str


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty working directory with three programs in it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("NO_COLOR", "1")
    for name, text in (("good", GOOD), ("wrong", WRONG), ("unsolvable", UNSOLVABLE)):
        (tmp_path / f"{name}.aidl").write_text(text)
    return tmp_path


@pytest.fixture
def aidl(
    folder: Path, capsysbinary: pytest.CaptureFixture[bytes], monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Result]:
    """`aidl("check", "good.aidl")` runs the command; `stdin` is what it may read."""

    def run(*arguments: str, stdin: str = "") -> Result:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(stdin.encode())))
        try:
            code = main(arguments)
        except SystemExit as stop:
            code = int(stop.code or 0)
        out, err = capsysbinary.readouterr()
        return Result(code, out.decode(), err.decode())

    return run
