"""The parts of a spec: programs, what is expected of them, and where all of it stands in the Markdown."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from tests.documents import blocks

_PENDING = re.compile(r"<!--\s*pending:\s*(.*?)\s*-->")
_SLOW = "<!-- slow -->"
_EXPECTED = re.compile(r"\s*// (?=(?:error|warning|note)\[[EWN]\d{4}\]: )")


@dataclass(frozen=True)
class Line:
    """A line of the Markdown file, counted from 1."""

    number: int
    text: str


@dataclass(frozen=True)
class Program:
    """A program without the expectations written into it, and those expectations by line of the program.

    A comment that holds nothing but expectations belongs to the line above it; its own number, negated, is
    among the keys of `expected`. `at` is the line of the file that holds the first line of the program.
    """

    at: int
    lines: tuple[str, ...]
    expected: dict[int, list[str]]

    @property
    def text(self) -> str:
        return "".join(f"{line}\n" for line in self.lines)

    @property
    def code(self) -> str:
        """The text without the lines that held expectations alone."""
        return "".join(f"{line}\n" for n, line in enumerate(self.lines, 1) if -n not in self.expected)


@dataclass(frozen=True)
class Expectation:
    """An `expect` block: one compile and what has to come of it."""

    lines: tuple[Line, ...]

    def settings(self, word: str) -> dict[str, str]:
        """`set width=200` (or `limit entities=10`) as a table."""
        found = (line.text.removeprefix(word) for line in self.lines if line.text.startswith(f"{word} "))
        pairs = (text.partition("=") for text in found)
        return {name.strip(): value.strip() for name, _, value in pairs}

    @property
    def is_variant(self) -> bool:
        return any(line.text.startswith(("set ", "limit ")) for line in self.lines)

    @property
    def diagnostics(self) -> list[Line]:
        return [line for line in self.lines if re.match(r"(error|warning|note)\[", line.text)]

    @property
    def claims(self) -> list[Line]:
        settings = ("set ", "limit ", "error[", "warning[", "note[", "//")
        return [line for line in self.lines if line.text and not line.text.startswith(settings)]


@dataclass(eq=False)
class Case:
    """A program with everything that follows it up to the next one."""

    path: Path
    heading: str
    program: Program
    files: dict[str, str]
    pending: str | None = None
    slow: bool = False
    expectations: list[Expectation] = field(default_factory=list)
    formatted: tuple[int, str] | None = None
    message: tuple[int, str] | None = None
    fixes: Program | None = None

    @property
    def place(self) -> str:
        return f"{self.path.stem}:{self.program.at - 1}"


def read(path: Path) -> list[Case]:
    """The cases of a spec in order. A block `fixed` is a case of its own as well: the mended program."""
    cases: list[Case] = []
    pending, slow, behind = None, False, 0
    files: dict[str, str] = {}
    lines = path.read_text(encoding="utf-8").splitlines()
    for block in blocks(path):
        between, body, at = lines[behind : block.line - 1], block.text.splitlines(), block.line + 1
        behind = block.line + len(body) + 1
        pending = next((mark[1] for mark in map(_PENDING.search, reversed(between)) if mark), pending)
        slow |= _SLOW in between
        match block.language, block.note:
            case "aidl", "":
                case = Case(path, block.heading, _program(at, body), dict(files), pending, slow)
                cases.append(case)
                files, pending, slow = {}, None, False
            case "aidl", _ if block.file is not None:
                files[block.file] = block.text
            case "expect", "":
                texts = enumerate(body, at)
                cases[-1].expectations.append(Expectation(tuple(Line(n, text.strip()) for n, text in texts)))
            case "fixed", "":
                broken, mended, reason = cases[-1], _program(at, body), pending or cases[-1].pending
                fixes = broken.program
                cases.append(
                    Case(path, block.heading, mended, broken.files, reason, broken.slow, fixes=fixes)
                )
                pending = None
            case "formatted", "":
                cases[-1].formatted = at, block.text
            case "message", "":
                cases[-1].message = at, block.text
            case _, _:
                raise ValueError(f"{path.name}:{block.line}: unknown block `{block.language} {block.note}`")
    return cases


def _program(at: int, body: list[str]) -> Program:
    """Take the expectations out. Lines that held nothing else stay as empty ones, so that numbers agree."""
    kept: list[str] = []
    expected: dict[int, list[str]] = {}
    owner = 1
    for number, line in enumerate(body, 1):
        code, *messages = _EXPECTED.split(line)
        if messages and not code.strip():
            expected[-number] = []
        else:
            owner = number
        if messages:
            expected.setdefault(owner, []).extend(message.strip() for message in messages)
        kept.append(code.rstrip() if messages else line)
    return Program(at, tuple(kept), expected)
