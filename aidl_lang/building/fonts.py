"""The font that a text names: one that ships with the package, or a file beside the program.

Paths follow the rules of imports: relative to the file in which the text is written, and inside the project.
"""

from __future__ import annotations

from pathlib import PurePosixPath

from aidl_lang.building.state import Interpreter
from aidl_lang.common import lettering
from aidl_lang.common.font_files import SUFFIXES, FontError
from aidl_lang.common.lettering import Font
from aidl_lang.common.world import FileError, ReadFailure, relative_to

PLAIN, SINGLE_LINE = "DejaVu Sans", "single line"
"""The names of the fonts that ship with the package."""


class NoFontError(Exception):
    """Raised for a font that there is not, with a diagnostic's code, message and hints."""

    def __init__(self, code: str, message: str, *hints: str) -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hints = list(hints)


def font(it: Interpreter, name: str, *, bold: bool) -> Font:
    """Returns the font of this name, for the text that is being built. Raises NoFontError."""
    if name == PLAIN:
        return lettering.bold_font() if bold else lettering.plain_font()
    if name == SINGLE_LINE:
        if bold:
            raise NoFontError(
                "E0359",
                "letters of single lines cannot be bold: they are as wide as the tool",
                "leave out `bold`, or the font",
            )
        return lettering.single_line_font()
    if PurePosixPath(name).suffix.lower() not in SUFFIXES:
        raise NoFontError(
            "E0359",
            f'there is no font "{name}"',
            'name a font file beside the program, as in `font: "Lobster.ttf"`',
            "fonts of this machine are not looked through, as others have other ones",
            f'`font: "{PLAIN}"` is what texts have unasked, `font: "{SINGLE_LINE}"` is for engraving',
        )
    if bold:
        raise NoFontError(
            "E0359",
            f"`{name}` is one face, and cannot be made bold",
            "name the file of its bold face, and leave out `bold`",
        )
    return _of_file(it, name)


def broken(name: str, reason: FontError) -> NoFontError:
    """Returns what to say of a font file that cannot be drawn with."""
    again = "get the file anew, or save it anew as .ttf or .otf with a program for fonts"
    return NoFontError("E0360", f"`{name}` cannot be drawn with: {reason}", again)


def _of_file(it: Interpreter, name: str) -> Font:
    world = it.program.resolution.world
    if world is None:
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
    except FontError as reason:
        raise broken(name, reason) from None


def _writer(it: Interpreter) -> str:
    authored = (node for node in reversed(it.call_sites) if node.span.source not in it.library_sources)
    source = next(authored, it.program.main).span.source
    if source is it.program.main.source:
        return PurePosixPath(source.name.replace("\\", "/")).name
    return source.name
