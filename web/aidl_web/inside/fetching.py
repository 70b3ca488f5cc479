"""Modules that the first drawing does without: brought when one of them is imported."""

from __future__ import annotations

import gzip
import importlib
import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import Any

from pyodide.ffi import to_js

LATER = "later.pack"
EXPORTS = "exports.pack"
_OF = {
    **dict.fromkeys(("aidl_lang", "numpy", "attr", "attrs", "cattrs", "lark", "lsprotocol", "pygls"), LATER),
    **dict.fromkeys(("svgwrite", "fontTools", "rectpack"), LATER),
    **dict.fromkeys(("PIL", "charset_normalizer", "ezdxf", "pyparsing", "reportlab"), EXPORTS),
}
"""The packs of packages, as far as they are not in the first."""


class _Packs(MetaPathFinder):
    """Comes after the other finders: what they do not find is in a pack that is not there yet, or nowhere."""

    def __init__(self, outside: Any) -> None:
        self._outside = outside
        self._there: set[str] = set()

    def bring(self, name: str) -> None:
        """Unpacks a pack unless it was already."""
        if not self.arrived(name):
            return
        data = gzip.decompress(self._outside.read(name).to_py())
        self._outside.unpack(to_js(data).buffer)
        importlib.invalidate_caches()

    def arrived(self, name: str) -> bool:
        """Takes note of a pack that is there. Returns False if it was known."""
        is_new = name not in self._there
        self._there.add(name)
        importlib.invalidate_caches()
        return is_new

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        name = _OF.get(fullname.partition(".")[0])
        if name is None or name in self._there:
            return None
        self.bring(name)
        return PathFinder.find_spec(fullname, path, target)


_packs: _Packs


def install(outside: Any) -> None:
    """Has missing modules brought from now on."""
    global _packs
    _packs = _Packs(outside)
    sys.meta_path.append(_packs)


def arrived(name: str) -> bool:
    """Takes note of a pack that the worker is about to unpack. Returns False if it was unpacked already."""
    return _packs.arrived(name)
