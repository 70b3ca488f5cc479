"""`make fuzz-readers MINUTES=2`: hands changed files and messages to their readers; ends with 1 if one broke.

Whatever a drawing, a font, a table or a client says, its reader takes it or tells what is wrong in its own
words, in bounded time and memory.
"""

from __future__ import annotations

import asyncio
import faulthandler
import io
import json
import logging
import random
import sys
import tempfile
import traceback
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import AidlError
from aidl_lang.common.drawings import DrawingError, outlines
from aidl_lang.common.font_files import FontError, FontFile
from aidl_lang.common.running import OutOfTime, limited_to
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld, Reads
from aidl_lang.tools.sweeping.plan import read_table
from tests.documents import ROOT
from tests.fuzz.running import Found, fuzz, options
from tests.test_font_files import bar, both, made_of, open_type, true_type

FILES = Path(__file__).with_name("files")
_SECONDS = 20.0
"""Of the processor for one file: a drawing and a font are read in a small part of that."""
_HANGS = 120
"""Seconds after which a reader that cannot be interrupted is told with its stack, and all ends."""
_WORDS = (
    *(b"-1", b"0", b"1e308", b"1e-320", b"nan", b"inf", b"99999999999999999999", b"\xff\xfe", b"\0", b"\r\n"),
    *(b"<", b"/>", b"</svg>", b'"', b"&amp;", b"<use href='#a'/>", b"matrix(0 0 0 0 0 0)"),
    *(b"M0 0A1 0 9 1 1 0 0z", b"  0\nLINE\n", b" 70\n1\n", b"  0\nINSERT\n", b"SPLINE"),
    *(b"\xed\xa0\x80", b"\xf0\x9d\x92\x9c", b",", b"\n", b"'"),
    *(b"Content-Length: 5\r\n\r\n", b"{", b"}", b"[", b"null", b'"id":', b"\\ud800", b'"params":', b"true"),
)
"""What readers may stumble over."""


def changed(samples: tuple[bytes, ...], chance: random.Random) -> bytes:
    """Returns one of some files with something changed: bytes, words, pieces left out, doubled, exchanged."""
    data = bytearray(chance.choice(samples))
    for _ in range(chance.choice((1, 1, 2, 3, 6, 20))):
        at = chance.randrange(len(data) + 1)
        length = min(len(data) - at, int(2 ** chance.uniform(0, 10)))
        match chance.randrange(6):
            case 0 if at < len(data):
                data[at] ^= 1 << chance.randrange(8)
            case 1:
                data[at : at + chance.choice((0, 1, 2, 4))] = chance.choice(_WORDS)
            case 2:
                del data[at : at + length]
            case 3:
                data[at:at] = data[at : at + length] * chance.choice((1, 2, 50))
            case 4:
                other = chance.choice(samples)
                begin = chance.randrange(len(other))
                data[at : at + length] = other[begin : begin + length]
            case _:
                data[at : at + length] = bytes(chance.randrange(256) for _ in range(min(length, 8)))
    return bytes(data)


@cache
def samples(kind: str) -> tuple[bytes, ...]:
    """Returns whole files of a kind."""
    match kind:
        case "svg":
            drawn = sorted(
                (ROOT / "docs" / "images" / "gallery").glob("*.svg"), key=lambda p: p.stat().st_size
            )
            return (*(path.read_bytes() for path in drawn[:4]), _SVG)
        case "dxf":
            return (_dxf("R12"), _dxf("R2010"))
        case "font":
            shapes = {"H": bar(), "O": both(bar(), bar(200, 100, 400, 600))}
            return true_type({**shapes, "A": made_of("H", "O")}), open_type(shapes)
        case "csv":
            return (_CSV, '﻿width,name\r\n60,"a, ""b"""\r\n,é\r\n'.encode())
        case _:
            return (_session(),)


_SVG = b"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 90"><style>.a { fill: red }</style>
<defs><g id="a"><rect id="b" width="9" height="5" rx="2" transform="rotate(30) skewX(9)"/></g></defs>
<use href="#a" x="3"/><path id="c" class="a" d="M1 1h5v5q3 3-2 4t1 1c1 2 3 4 5 6s7 7 8 8A3 4 9 1 0 2 2z"/>
<polygon points="1,2 3,4 5,1"/><ellipse rx="3" ry="2"/><svg x="5" viewBox="0 0 2 2"><line x2="2"/></svg>
</svg>"""
_CSV = b'width,name,note\n60,Ada,"one\ntwo"\n80,"B, ""b""",\n,,\n6cm,-5,=1\n'


def _dxf(version: str) -> bytes:
    import ezdxf

    document = ezdxf.new(version)
    block = document.blocks.new("B")
    block.add_circle((1, 2), 3)
    space = document.modelspace()
    space.add_line((0, 0), (5, 5))
    space.add_arc((1, 1), 3, 20, 200)
    space.add_blockref("B", (5, 5), dxfattribs={"xscale": 2, "rotation": 30})
    space.add_polyline2d([(0, 0), (5, 0), (5, 5)], close=True)
    if version != "R12":
        space.add_lwpolyline([(0, 0, 0.5), (9, 0, 0), (9, 5, -1)], "xyb", close=True)
        space.add_open_spline([(0, 0), (3, 5), (6, 1), (9, 9), (12, 0)])
        space.add_rational_spline([(0, 0), (3, 5), (6, 1), (9, 9)], [1, 2, 1, 1])
        space.add_ellipse((0, 0), (5, 0), 0.5, 0, 4)
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


_URI = "file:///nowhere/a.aidl"
_TEXT = "solid plate {\n    rim = circle(radius: 5)\n    hole h { edge = circle(radius: 2) }\n}\n"


