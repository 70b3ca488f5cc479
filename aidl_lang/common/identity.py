"""Which package this is: its version, and a digest of all that results depend on."""

from __future__ import annotations

import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from aidl_lang.common.resources import resource
from aidl_lang.version import __version__

_NUMBERS = ("numpy", "scipy", "manifold3d", "ezdxf", "fonttools", "reportlab", "resvg-py", "svgwrite")
"""Packages whose versions may change a digit or a byte of a result."""


@cache
def package() -> str:
    """Returns `0.9.0+3f2a…`: the version, and a digest of code, grammar and standard library."""
    code = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256()
    shipped = [(path, path.relative_to(code)) for path in code.rglob("*.py") if "_data" not in path.parts]
    for name in ("stdlib", "grammar"):
        folder = resource(name)
        shipped += [(path, Path(name, path.name)) for path in folder.iterdir() if path.is_file()]
    for path, place in sorted(shipped, key=lambda each: each[1].as_posix()):
        data = path.read_bytes()
        digest.update(f"{place.as_posix()} {len(data)}\n".encode())
        digest.update(data)
    return f"{__version__}+{digest.hexdigest()[:16]}"


@cache
def surroundings() -> str:
    """Returns `package` with the versions of what computes and writes beside it."""
    known = [f"python {platform.python_version()} {platform.machine()}"]
    for name in _NUMBERS:
        try:
            known.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            known.append(f"{name} –")
    return ", ".join([package(), *known])
