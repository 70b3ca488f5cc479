"""The places of the files that ship with the package, its pages on diagnostics, and which package it is."""

from __future__ import annotations

import contextlib
import hashlib
import os
import platform
import re
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path

from aidl_lang.common.world import replace
from aidl_lang.version import __version__

# --- The places of the files that ship with the package: grammar, standard library, pages on diagnostics.
#
# In a wheel they lie in `aidl_lang/_data/`, in a checkout beside the package; nothing else needs to know.
# Data derived from them (the parser's tables, the parsed library) is built into the wheel; a checkout keeps
# it in its own `build/derived/`. All of it is data, and nothing is kept anywhere else.

_PACKAGE = Path(__file__).resolve().parents[1]
_SHIPPED = _PACKAGE / "_data"
_CHECKOUT = _PACKAGE.parent


@cache
def resource(name: str) -> Path:
    """Returns the path of the file or folder `name`, as `grammar/aidl.lark`, `stdlib` or `docs/diagnostics`.

    Raises FileNotFoundError if the installation is incomplete.
    """
    for root in (_SHIPPED, _CHECKOUT):
        if (path := root / name).exists():
            return path
    raise FileNotFoundError(f"{name} is missing from this installation of aidl_lang")


def derived(name: str, inputs: Callable[[], Iterable[Path]], make: Callable[[], bytes]) -> bytes:
    """Returns the bytes that `make` returns, worked out once.

    An installation has them among its files. A checkout makes them again when one of the `inputs` has
    changed; errors that `make` raises are passed on.
    """
    if _SHIPPED.exists():
        return resource(f"derived/{name}").read_bytes()
    kept = _kept(name, inputs())
    try:
        return kept.read_bytes()
    except OSError:
        data = make()
    # Where a checkout cannot be written, each run makes it anew.
    with contextlib.suppress(OSError):
        _keep(kept, data)
    return data


def _kept(name: str, inputs: Iterable[Path]) -> Path:
    """Returns the file of a checkout whose name holds a digest of everything its content depends on."""
    stem, suffix = os.path.splitext(name)
    digest = _digest((path.name, path) for path in inputs)
    return _CHECKOUT / "build" / "derived" / f"{stem}-{digest[:32]}{suffix}"


def _digest(files: Iterable[tuple[str, Path]]) -> str:
    digest = hashlib.sha256()
    for name, path in files:
        data = path.read_bytes()
        digest.update(f"{name} {len(data)}\n".encode())
        digest.update(data)
    return digest.hexdigest()


def _keep(path: Path, data: bytes) -> None:
    """Writes a file, and deletes what an older state of the checkout left."""
    path.parent.mkdir(parents=True, exist_ok=True)
    replace(path, data)
    stem = path.name.rpartition("-")[0]
    for old in path.parent.glob(f"{stem}-*{path.suffix}"):
        if old != path:
            old.unlink(missing_ok=True)


# --- The pages on diagnostics, which are also the list of codes that exist.


def codes() -> list[str]:
    """Returns all codes, errors first, then warnings, then notes."""
    return list(_pages())


def page(code: str) -> str:
    """Returns the page of a code as Markdown. Raises KeyError for a code that does not exist."""
    return _pages()[code].read_text(encoding="utf-8")


def title(code: str) -> str:
    """Returns the heading of the page of a code, without the code."""
    heading = page(code).partition("\n")[0]
    return heading.removeprefix(f"# {code}:").strip()


def near(code: str) -> list[str]:
    """Returns codes that may have been meant: those that look alike, else those of the same digits."""
    from difflib import get_close_matches  # takes time to load

    digits = "".join(char for char in code if char.isdigit())
    same = [known for known in _pages() if digits and known[1:] == digits]
    return same or get_close_matches(code, _pages(), n=3, cutoff=0.7)


@cache
def _pages() -> dict[str, Path]:
    paths = [p for p in resource("docs/diagnostics").glob("*.md") if re.fullmatch(r"[EWN]\d{4}", p.stem)]
    return {path.stem: path for path in sorted(paths, key=lambda p: ("EWN".index(p.stem[0]), p.stem))}


_NUMBERS = ("numpy", "scipy", "manifold3d", "ezdxf", "fonttools", "reportlab", "resvg-py", "svgwrite")
"""Packages whose versions may change a digit or a byte of a result."""


@cache
def package() -> str:
    """Returns `0.9.0+3f2a…`: the version, and a digest of code, grammar and standard library."""
    code = [path for path in _PACKAGE.rglob("*.py") if "_data" not in path.parts]
    shipped = [(path.relative_to(_PACKAGE).as_posix(), path) for path in code]
    for name in ("stdlib", "grammar"):
        shipped += [(f"{name}/{path.name}", path) for path in resource(name).iterdir() if path.is_file()]
    return f"{__version__}+{_digest(sorted(shipped))[:16]}"


@cache
def surroundings() -> str:
    """Returns `package` with the versions of what computes and writes beside it."""
    from importlib.metadata import PackageNotFoundError, version

    known = [f"python {platform.python_version()} {platform.machine()}"]
    for name in _NUMBERS:
        try:
            known.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            known.append(f"{name} –")
    return ", ".join([package(), *known])
