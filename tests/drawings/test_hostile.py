"""Drawing files that are broken or made to do harm: each is told, in little time."""

from __future__ import annotations

import io
import random
from collections.abc import Callable
from contextlib import suppress

import ezdxf
import pytest
from ezdxf.document import Drawing
from hypothesis import given
from hypothesis import strategies as st

from aidl_lang.common.drawings import MOST_NAMES, DrawingError, outlines
from aidl_lang.common.running import limited_to
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import MemoryWorld
from aidl_lang.geometry import network
from aidl_lang.pipeline import compile
from tests.amount import tries

NAMES = 'xmlns="http://www.w3.org/2000/svg"'
CIRCLE = '<circle r="5"/>'


def svg(body: str, before: str = "") -> bytes:
    return f"{before}<svg {NAMES}>{body}</svg>".encode()


def dxf(draw: Callable[[Drawing], object]) -> bytes:
    document = ezdxf.new()
    draw(document)
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


def told(data: bytes, name: str = "a.svg") -> str:
    with limited_to(60), pytest.raises(DrawingError) as found:
        outlines(name, data)
    return f"{found.value.code} {found.value.message}"


ENTITIES = "".join(f'<!ENTITY e{k} "{f"&e{k - 1};" * 10 if k else "ha"}">' for k in range(10))
BOMB = "".join(f'<g id="u{k}">' + f'<use href="#u{k - 1}"/>' * 10 + "</g>" for k in range(1, 12))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "E0362 `a.svg` is not well-formed: no element found in line 1"),
        (b"\x89PNG\r\n\x1a\n", "E0362 `a.svg` is not well-formed: not well-formed (invalid token) in line 1"),
        (b"<html/>", "E0362 `a.svg` is no SVG: it does not begin with an `svg` element"),
        (b'<?xml version="1.0" encoding="none"?><svg/>', "E0362 `a.svg` is in an encoding that is not known"),
        (
            svg(CIRCLE, f"<!DOCTYPE svg [{ENTITIES}]>"),
            "E0363 `a.svg` is refused: its entity `e1` is no plain abbreviation",
        ),
        (
            svg("&x;", '<!DOCTYPE svg [<!ENTITY x SYSTEM "file:///etc/passwd">]>'),
            "E0363 `a.svg` is refused: its entity `x` is no plain abbreviation",
        ),
        (
            svg(CIRCLE, '<!DOCTYPE svg [<!ENTITY % x SYSTEM "other.dtd"> %x;]>'),
            "E0363 `a.svg` is refused: its entity `x` is no plain abbreviation",
        ),
        (
            svg("<g>" * 3_000 + "</g>" * 3_000),
            "E0363 `a.svg` is refused: its elements lie more than 100 deep in one another",
        ),
        (svg("<g/>" * 110_000), "E0363 `a.svg` is refused: it has more than 100,000 elements"),
        (svg(f'<path d="M0 0{" L1 2" * 1_000_000}"/>'), "E0363 `a.svg` has more than 30,000 curves"),
        (svg(f'<polygon points="{"1 2 3 5 " * 500_000}"/>'), "E0363 `a.svg` has more than 30,000 curves"),
        (
            svg(f'<g id="u0">{CIRCLE}</g>{BOMB}'),
            "E0363 `a.svg` is refused: its `use` elements grow beyond 20,000",
        ),
        (svg('<circle cx="1e308" r="5"/>'), "E0364 `a.svg` reaches further than 100 km from its origin"),
        (
            svg(f'<g transform="scale(1e200)"><g transform="scale(1e200)">{CIRCLE}</g></g>'),
            "E0364 `a.svg` reaches further than 100 km from its origin",
        ),
        (svg('<path id="p" d="M0 0 L nan 5"/>'), "E0365 `a.svg` has no outlines"),
        (svg(f'<g transform="scale(0)">{CIRCLE}</g>'), "E0365 `a.svg` has no outlines"),
    ],
)
def test_an_svg_is_refused_with_a_reason(data: bytes, message: str):
    assert told(data) == message


def test_entities_that_are_plain_abbreviations_are_read():
    data = f'<!DOCTYPE svg [<!ENTITY ns "http://www.w3.org/2000/svg">]><svg xmlns="&ns;">{CIRCLE}</svg>'
    assert len(outlines("a.svg", data.encode()).whole.strokes) == 1