def _message(method: str, params: Any, number: int | None) -> bytes:
    said = {"jsonrpc": "2.0", "method": method, "params": params} | ({} if number is None else {"id": number})
    body = json.dumps(said).encode()
    return b"Content-Length: %d\r\n\r\n%s" % (len(body), body)


def _session() -> bytes:
    named = {"textDocument": {"uri": _URI}}
    here = {**named, "position": {"line": 1, "character": 12}}
    start = {"line": 1, "character": 4}
    edit = {"range": {"start": start, "end": {"line": 1, "character": 7}}, "text": "edge"}
    opened = {"textDocument": {"uri": _URI, "languageId": "aidl", "version": 1, "text": _TEXT}}
    changed = {"textDocument": {"uri": _URI, "version": 2}, "contentChanges": [edit]}
    sent: list[tuple[str, Any, bool]] = [
        ("initialize", {"processId": None, "rootUri": None, "capabilities": {}}, True),
        ("initialized", {}, False),
        ("textDocument/didOpen", opened, False),
        ("textDocument/hover", here, True),
        ("textDocument/completion", here, True),
        ("textDocument/semanticTokens/full", named, True),
        ("textDocument/documentSymbol", named, True),
        ("textDocument/didChange", changed, False),
        ("textDocument/rename", {**here, "newName": "b"}, True),
        ("textDocument/codeAction", {**named, "range": edit["range"], "context": {"diagnostics": []}}, True),
        ("textDocument/formatting", {**named, "options": {"tabSize": 4, "insertSpaces": True}}, True),
        ("aidl/preview", {"uri": _URI, "viewer": "1"}, True),
        ("textDocument/didClose", named, False),
    ]
    return b"".join(_message(m, p, k if is_asked else None) for k, (m, p, is_asked) in enumerate(sent))


def _drawing(suffix: str) -> Callable[[bytes], object]:
    def read(data: bytes) -> object:
        try:
            return outlines.__wrapped__(f"a.{suffix}", data)
        except DrawingError as told:
            return str(told)

    return read


def _font(data: bytes) -> object:
    try:
        font = FontFile(data)
        for character in "HOA\u00e9":
            if character in font:
                font.outline(character)
    except FontError as told:
        return str(told)
    return None


@cache
def _knobs() -> Any:
    text = 'param width = 60 in 40..400\nparam name = "a"\nsolid s { c = circle(radius: width) }\n'
    return pipeline.knobs(SourceFile("a.aidl", text), MemoryWorld({}))[0]


def _csv(data: bytes) -> object:
    with tempfile.NamedTemporaryFile(suffix=".csv") as file:
        file.write(data)
        file.flush()
        try:
            return read_table(Path(file.name), _knobs(), Reads())
        except AidlError as told:
            return str(told)


def _rpc(data: bytes) -> object:
    return asyncio.run(_served(data))


async def _served(data: bytes) -> None:
    """Hands the bytes of a session to a server; raises if it crashes, or answers nothing after that."""
    from aidl_server.lsp import serve

    server, answers, crashes = serve.make(), list[Any](), list[BaseException]()
    server.crashed = crashes.append  # type: ignore[method-assign]
    server.start()
    keeping = type("Keeping", (), {"write": lambda self, said: answers.append(json.loads(said))})
    server.protocol.set_writer(keeping(), include_headers=False)
    reader = asyncio.StreamReader()
    reader.feed_data(data)
    reader.feed_eof()
    try:
        async for body in serve.bodies(reader):
            server.protocol.receive(body)
            await asyncio.sleep(0)
        server.protocol.receive(b'{"jsonrpc": "2.0", "id": "alive", "method": "aidl/nothing"}')
        async with asyncio.timeout(_SECONDS):
            while not any(answer.get("id") == "alive" for answer in answers):
                await asyncio.sleep(0.005)
    finally:
        server.close()
    if crashes:
        raise crashes[0]


READERS: Mapping[str, Callable[[bytes], object]] = {
    "svg": _drawing("svg"),
    "dxf": _drawing("dxf"),
    "font": _font,
    "csv": _csv,
    "rpc": _rpc,
}


def made(seed: int) -> tuple[str, bytes]:
    """Returns the kind and the content of the file of a seed."""
    chance = random.Random(seed)
    kind = chance.choice(sorted(READERS))
    return kind, changed(samples(kind), chance)


def finding(kind: str, data: bytes) -> str:
    """Returns how a reader broke, with the place; "" if it did not."""
    faulthandler.dump_traceback_later(_HANGS, exit=True)
    try:
        with limited_to(_SECONDS):
            READERS[kind](data)
    except OutOfTime:
        return f"more than {_SECONDS:g} s"
    except Exception as error:  # noqa: BLE001 (what breaks, whatever it is, is the finding)
        place = traceback.extract_tb(error.__traceback__)[-1]
        tells_of_another = type(error).__name__ == "JsonRpcInternalError"
        said = f": {error}" if tells_of_another else ""
        return f"{type(error).__name__} in {Path(place.filename).name}:{place.lineno}{said}"
    finally:
        faulthandler.cancel_dump_traceback_later()
    return ""


def _found(kind: str, text: str, seed: int) -> Found | None:
    said = finding(kind.removeprefix("."), text.encode("latin-1"))
    return (f"{kind}: {said}", "") if said else None


def _made(seed: int) -> tuple[str, str]:
    kind, data = made(seed)
    return f".{kind}", data.decode("latin-1")


if __name__ == "__main__":
    logging.disable()  # what the server says of a client
    sys.exit(fuzz(options(__doc__).parse_args(), _made, _found, "latin-1"))
