"""Writes the files of a checkout that are generated: the reference, the guide, what editors read."""

from collections.abc import Mapping
from pathlib import Path


def write_changed(root: Path, files: Mapping[str, bytes]) -> None:
    """Writes files below a root. One that is right already is not touched."""
    for path, data in files.items():
        file = root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        if not file.exists() or file.read_bytes() != data:
            file.write_bytes(data)
