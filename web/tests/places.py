"""Where the tests of the playground find Pyodide and Node, and what they build with them."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

from aidl_web.site import ROOT

Run = Callable[..., str]
"""Runs a script with arguments in the playground's Python, and returns what it printed."""
PYODIDE = Path(os.environ.get("AIDL_PYODIDE") or ROOT / "build" / "pyodide")
MISSING = (
    f"there is no Pyodide in {PYODIDE}: `make test-playground` installs it"
    if not (PYODIDE / "pyodide.mjs").exists()
    else "there is no Node"
    if shutil.which("node") is None or shutil.which("npm") is None
    else ""
)
"""Why there is no playground to be tested; empty if there is one."""
