"""Which package computes: the same everywhere, and another when a file of it is another."""

from __future__ import annotations

import subprocess
import sys

from aidl_lang import __version__
from aidl_lang.common import identity


def test_a_package_is_told_by_its_version_and_its_files() -> None:
    mine = identity.package()
    version, mark, digest = mine.partition("+")
    assert (version, mark, len(digest)) == (__version__, "+", 16)
    told = subprocess.run(
        [sys.executable, "-c", "from aidl_lang.common.identity import package; print(package())"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert told.stdout.strip() == mine
    assert identity.surroundings().startswith(f"{mine}, python 3.")
    assert "numpy" in identity.surroundings()
