"""Lettering in a program: `glyphs(…)` makes one geometry of a whole text, `ink(…)` measures it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath

from aidl_lang.building.coerce import constant
from aidl_lang.building.state import Arguments, Interpreter
from aidl_lang.building.values import Num, TextVal, certain, kind_of, number
from aidl_lang.checking.units import LENGTH, PLAIN
from aidl_lang.common import lettering
from aidl_lang.common.font_files import FontError
from aidl_lang.common.lettering import Font, Glyph
from aidl_lang.common.prose import first_few
from aidl_lang.common.source import Span
from aidl_lang.common.world import FONTS, FileError, ReadFailure, relative_to

# --- The font that a text names: one that ships with the package, or a file beside the program.
#
# Paths follow the rules of imports: relative to the file in which the text is written, and inside the
# project.

PLAIN_FONT, SINGLE_LINE = "DejaVu Sans", "single line"
"""The names of the fonts that ship with the package."""


class NoFontError(Exception):
    """Raised for a font that there is not, with a diagnostic's code, message and hints."""

    def __init__(self, code: str, message: str, *hints: str) -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hints = list(hints)


def font_of(it: Interpreter, name: str, *, bold: bool) -> Font:
    """Returns the font of this name, for the text that is being built. Raises NoFontError or FontError."""
    if name == PLAIN_FONT:
        return lettering.bold_font() if bold else lettering.plain_font()
    if name == SINGLE_LINE:
        if bold:
            message = "letters of single lines cannot be bold: they are as wide as the tool"
            raise NoFontError("E0359", message, "leave out `bold`, or the font")
        return lettering.single_line_font()
    if PurePosixPath(name).suffix.lower() not in FONTS:
        raise NoFontError(
            "E0359",
            f'there is no font "{name}"',
            'name a font file beside the program, as in `font: "Lobster.ttf"`',
            "fonts of this machine are not looked through, as others have other ones",
            f'`font: "{PLAIN_FONT}"` is what texts have unasked, `font: "{SINGLE_LINE}"` is for engraving',
        )
    if bold:
        hint = "name the file of its bold face, and leave out `bold`"
        raise NoFontError("E0359", f"`{name}` is one face, and cannot be made bold", hint)
    return _of_file(it, name)


def _broken(name: str, reason: FontError) -> NoFontError:
    """Returns what to say of a font file that cannot be drawn with."""
    again = "get the file anew, or save it anew as .ttf or .otf with a program for fonts"
    return NoFontError("E0360", f"`{name}` cannot be drawn with: {reason}", again)


def _of_file(it: Interpreter, name: str) -> Font:
    if (world := it.program.resolution.world) is None:
        raise NoFontError("E0359", f"`{name}` cannot be read: only this text is at hand")
    try:
        path = relative_to(name, _writer(it))
        if path not in it.fonts:
            it.fonts[path] = lettering.font_of(world.read_bytes(path))
        return it.fonts[path]
    except FileError as error:
        hint = "paths are relative to the file that the text is written in"
        if error.reason is ReadFailure.OUTSIDE:
            hint = "copy it beside the program: only its own folder and those below it are read"
        raise NoFontError("E0359", f"`{name}` cannot be read: {error.reason}", hint) from None


def _writer(it: Interpreter) -> str:
    authored = (node for node in reversed(it.call_sites) if node.span.source not in it.library_sources)
    source = next(authored, it.program.main).span.source
    if source is it.program.main.source:
        return PurePosixPath(source.name.replace("\\", "/")).name
    return source.name


# --- Lettering in a program: `glyphs(…)` makes one geometry of a whole text, `ink(…)` measures it.
#
# A text is a single primitive: its place, height and angle are solved for, its curves follow when the
# solution is read out. Dozens of letters then cost the solver no more than one circle.


def typeset(it: Interpreter, a: Arguments) -> tuple[Glyph, ...]:
    """Returns the characters of a text in units of its height; empty after an error, reported here."""
    node = it.call_sites[-1]
    at = it.place(node)
    text, align, name = (certain(a[each], TextVal).value for each in ("text", "align", "font"))
    apart = constant(it, certain(a["line_spacing"], Num), node, "the spacing of lines")
    if align not in lettering.ALIGNMENTS:
        allowed = ", ".join(f'`"{word}"`' for word in lettering.ALIGNMENTS)
        message = f'"{align}" is not one of the words that are meant here'
        it.report("E0516", message, at, hints=[f"it is one of {allowed}"], once=True)
        return ()
    if apart is None:
        return ()
    if len(text) > it.limits.entities:
        it.count_entity(node, len(text))  # stops here, before the letters are set
    try:
        font = font_of(it, name, bold=a["bold"] is True)
        if unknown := lettering.unknown_characters(text, font):
            _report_unknown(it, unknown, at, name)
            return ()
        glyphs = lettering.typeset(text, align, apart, font)
    except (NoFontError, FontError) as reason:
        lack = reason if isinstance(reason, NoFontError) else _broken(name, reason)
        it.report(lack.code, lack.message, at, hints=lack.hints, once=True)
        return ()
    if not glyphs:
        hint = "write what is to be drawn, or leave the text out"
        it.report("E0351", "there is nothing to draw in this text", at, hints=[hint], once=True)
    return glyphs


def is_filled(a: Arguments, glyphs: Sequence[Glyph]) -> bool:
    """Tells whether a drawing fills the letters of a text."""
    return a["outline"] is not True and not any(glyph.is_stroked for glyph in glyphs)


_BRIDGE = 0.1  # width of the bridges of a stencil, in heights of a capital, where none is told


def bridge(it: Interpreter, a: Arguments) -> Num | None:
    """Returns how wide the bridges of a text are (see `Geometry.bridge`); None for none or an error."""
    stencil, node = a["stencil"], it.call_sites[-1]
    if stencil is False:
        return None
    if a["font"] == TextVal(SINGLE_LINE):
        what = "letters of single lines enclose nothing that a stencil could hold"
        it.report("E0342", what, it.place(node), hints=["leave out `stencil`, or the font"], once=True)
        return None
    if stencil is True:
        return number(_BRIDGE, PLAIN)
    width = constant(it, stencil, node, "the width of bridges") if isinstance(stencil, Num) else 0.0
    if width is not None and width <= 0:
        given = f"{width:g}" if isinstance(stencil, Num) else kind_of(stencil)
        hint = "write `stencil: true` for a tenth of the height, or how wide they are: `stencil: 2mm`"
        message = f"`stencil` is {given}, and bridges have a width"
        it.report("E0342", message, it.place(node), hints=[hint], once=True)
    return number(width, LENGTH) if width and width > 0 else None


def _report_unknown(it: Interpreter, unknown: list[str], at: Span | None, font: str) -> None:
    names = first_few(list(map(lettering.described, unknown)), 5)
    others = {c: lettering.replacement(c) for c in unknown[:5]}
    instead = [f"write `{other}` for `{c}`" for c, other in others.items() if other is not None]
    if font != PLAIN_FONT:
        it.report("E0350", f"`{font}` has no {names}", at, hints=instead, once=True)
        return
    has = "it has Latin, Greek and Cyrillic letters, digits, punctuation, and signs such as `±` `°` `Ø` `→`"
    it.report("E0350", f"the font has no {names}", at, hints=[*instead, has], once=True)
