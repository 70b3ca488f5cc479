"""`python -m aidl_web FOLDER`: builds the playground."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from aidl_web.site import CDN, ROOT, BuildError, built


def main() -> int:
    parser = argparse.ArgumentParser(prog="aidl_web", description="Builds the playground into a folder.")
    parser.add_argument("folder", type=Path)
    parser.add_argument(
        "--pyodide", default=CDN, metavar="PLACE", help="a folder, or an address (%(default)s)"
    )
    parser.add_argument(
        "--work", type=Path, default=ROOT / "build" / "web", help="keeps what is made on the way"
    )
    given = parser.parse_args()
    try:
        built(given.folder.resolve(), given.pyodide, given.work.resolve())
    except BuildError as reason:
        print(f"error: {reason}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
