"""Puts VS Code itself into a folder, as the npm package code-server brings it: `python install.py FOLDER`.

Only VS Code's own server is used, which needs none of its native modules here: nothing is compiled. Takes
node 20 or newer, 180 MB, and half a minute.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

PACKAGE = "code-server@4.100.3"
"""VS Code 1.100. The package says which versions of its parts it takes."""


class Installed:
    """What is in the folder, whether it is there yet or not."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()
        self.code = self.folder / "package" / "lib" / "vscode"
        self.server = self.code / "out" / "server-main.js"
        self.ready = self.folder / "ready"


def main(folder: str) -> None:
    installed = Installed(Path(folder))
    if installed.ready.exists() and installed.ready.read_text() == PACKAGE:
        return
    shutil.rmtree(installed.folder, ignore_errors=True)
    installed.folder.mkdir(parents=True)
    npm("pack", "--silent", PACKAGE, cwd=installed.folder)
    (archive,) = installed.folder.glob("*.tgz")
    with tarfile.open(archive) as packed:
        packed.extractall(installed.folder, filter="data")
    archive.unlink()
    npm(
        "install", "--omit=dev", "--ignore-scripts", "--no-audit", "--no-fund", "--silent", cwd=installed.code
    )
    # Some modules of VS Code are looked for in an archive that the package does not have.
    (installed.code / "node_modules.asar").symlink_to("node_modules")
    installed.ready.write_text(PACKAGE)


def npm(*arguments: str, cwd: Path) -> None:
    done = subprocess.run(["npm", *arguments], cwd=cwd, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"VS Code cannot be installed: npm {arguments[0]} failed\n{done.stdout}{done.stderr}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
