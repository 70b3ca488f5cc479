"""The program is found in whatever surrounds it, and half a program is none."""

from __future__ import annotations

import pytest

from aidl_lang.tools.llm.aidl import Aidl
from aidl_lang.tools.llm.messages import find_program

PROGRAM = "solid plate { outline = rectangle(width: 60, height: 40) }\n"


def found(reply: str) -> str | None:
    return find_program(reply, ("aidl",), Aidl().reads)[0]


@pytest.mark.parametrize(
    "reply",
    [
        f"```aidl\n{PROGRAM}```",
        f"A plate.\n\n```aidl\n{PROGRAM}```\nThat is all.",
        f"```\n{PROGRAM}```",
        f"```AIDL title=plate\n{PROGRAM}```",
        f"~~~~aidl\n{PROGRAM}~~~~",
        f"First try:\n```aidl\nsolid a {{\n```\nBetter:\n```aidl\n{PROGRAM}```",
        f"```aidl\n{PROGRAM}```\nRun it:\n```sh\naidl compile plate.aidl\n```",
        f"<think>\n```aidl\nsolid no {{}}\n```\n</think>\n```aidl\n{PROGRAM}```",
        f"````markdown\nno\n````\n   ```aidl\n{PROGRAM}   ```",
        PROGRAM,
        f"<think>hm</think>\n{PROGRAM}",
    ],
)
def test_the_program_is_found(reply: str) -> None:
    assert found(reply) == PROGRAM


@pytest.mark.parametrize(
    "reply",
    [
        "",
        "I cannot draw that.",
        f"```aidl\n{PROGRAM}",
        f"<think>```aidl\n{PROGRAM}```",
        "solid plate is what you want",
        "solid plate { outline = rectangle(width: 60",
        "let a = 3",
    ],
)
def test_what_is_no_program_is_not_taken_for_one(reply: str) -> None:
    assert found(reply) is None
