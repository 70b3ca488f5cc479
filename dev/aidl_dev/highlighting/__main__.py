"""`python -m aidl_dev.highlighting ROOT`: writes all that is generated for editors (`make colours`)."""

from __future__ import annotations

import sys
from pathlib import Path

from aidl_dev.highlighting.site import write

if __name__ == "__main__":
    write(Path(sys.argv[1]))
