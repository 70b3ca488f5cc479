"""Installs the peers of the solver benchmark into a virtual environment of their own. Nothing else uses it.

    python benchmarks/solver/install_peers.py [FOLDER]      default: .peers beside this file

planegcs is built from source and needs Eigen, Boost and CMake, ezpz needs Rust. On Debian and Ubuntu:

    apt-get install libeigen3-dev libboost-dev cmake g++ cargo

A peer that cannot be installed is named at the end; the benchmark then reports it as missing.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import venv
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).resolve().parent
DEFAULT = HERE / ".peers"

SHARED = ["numpy==2.4.6", "scipy==1.17.1"]
PLANEGCS = "planegcs==0.9.6"


def main() -> int:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else DEFAULT).resolve()
    venv.create(folder, with_pip=True)
    _pip(folder, *SHARED)
    steps: dict[str, Callable[[], None]] = {
        "planegcs": lambda: _install_planegcs(folder),
        "python-solvespace": lambda: _pip(folder, "python-solvespace==3.0.8"),
        "slvs": lambda: _pip(folder, "slvs==3.3"),
        "ezpz": lambda: _build_ezpz(folder),
    }
    missing = [name for name, step in steps.items() if not _succeeds(step)]
    for name in steps:
        print(f"{name}: {'MISSING, see the messages above' if name in missing else 'installed'}")
    return 1 if missing else 0


def _succeeds(step: Callable[[], None]) -> bool:
    try:
        step()
    except (subprocess.CalledProcessError, FileNotFoundError) as error:
        print(error, file=sys.stderr)
        return False
    return True


def _pip(folder: Path, *arguments: str) -> None:
    subprocess.run(
        [
            folder / "bin" / "python",
            "-m",
            "pip",
            "install",
            "--quiet",
            "--disable-pip-version-check",
            *arguments,
        ],
        check=True,
    )


def _install_planegcs(folder: Path) -> None:
    """It asks for Python 3.12 only because of `type X = …` statements; older Pythons get assignments."""
    _pip(folder, "--no-deps", "--ignore-requires-python", PLANEGCS)
    if sys.version_info >= (3, 12):
        return
    for file in folder.glob("lib/python*/site-packages/planegcs/*.py"):
        text = file.read_text(encoding="utf-8")
        file.write_text(re.sub(r"^type (\w+) = ", r"\1 = ", text, flags=re.MULTILINE), encoding="utf-8")


def _build_ezpz(folder: Path) -> None:
    subprocess.run(
        ["cargo", "build", "--release", "--locked", "--quiet"],
        cwd=HERE / "ezpz",
        env={**os.environ, "CARGO_TARGET_DIR": str(folder / "ezpz")},
        check=True,
    )


if __name__ == "__main__":
    sys.exit(main())
