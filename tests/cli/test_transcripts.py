"""Commands and all that they print, as `said.md` and `refused.md` have it. `make accept` (AIDL_ACCEPT=1)
takes what they print now.
"""

from __future__ import annotations

import os
import re
import shlex
from pathlib import Path

import pytest

from tests.commands import Aidl, Result
from tests.documents import Block, blocks
from tests.llm.conftest import _nothing_in_the_environment as _nothing_in_the_environment

HERE = Path(__file__).parent
_ACCEPT = bool(os.environ.get("AIDL_ACCEPT"))  # the tests themselves have nothing in the environment


@pytest.fixture(autouse=True)
def _a_terminal_as_wide_as_pages_have_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "110")


def consoles(page: str) -> list[object]:
    """The transcripts of a page, each with the heading that it stands under."""
    found = [block for block in blocks(HERE / page) if block.language == "console"]
    return [pytest.param(block, id=block.heading) for block in found]


def prepared(folder: Path, block: Block) -> list[str]:
    """Returns the commands of a transcript, when its files lie in the folder."""
    for file in blocks(block.path):
        if file.file is not None and file.heading == block.heading:
            (folder / file.file).write_text(file.text)
    return re.findall(r"^\$ (.*)$", block.text, flags=re.MULTILINE)


VARYING = {r"[\d.]+ s(?=;|$)": "N s", r'"seconds": [\d.]+': '"seconds": N', r"the \d+ values": "the N values"}
"""What is another time another, and how a page has it."""


def shown(command: str, result: Result, usual: int) -> str:
    """A command with what it printed, without its usage, and an exit code other than the usual one."""
    said = result.out + re.sub(r"\Ausage: .*?^(?=aidl )", "", result.err, flags=re.DOTALL | re.MULTILINE)
    for pattern, word in VARYING.items():
        said = re.sub(pattern, word, said, flags=re.MULTILINE)
    return f"$ {command}\n{said}" + ("" if result.code == usual else f"[{result.code}]\n")


def compare(block: Block, transcript: str) -> None:
    if _ACCEPT:
        page = block.path.read_text("utf-8")
        block.path.write_text(page.replace(block.text, transcript), "utf-8")
    else:
        assert transcript == block.text


@pytest.mark.parametrize("block", consoles("said.md"))
def test_what_is_said(aidl: Aidl, folder: Path, block: Block) -> None:
    transcript = ""
    for command in prepared(folder, block):
        program, *words = shlex.split(command)
        if program == "cat":
            result = Result(0, (folder / words[0]).read_text("utf-8-sig"), "")
        else:
            result = aidl(*words)
        transcript += shown(command, result, 0)
    compare(block, transcript)


@pytest.mark.parametrize("block", consoles("refused.md"))
def test_what_is_refused(aidl: Aidl, folder: Path, block: Block) -> None:
    transcript = ""
    for command in prepared(folder, block):
        program, *words = shlex.split(command)
        if program == "printf":  # TEXT > FILE
            (folder / words[2]).write_text(words[0].encode().decode("unicode_escape"))
            transcript += f"$ {command}\n"
            continue
        before = {path: path.read_bytes() for path in folder.iterdir()}
        transcript += shown(command, aidl(*words), 2)
        assert {path: path.read_bytes() for path in folder.iterdir()} == before, command
    compare(block, transcript)
