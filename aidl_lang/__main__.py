"""`python -m aidl_lang` is `aidl`."""

import sys

from aidl_lang.tools.cli import main

if __name__ == "__main__":
    sys.exit(main())
