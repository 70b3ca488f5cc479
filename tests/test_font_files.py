"""Font files of one's own: outlines, and files that are broken or made to do harm."""

from __future__ import annotations

import math
import random
import struct
from collections.abc import Callable, Mapping
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.misc.psCharStrings import T2CharString
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen

from aidl_lang import pipeline
from aidl_lang.common.font_files import FontError, FontFile
from aidl_lang.common.resources import resource
from aidl_lang.common.running import limited_to
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import DiskWorld, FileError, MemoryWorld, ReadFailure
from aidl_lang.tools.discretion import Programs

Draw = Callable[[Any], None]
DEJAVU = resource("aidl_lang/common/fonts/DejaVuSansAIDL.ttf").read_bytes()
WIDTH = 600


def bar(left: float = 100, bottom: float = 0, right: float = 500, top: float = 700) -> Draw:
    """Draws a rectangle, clockwise."""

    def draw(pen: Any) -> None:
        pen.moveTo((left, bottom))
        for p in ((left, top), (right, top), (right, bottom)):
            pen.lineTo(p)
        pen.closePath()

    return draw


def both(*draws: Draw) -> Draw:
    def draw(pen: Any) -> None:
        for each in draws:
            each(pen)

    return draw


def made_of(*names: str) -> Draw:
    return both(*(lambda pen, name=name: pen.addComponent(name, (1, 0, 0, 1, 0, 0)) for name in names))  # type: ignore[misc]


def nothing(pen: Any) -> None:
    """Draws nothing."""


def true_type(glyphs: Mapping[str, Draw], capital: int = 700) -> bytes:
    builder = _begun(glyphs, is_true_type=True)
    made = {}
    for name, draw in ((".notdef", nothing), *glyphs.items()):
        pen = TTGlyphPen(dict.fromkeys(glyphs))
        draw(pen)
        made[name] = pen.glyph()
        made[name].xMin = made[name].yMin = made[name].xMax = made[name].yMax = 0
    builder.setupGlyf(made, calcGlyphBounds=False)
    return _ended(builder, capital)


def open_type(glyphs: Mapping[str, Draw | T2CharString], subroutines: int = 0, capital: int = 700) -> bytes:
    """Returns a font with CFF outlines; each of its subroutines calls the next one ten times."""
    builder = _begun(glyphs, is_true_type=False)
    made = {}
    for name, draw in ((".notdef", nothing), *glyphs.items()):
        pen = T2CharStringPen(WIDTH, None)
        if not isinstance(draw, T2CharString):
            draw(pen)
        made[name] = draw if isinstance(draw, T2CharString) else pen.getCharString()
    builder.setupCFF("Test", {}, made, {})
    calls = builder.font["CFF "].cff.GlobalSubrs
    for k in range(subroutines):
        is_last = k + 1 == subroutines
        calls.append(
            T2CharString(program=["return"] if is_last else [k + 1 - 107, "callgsubr"] * 10 + ["return"])
        )
    return _ended(builder, capital)


def _begun(glyphs: Mapping[str, object], *, is_true_type: bool) -> FontBuilder:
    builder = FontBuilder(1000, isTTF=is_true_type)
    builder.setupGlyphOrder([".notdef", *glyphs])
    builder.setupCharacterMap({ord(name): name for name in glyphs if len(name) == 1})
    return builder


