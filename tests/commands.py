"""The command line within the test's own process."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from aidl_lang.tools.cli import main


@dataclass(frozen=True)
class Result:
    code: int
    out: str
    err: str


Aidl = Callable[..., Result]
"""The fixture `aidl`."""


@pytest.fixture
def aidl(folder: Path, capsysbinary: pytest.CaptureFixture[bytes], monkeypatch: pytest.MonkeyPatch) -> Aidl:
    """`aidl("check", "good.aidl")` runs the command in `folder`; `stdin` is what it may read."""

    def run(*arguments: str, stdin: str = "") -> Result:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(stdin.encode())))
        try:
            code = main(arguments)
        except SystemExit as stop:
            code = int(stop.code or 0)
        out, err = capsysbinary.readouterr()
        return Result(code, out.decode(), err.decode())

    return run
