"""The pages on diagnostics, which are also the list of codes that exist."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from aidl_lang.common.resources import resource


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
