"""Where the files that ship with the package are: grammar, standard library, pages on diagnostics.

In a wheel they lie in `aidl_lang/_data/`, in a checkout beside the package; nothing else needs to know.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


@cache
def resource(name: str) -> Path:
    """The file or folder `name`, as `grammar/aidl.lark`, `stdlib` or `docs/diagnostics`.

    Raises FileNotFoundError when the installation is incomplete.
    """
    for root in (_PACKAGE / "_data", _PACKAGE.parent):
        if (path := root / name).exists():
            return path
    raise FileNotFoundError(f"{name} is missing from this installation of aidl_lang")
