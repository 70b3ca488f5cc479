"""`python -m aidl_lang.reference ROOT`: write all that is generated into a checkout (`make reference`)."""

from __future__ import annotations

import sys
from pathlib import Path

from aidl_lang.reference.site import write

if __name__ == "__main__":
    try:
        write(Path(sys.argv[1]))
    except ValueError as reason:
        sys.exit(str(reason))