def _ended(builder: FontBuilder, capital: int) -> bytes:
    builder.setupHorizontalMetrics(dict.fromkeys(builder.font.getGlyphOrder(), (WIDTH, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupOS2(sCapHeight=capital)
    builder.setupNameTable({})
    builder.font.recalcBBoxes = False
    builder.setupPost()
    file = BytesIO()
    builder.save(file)
    return file.getvalue()


def round_bowl(pen: Any) -> None:
    """Draws a closed cubic curve and a line."""
    pen.moveTo((0, 0))
    pen.curveTo((0, 900), (500, 900), (500, 0))
    pen.closePath()


def compiled(text: str, data: bytes, name: str = "own.otf") -> pipeline.Compiled:
    return pipeline.compile(SourceFile("p.aidl", text), MemoryWorld({}, {name: data}))


def drawn_area(data: bytes, text: str) -> float:
    found = compiled(f'solid s {{ t = text("{text}", height: 7, font: "own.otf") }}', data)
    assert found.ok, [d.message for d in found.diagnostics]
    assert found.drawing is not None
    return sum(body.region.area for body in found.drawing.bodies)


# --- What is right ---------------------------------------------------------------------------------


@pytest.mark.parametrize("make", [true_type, open_type])
def test_outlines_and_widths(make: Callable[[Mapping[str, Draw]], bytes]) -> None:
    file = FontFile(make({"A": bar(0), " ": nothing}))
    curves, advance = file.outline("A")
    assert {p for curve in curves for p in curve} == {(0, 0), (0, 700), (500, 700), (500, 0)}
    assert advance == WIDTH
    assert file.outline(" ") == ((), WIDTH)
    assert file.capital_height == 700
    assert "B" not in file


def test_overlapping_contours_are_one() -> None:
    cross = both(bar(0, 300, 700, 400), bar(300, 0, 400, 700))
    for data in (true_type({"x": cross}), open_type({"x": cross})):
        assert drawn_area(data, "x") == pytest.approx(7 + 7 - 1)
    found = compiled(
        'drawing d { t = text("x", height: 7, font: "own.otf", outline: true) }', true_type({"x": cross})
    )
    assert found.model is not None
    (text,) = found.model.root.geometry
    lengths = sum(math.dist(c.start, c.end) for c in text.curves())  # type: ignore[union-attr]
    assert lengths == pytest.approx(28)


@pytest.mark.parametrize("bold", [False, True])
def test_united_contours_of_the_own_font_enclose_what_alternating_ones_do(bold: bool) -> None:
    """The own font read as one that may overlap."""
    name = "DejaVuSansAIDL-Bold.ttf" if bold else "DejaVuSansAIDL.ttf"
    data = resource(f"aidl_lang/common/fonts/{name}").read_bytes()
    word = "Aß8@§%g"
    plain = pipeline.compile(
        SourceFile("p", f'solid s {{ t = text("{word}", height: 7, bold: {str(bold).lower()}) }}')
    )
    assert plain.drawing is not None
    assert drawn_area(data, word) == pytest.approx(sum(b.region.area for b in plain.drawing.bodies), rel=1e-9)


# --- Where they are looked for ---------------------------------------------------------------------


def test_paths_are_relative_to_the_file_that_writes_the_text(tmp_path: Path) -> None:
    (tmp_path / "signs" / "fonts").mkdir(parents=True)
    (tmp_path / "signs" / "fonts" / "own.ttf").write_bytes(true_type({"A": bar()}))
    (tmp_path / "signs" / "sign.aidl").write_text(
        'drawing sign() { t = text("A", height: 7, font: "fonts/own.ttf") }', encoding="utf-8"
    )
    text = """import "signs/sign.aidl"
        assembly a { s = sign() drawing d { u = text("A", height: 7, font: "signs/fonts/own.ttf") } }"""
    found = pipeline.compile(SourceFile(str(tmp_path / "main.aidl"), text), DiskWorld(tmp_path))
    assert [d.message for d in found.diagnostics if d.is_error] == []


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("other.ttf", "`other.ttf` cannot be read: there is no such file"),
        ("../own.ttf", "`../own.ttf` cannot be read: it lies outside the project"),
        ("/etc/own.ttf", "`/etc/own.ttf` cannot be read: it lies outside the project"),
        ("large.ttf", "`large.ttf` cannot be read: it is too large"),
        ("link.ttf", "`link.ttf` cannot be read: it lies outside the project"),
        ("folder.ttf", "`folder.ttf` cannot be read: there is no such file"),
    ],
)
def test_files_that_cannot_be_read(tmp_path: Path, path: str, reason: str) -> None:
    root = tmp_path / "root"
    (root / "folder.ttf").mkdir(parents=True)
    (tmp_path / "own.ttf").write_bytes(DEJAVU)
    (root / "large.ttf").write_bytes(DEJAVU + bytes(10_000_000))
    (root / "link.ttf").symlink_to(tmp_path / "own.ttf")
    text = f'drawing d {{ t = text("A", height: 7, font: "{path}") }}'
    (found,) = pipeline.check(SourceFile("p.aidl", text), DiskWorld(root))
    assert (found.code, found.message) == ("E0359", reason)


def test_without_files_at_hand() -> None:
    (found,) = pipeline.check(SourceFile("p", 'drawing d { t = text("A", height: 7, font: "own.ttf") }'))
    assert found.message == "`own.ttf` cannot be read: only this text is at hand"


def test_programs_of_models_read_fonts_and_nothing_else() -> None:
    world = Programs(MemoryWorld({"notes.txt": "secret"}, {"own.ttf": DEJAVU}))
    assert world.read_bytes("own.ttf") == DEJAVU
    with pytest.raises(FileError) as caught:
        world.read_bytes("notes.txt")
    assert caught.value.reason is ReadFailure.ANOTHER_KIND


# --- What is broken, or made to do harm ------------------------------------------------------------


def _read(data: bytes) -> None:
    """Reads a font and some characters of it, within seconds."""
    with limited_to(10):
        file = FontFile(data)
        for character in "AHbgÄ&8":
            if character in file:
                file.outline(character)


def test_a_truncated_file_is_refused() -> None:
    refused = 0
    for length in range(0, len(DEJAVU), len(DEJAVU) // 60):
        try:
            _read(DEJAVU[:length])
        except FontError:
            refused += 1
    assert refused > 40


@pytest.mark.parametrize(
    "data", [DEJAVU, open_type({"A": bar(), "H": round_bowl, "b": bar()})], ids=["ttf", "otf"]
)
def test_wrong_bytes_are_refused_or_read(data: bytes) -> None:
    rng, refused, read = random.Random(7), 0, 0
    for _ in range(120):
        changed = bytearray(data)
        for _ in range(rng.choice([1, 4, 40])):
            changed[rng.randrange(min(len(data), rng.choice([400, len(data)])))] = rng.randrange(256)
        try:
            _read(bytes(changed))
            read += 1
        except FontError:
            refused += 1
    assert refused > 20
    assert read > 20


def _many(levels: int) -> dict[str, Draw]:
    """Returns glyphs of which each is made of ten of the next, so that the first is of 10^levels."""
    names = ["A", *(f"part{k}" for k in range(levels))]
    return {**{a: made_of(*[b] * 10) for a, b in pairwise(names)}, names[-1]: nothing}


def _called(first: int) -> T2CharString:
    return T2CharString(program=[first - 107, "callgsubr", "endchar"])


@pytest.mark.parametrize(
    "data",
    [
        true_type({"A": made_of("A")}),
        true_type({"A": made_of("B"), "B": made_of("A")}),
        true_type(_many(12)),
        open_type({"A": _called(0)}, subroutines=12),
        open_type({"A": T2CharString(program=[0, 0, 65, 65, "endchar"])}),
    ],
    ids=["of itself", "in a circle", "of ever more", "subroutines of ever more", "accent on itself"],
)
def test_characters_without_end_are_refused(data: bytes) -> None:
    with limited_to(10), pytest.raises(FontError):
        FontFile(data).outline("A")


def test_a_map_that_claims_all_characters_is_no_list_of_them() -> None:
    """Of 4,294,967,296 characters, a list would fill the memory."""
    runs = b"".join(struct.pack(">LLL", 0, 0xFFFFFFFF, 1) for _ in range(2000))
    table = struct.pack(">HHHHLHHLLL", 0, 1, 3, 10, 12, 12, 0, 16 + len(runs), 0, 2000) + runs
    data = _with_table(true_type({"A": bar()}), b"cmap", table)
    with limited_to(5):
        assert "A" in FontFile(data)


def test_outlines_that_share_their_bytes_are_refused() -> None:
    """With places that run to and fro each of many glyphs would have all bytes of the table."""
    data = true_type({"A": bar(), "H": bar()})
    with pytest.raises(FontError):
        FontFile(_with_table(data, b"loca", struct.pack(">HHHH", 0, 30, 0, 30))).outline("A")


def _with_table(data: bytes, tag: bytes, table: bytes) -> bytes:
    """Returns a font with a table in place of another, at the end of the file."""
    at = data.index(tag)
    return b"".join((data[: at + 8], struct.pack(">LL", len(data), len(table)), data[at + 16 :], table))


def test_a_broken_file_is_told() -> None:
    (found,) = compiled('drawing d { t = text("A", height: 7, font: "own.otf") }', DEJAVU[:5000]).diagnostics
    assert (found.code, found.message) == ("E0360", "`own.otf` cannot be drawn with: its contents are broken")
    (found,) = compiled('drawing d { t = text("A", height: 7, font: "own.otf") }', b"PK\3\4").diagnostics
    assert found.message == "`own.otf` cannot be drawn with: it is no TrueType or OpenType font"
    data = true_type({"A": made_of("A")})
    (found,) = compiled('drawing d { t = text("A", height: 7, font: "own.otf") }', data).diagnostics
    assert found.message.startswith("`own.otf` cannot be drawn with: it has a character made of more than")


def test_missing_characters_are_told() -> None:
    found = compiled('drawing d { t = text("AB", height: 7, font: "own.otf") }', open_type({"A": bar()}))
    (told,) = found.diagnostics
    assert (told.code, told.message) == ("E0350", "`own.otf` has no `B` (U+0042)")
