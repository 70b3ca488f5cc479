"""Exports of the grammar of AIDL, for constrained decoding and for readers.

All formats are made of `grammar/aidl.lark`, the grammar that the parser is made of, and lie here as files.
"""

from __future__ import annotations

from pathlib import Path

from aidl_lang.common.resources import resource

FORMATS = ("lark", "llguidance", "gbnf", "ebnf")
FENCED_FORMATS = ("llguidance", "gbnf")


def export(format: str, fenced: bool = False) -> str:
    """The grammar in one of FORMATS; `fenced`: of free text and then a program in a block opened by ```aidl.

    Raises ValueError for another format, and for `fenced` with one that is not in FENCED_FORMATS.
    """
    if format not in FORMATS or (fenced and format not in FENCED_FORMATS):
        raise ValueError(f"no such export: {format}, fenced={fenced}")
    if format == "lark":
        return resource("grammar/aidl.lark").read_text("utf-8")
    return Path(__file__).with_name(f"{format}{'-fenced' if fenced else ''}.txt").read_text("utf-8")
