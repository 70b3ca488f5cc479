"""Programs on a page: each gets a link that opens it in the playground."""

from __future__ import annotations

import html
import re
import zlib
from base64 import urlsafe_b64encode
from urllib.parse import quote

PLAYGROUND = "playground/"
"""The folder of the playground, below the root of the site."""

_FENCE = re.compile(r"^( *)(```+|~~~+)\s*([\w-]*)[ \t]*(.*)$")
_IMPORT = re.compile(r'^\s*import\b.*"', re.MULTILINE)


def fragment(program: str, name: str = "") -> str:
    """Returns what stands after `#` in a link to the playground: raw deflate of UTF-8, as base64url, and the
    name of its file if it has one.
    """
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    packed = packer.compress(program.encode()) + packer.flush()
    said = f"name={quote(name)}&" if name else ""
    return f"{said}code=" + urlsafe_b64encode(packed).decode().rstrip("=")


def address(program: str, depth: int, name: str = "") -> str:
    """Returns the relative address that opens a program, from a page that lies in so many folders."""
    return f"{'../' * depth}{PLAYGROUND}#{fragment(program, name)}"


def opening(program: str, depth: int, name: str = "") -> str:
    """Returns the line of HTML that opens a program in the playground."""
    link = f'<a href="{html.escape(address(program, depth, name))}">Open in the playground</a>'
    return f'<p class="aidl-open" data-search-exclude>{link}</p>'


def can_open(language: str, note: str, program: str) -> bool:
    """Tells whether a block is a program that stands alone: the playground knows no second file."""
    return language == "aidl" and note in ("", "error") and not _IMPORT.search(program)


def split(text: str) -> list[tuple[bool, str]]:
    """Returns a page in pieces, each with whether it is a fenced block (its fences included)."""
    pieces: list[tuple[bool, list[str]]] = [(False, [])]
    closing = ""
    for line in text.splitlines(keepends=True):
        fence = _FENCE.match(line.rstrip("\n"))
        if closing:
            pieces[-1][1].append(line)
            if line.strip() == closing:
                closing = ""
                pieces.append((False, []))
        elif fence:
            closing = fence[2]
            pieces.append((True, [line]))
        else:
            pieces[-1][1].append(line)
    return [(is_block, "".join(lines)) for is_block, lines in pieces if lines]


def written(block: str, depth: int, is_linked: bool) -> str:
    """Returns a fenced block as the builder reads it: what follows the language is a title or nothing, and a
    program is followed by its link.
    """
    first, *body = block.splitlines()
    fence = _FENCE.match(first)
    if fence is None:
        return block
    indent, marks, language, note = fence.groups()
    note = note.strip()
    file = note.removeprefix("file=") if note.startswith("file=") else ""
    if file and not file.endswith(".aidl"):
        language = {"svg": "xml", "dxf": "text"}.get(file.rpartition(".")[2], "text")
    title = f' title="{file}"' if file else ""
    lines = [f"{indent}{marks}{language}{title}", *body]
    program = "".join(f"{line.removeprefix(indent)}\n" for line in body[:-1])
    if is_linked and can_open(language, note, program):
        lines += ["", indent + opening(program, depth)]
    return "\n".join(lines) + "\n"
