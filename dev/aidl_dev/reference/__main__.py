"""`python -m aidl_dev.reference ROOT`: writes what is generated (`make reference`)."""

from __future__ import annotations

import sys
from pathlib import Path

from aidl_dev.reference.site import write

if __name__ == "__main__":
    try:
        write(Path(sys.argv[1]))
    except ValueError as reason:
        sys.exit(str(reason))
