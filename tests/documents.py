"""Programs in Markdown: fenced blocks opened with ```aidl, and the heading they stand under."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

_FENCE = re.compile(r"^ *```(\S*) *(.*)$")


@dataclass(frozen=True)
class Block:
    """One block. `note` is what follows the language on its first line: `error`, `fragment`, `file=NAME`,
    `variant=NAME`.
    """

    path: Path
    line: int
    heading: str
    language: str
    note: str
    text: str

    @property
    def place(self) -> str:
        return f"{self.path.relative_to(ROOT)}:{self.line}"

    @property
    def file(self) -> str | None:
        return self.note.removeprefix("file=") if self.note.startswith("file=") else None

    @property
    def variant(self) -> str:
        return self.note.removeprefix("variant=") if self.note.startswith("variant=") else "full"


def blocks(path: Path) -> Iterator[Block]:
    """All fenced blocks of a page, in order."""
    heading, opening, body = "", None, []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        fence = _FENCE.match(line)
        if opening is None and fence:
            opening, body = (number, fence[1], fence[2].strip()), []
        elif opening and line.strip() == "```":
            yield Block(path, opening[0], heading, opening[1], opening[2], "".join(f"{b}\n" for b in body))
            opening = None
        elif opening:
            body.append(line)
        elif line.startswith("#"):
            heading = line.lstrip("#").strip()


def programs(path: Path) -> list[Block]:
    """The AIDL blocks of a page."""
    return [block for block in blocks(path) if block.language == "aidl"]


def beside(found: list[Block]) -> dict[str, str]:
    """The programs that others among these import, by the names of their files."""
    return {block.file: block.text for block in found if block.file}
