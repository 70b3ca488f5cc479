"""Exports of the grammar of AIDL, for constrained decoding and for readers.

All formats are made of `grammar/aidl.lark`, the grammar that the parser is made of.
"""

from __future__ import annotations

FORMATS = ("lark", "llguidance", "gbnf", "ebnf")
FENCED_FORMATS = ("llguidance", "gbnf")


def export(format: str, fenced: bool = False) -> str:
    """The grammar in one of FORMATS; `fenced`: of free text and then a program in a block opened by ```aidl.

    Raises ValueError for another format, and for `fenced` with one that is not in FENCED_FORMATS.
    """
    if format not in FORMATS or (fenced and format not in FENCED_FORMATS):
        raise ValueError(f"no such export: {format}, fenced={fenced}")
    from aidl_lang.tools.grammars import formats

    if format in FENCED_FORMATS:
        return formats.for_decoding(format, fenced)
    return formats.as_it_is() if format == "lark" else formats.for_readers()