def test_a_file_that_uses_itself_is_read_without_that():
    found = outlines("a.svg", svg(f'<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/>{CIRCLE}</g>'))
    assert [r.code for r in found.remarks] == ["W0752"]
    assert len(found.whole.strokes) == 2


def test_names_have_a_limit():
    found = outlines("a.svg", svg("".join(f'<circle id="n{k}" r="{k + 1}"/>' for k in range(300))))
    assert len(found.parts) == MOST_NAMES
    assert found.remarks[0].message == "`a.svg` has 50 names beyond the first 250, which cannot be used"


def test_a_block_in_itself_is_left_out():
    def draw(document: Drawing) -> None:
        block = document.blocks.new("B")
        block.add_circle((0, 0), 1)
        block.add_blockref("B", (1, 1))
        document.modelspace().add_blockref("B", (0, 0))

    found = outlines("a.dxf", dxf(draw))
    assert len(found.whole.strokes) == 1
    assert found.remarks[0].message == "`a.dxf` has a block that stands in itself, `B`: it is left out there"


def test_blocks_cannot_multiply_without_end():
    def rows(document: Drawing) -> None:
        document.blocks.new("B").add_circle((0, 0), 1)
        many = {"row_count": 30_000, "column_count": 30_000, "row_spacing": 1, "column_spacing": 1}
        document.modelspace().add_blockref("B", (0, 0), dxfattribs=many)

    refused = "E0363 `a.dxf` is refused: its blocks stand in more than 20,000 places"
    assert told(dxf(rows), "a.dxf") == refused


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "E0365 `a.dxf` has no outlines"),
        (b"\0\1junk" * 50, "E0362 `a.dxf` is no DXF file, or is broken"),
        (b"AutoCAD Binary DXF\r\n\x1a\0", "E0362 `a.dxf` is a binary DXF file, which is not read"),
        (
            b"0\nSECTION\n2\nENTITIES\n" + b"0\nPOINT\n" * 110_000 + b"0\nENDSEC\n0\nEOF\n",
            "E0363 `a.dxf` is refused: it has more than 100,000 entities",
        ),
        (
            b"0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n10\n1e300\n20\n0\n40\n5\n0\nENDSEC\n0\nEOF\n",
            "E0364 `a.dxf` reaches further than 100 km from its origin in `0`",
        ),
    ],
)
def test_a_dxf_is_refused_with_a_reason(data: bytes, message: str):
    assert told(data, "a.dxf") == message


WHOLE = {
    "a.svg": svg(
        '<g id="x" transform="rotate(3)"><path d="M0 0 A5 3 1 0 1 9 9 C1 2 3 4 5 6z"/></g>'
        '<use href="#y"/><circle id="y" r="4"/>'
    ),
    "a.dxf": dxf(lambda d: d.modelspace().add_lwpolyline([(0, 0, 0, 0, 1), (5, 0), (5, 5)], close=True)),
}


@tries(200)
@given(st.sampled_from(sorted(WHOLE)), st.data())
def test_whatever_is_changed_in_a_file_it_is_read_or_told(name: str, data: st.DataObject):
    """Bytes of a whole file are overwritten, or it is cut off: nothing but a DrawingError is raised."""
    content = bytearray(WHOLE[name])
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(
            st.sampled_from(b'0-9"<>/& \n.eA\xff\0')
        )
    end = data.draw(st.integers(0, len(content)) | st.just(len(content)))
    with suppress(DrawingError):
        assert outlines(name, bytes(content[:end])).whole.strokes


def test_a_spline_that_crosses_itself_everywhere_is_refused_before_it_is_cut(monkeypatch: pytest.MonkeyPatch):
    """Of 2,000 curves nearly every pair crosses: the limit would only be met after all of its time."""
    chance = random.Random(1)
    points = [(chance.uniform(0, 100), chance.uniform(0, 100)) for _ in range(2_000)]
    data = dxf(lambda d: d.modelspace().add_open_spline([*points, points[0]]))
    world = MemoryWorld({}, {"a.dxf": data})
    program = SourceFile("a.aidl", 'import "a.dxf" as art\nsolid a { edge = art() }\n')
    monkeypatch.setattr(network, "all_intersections", lambda *_: pytest.fail("curves were cut"))
    (found,) = [d for d in compile(program, world).diagnostics if d.is_error]
    assert found.code == "E0805"
    assert found.span is not None
    assert found.span.text == "edge = art()"
