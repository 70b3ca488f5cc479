"""What runs when the package is built: the parser's tables and the parsed library are worked out here, once,
and go into the wheel as data.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class DerivedData(BuildHookInterface[Any]):
    """Adds `aidl_lang/_data/derived/` to a wheel; for an editable install it fills `build/derived/`."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        sys.path.insert(0, self.root)
        try:
            from aidl_lang.checking import library
            from aidl_lang.syntax import tables
        finally:
            sys.path.remove(self.root)
        if version == "editable":
            library.load()
            return
        self.folder = Path(tempfile.mkdtemp(prefix="aidl-derived-"))
        for part in (tables, library):
            path = self.folder / part.DERIVED
            path.write_bytes(part.built())
            build_data["force_include"][str(path)] = f"aidl_lang/_data/derived/{part.DERIVED}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        if version != "editable":
            shutil.rmtree(self.folder)
