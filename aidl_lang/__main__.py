"""Entry point of `python -m aidl_lang`, which is `aidl`."""

import sys

from aidl_lang.tools.cli import main

if __name__ == "__main__":
    sys.exit(main())
