"""The README with links that hold elsewhere, as on PyPI: `python -m aidl_site.readme ROOT ADDRESS` leads them
to the site at that address, and pictures of the gallery into its playground.
"""

from __future__ import annotations

import sys
from pathlib import Path, PurePosixPath

from aidl_site.staging import Staging

PAGE = "README.md"


def outside(root: Path, address: str) -> str:
    """Returns the README of a checkout for readers who have nothing else of it. Raises ValueError if a link
    of it leads nowhere.
    """
    staging = Staging(root, root / "build", has_playground=True, address=address.rstrip("/") + "/")
    text = staging.page(PurePosixPath(PAGE))
    if staging.dead:
        raise ValueError(f"dead links: {', '.join(staging.dead)}")
    return text


if __name__ == "__main__":
    root, address = Path(sys.argv[1]), sys.argv[2]
    try:
        (root / PAGE).write_text(outside(root, address), "utf-8")
    except ValueError as reason:
        sys.exit(str(reason))
