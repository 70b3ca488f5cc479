"""The command as a process of its own: what only shows there."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from tests.commands import Aidl, Result
from tests.documents import ROOT

COMMAND = [sys.executable, "-m", "aidl_lang"]


@pytest.fixture(autouse=True)
def _package_is_found_from_anywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT))


def test_installed_command_compiles(folder: Path) -> None:
    command = Path(sys.executable).parent / "aidl"
    if not command.exists():
        pytest.skip("the package is not installed here")
    subprocess.run([command, "compile", "good.aidl"], check=True, timeout=60)
    assert (folder / "good.svg").exists()


def loaded_by(*commands: str) -> set[str]:
    """The modules that are loaded when commands have ended."""
    code = """
import contextlib, sys
from aidl_lang.tools.cli import main
for command in sys.argv[1:]:
    with contextlib.suppress(SystemExit):
        assert main(command.split()) == 0
print(*sys.modules, file=sys.stderr)
"""
    words = [sys.executable, "-c", code, *commands]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=True)
    return set(done.stderr.splitlines()[-1].split())


PACKAGES = {"lark", "manifold3d", "numpy", "rich", "scipy", "svgwrite", "watchfiles"}
STAGES = {
    f"aidl_lang.{name}"
    for name in ("syntax", "checking", "building", "solver", "geometry", "export", "parser", "pipeline")
}
MOST_LOADED = 110
"""Modules of this package that the way from a text to its picture takes."""
WEB = {"email", "http", "socket", "ssl", "urllib.request"}


def test_what_draws_nothing_loads_no_stage() -> None:
    loaded = loaded_by("--help", "--version", "compile --help", "explain")
    assert (PACKAGES | STAGES | WEB) & loaded == set()


def test_what_solves_nothing_loads_no_solver(folder: Path) -> None:
    (folder / "plain.aidl").write_text("solid plate {\n    edge = circle(radius: 5)\n}\n")
    solving = {"aidl_lang.solver.hierarchy", "aidl_lang.geometry.drawing", "aidl_lang.export"}
    loaded = loaded_by("params plain.aidl", "fmt --check plain.aidl")
    assert ((PACKAGES - {"lark"}) | WEB | solving) & loaded == set()


def test_a_program_that_is_right_loads_nothing_that_explains(folder: Path) -> None:
    """What is said where something is wrong, moves or gives way is loaded there; of the packages, what the
    drawing takes.
    """
    example = Path(__file__).parents[2] / "examples" / "telephone.aidl"
    loaded = loaded_by(f"compile {example} -o telephone.svg --quiet")
    assert {"numpy", "manifold3d", "svgwrite"} <= loaded
    explaining = {"failures", "giving", "remedies", "trials"}
    told = {f"explaining.{name}" for name in explaining}
    told |= {"common.render", "geometry.dimensions", "geometry.freedom", "geometry.survey", "syntax.errors"}
    assert {f"aidl_lang.{name}" for name in told} & loaded == set()
    assert sum(name.startswith("aidl_lang") for name in loaded) <= MOST_LOADED
    parts = {"numpy.ma", "numpy.random", "svgwrite.data.svgparser"}
    assert (WEB | parts | {"PIL", "difflib", "scipy"}) & loaded == set()


def test_reader_that_goes_away(folder: Path) -> None:
    with subprocess.Popen([*COMMAND, "explain"], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode in (0, 141)


def test_terminal_without_unicode(folder: Path) -> None:
    (folder / "wide.aidl").write_text("solid 世 { = }\n", encoding="utf-8")
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = subprocess.run(
        [*COMMAND, "check", "wide.aidl"], env=environment, stderr=subprocess.PIPE, check=False
    )
    assert done.returncode == 1
    assert b"Traceback" not in done.stderr


def test_watch_draws_again_on_save_and_stops_quietly(folder: Path) -> None:
    """On that of the program, and of a drawing that it reads, and of nothing else."""
    circle = '<svg xmlns="http://www.w3.org/2000/svg"><circle r="{}"/></svg>'
    (folder / "disc.svg").write_text(circle.format(5))
    (folder / "sign.aidl").write_text('import "disc.svg" as disc\nsolid plate { edge = disc() }\n')
    command = [*COMMAND, "watch", "sign.aidl", "-o", "watched.svg"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        try:
            first = process.stderr.readline()
            time.sleep(1.0)
            (folder / "other.svg").write_text(circle.format(9))
            time.sleep(1.0)
            (folder / "disc.svg").write_text("no drawing")
            second = process.stderr.readline()
            drawn = (folder / "watched.svg").read_bytes()
            (folder / "sign.aidl").write_text("")
            third = next(line for line in process.stderr if "E0929" in line)
        finally:
            process.send_signal(signal.SIGINT)
        rest = process.stderr.read()
    assert "watched.svg: solved" in first
    assert "error[E0362]" in second
    assert "error[E0929]: nothing is drawn, so `watched.svg` is left as it is" in third
    assert (folder / "watched.svg").read_bytes() == drawn
    assert "Traceback" not in rest
    assert process.returncode == 130


def test_an_interrupt_while_parts_are_nested_writes_nothing(
    aidl: Aidl, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spyrrow = pytest.importorskip("spyrrow")

    def begun(**settings: object) -> object:
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        return made(**settings)

    made = spyrrow.StripPackingConfig
    monkeypatch.setattr(spyrrow, "StripPackingConfig", begun)
    parts = "".join(f"solid p{k} {{ c = rectangle(width: {20 + k}, height: 30) }}\n" for k in range(20))
    nested = aidl("compile", "-", "-o", "many.svg", "--sheet", "200x150", "--nest", "50", stdin=parts)
    assert nested == Result(130, "", "")
    assert not (folder / "many.svg").exists()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no device that is always full")
@pytest.mark.parametrize(
    ("is_buffered", "arguments"),
    [
        *[(True, []), (False, ["--help"])],
        *[(False, ["check", "good.aidl", "--json"]), (True, ["compile", "good.aidl", "-o", "-"])],
    ],
)
def test_a_full_device_is_told(folder: Path, arguments: list[str], is_buffered: bool) -> None:
    environment = {**os.environ, "PYTHONUNBUFFERED": "" if is_buffered else "1", "NO_COLOR": "1"}
    with open("/dev/full", "wb") as full:
        done = subprocess.run(
            [*COMMAND, *arguments],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
            env=environment,
        )
    assert done.returncode == 2
    assert done.stderr == "error[E0904]: standard output cannot be written: no space left on device\n"


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no device that is always full")
@pytest.mark.parametrize(
    "arguments",
    [["compile", "good.aidl", "-o", "made.svg"], ["check", "none.aidl"], ["nonsense"]],
)
def test_a_message_that_is_lost_is_told_by_the_exit_code(folder: Path, arguments: list[str]) -> None:
    with open("/dev/full", "wb") as full:
        done = subprocess.run([*COMMAND, *arguments], stdout=subprocess.PIPE, stderr=full, check=False)
    assert (done.returncode, done.stdout) == (74, b"")
    assert (folder / "made.svg").exists() == ("made.svg" in arguments)


def test_a_reader_of_messages_that_goes_away_ends_the_command(folder: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    with open(writing, "wb") as gone:
        done = subprocess.run([*COMMAND, "check", "none.aidl"], stderr=gone, check=False)
    assert done.returncode == 141


@pytest.mark.parametrize("closed", [1, 2])
def test_a_stream_that_is_closed_takes_all(folder: Path, closed: int) -> None:
    done = subprocess.run(
        ["sh", "-c", f'"$@" {closed}>&-', "sh", *COMMAND, "explain"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert bool(done.stdout) == (closed == 2)
