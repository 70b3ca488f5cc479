"""The parts of a spec: programs, what is expected of them, and where all of it stands in the Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

_FENCE = re.compile(r"^```(\S+) *(.*)$")
_PENDING = re.compile(r"<!--\s*pending:\s*(.*?)\s*-->")
_SLOW = "<!-- slow -->"
_EXPECTED = re.compile(r"\s*// (?=(?:error|warning|note)\[[EWN]\d{4}\]: )")
_HEADING = re.compile(r"^#+ +(.*)$")


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
        found = [
            line.text.removeprefix(word).strip() for line in self.lines if line.text.startswith(f"{word} ")
        ]
        return dict(_assignment(text) for text in found)

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


@dataclass
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
    heading, pending, slow = "", None, False
    files: dict[str, str] = {}
    lines = path.read_text(encoding="utf-8").splitlines()
    for number, line, body in _blocks(lines):
        if body is None:
            if title := _HEADING.match(line):
                heading = title[1]
            if mark := _PENDING.search(line):
                pending = mark[1]
            slow |= line == _SLOW
            continue
        fence = _FENCE.match(line)
        assert fence, f"{path.name}:{number}: a block needs a language"
        match fence[1], fence[2].strip():
            case "aidl", "":
                cases.append(Case(path, heading, _program(number + 1, body), dict(files), pending, slow))
                files, pending, slow = {}, None, False
            case "aidl", note if note.startswith("file="):
                files[note.removeprefix("file=")] = "".join(f"{text}\n" for text in body)
            case "expect", "":
                cases[-1].expectations.append(
                    Expectation(tuple(Line(number + 1 + i, text.strip()) for i, text in enumerate(body)))
                )
            case "fixed", "":
                broken = cases[-1]
                mended = _program(number + 1, body)
                reason = pending or broken.pending
                fixed = Case(path, heading, mended, broken.files, reason, broken.slow, fixes=broken.program)
                cases.append(fixed)
                pending = None
            case "formatted", "":
                cases[-1].formatted = number + 1, "".join(f"{text}\n" for text in body)
            case "message", "":
                cases[-1].message = number + 1, "".join(f"{text}\n" for text in body)
            case _, _:
                raise ValueError(f"{path.name}:{number}: unknown block `{line}`")
    return cases


def _blocks(lines: list[str]) -> Iterator[tuple[int, str, list[str] | None]]:
    """Lines outside of blocks with None, openings of blocks with their bodies."""
    opening = 0
    body: list[str] = []
    for number, line in enumerate(lines, 1):
        if not opening and line.startswith("```"):
            opening, body = number, []
        elif opening and line.strip() == "```":
            yield opening, lines[opening - 1], body
            opening = 0
        elif opening:
            body.append(line)
        else:
            yield number, line, None


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


def _assignment(text: str) -> tuple[str, str]:
    name, _, value = text.partition("=")
    return name.strip(), value.strip()
