"""What a dialog for exports offers: the formats, and one table of options, each with what it does.

An option of the command becomes one of the dialog by a line of `OPTIONS`.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from aidl_lang.checking import units
from aidl_lang.common.records import record
from aidl_lang.export import FORMATS, OFFERED, Exported, Format, Options, file_names
from aidl_lang.export.profiles import PROFILES
from aidl_lang.export.themes import THEMES

Change = Callable[[Options, str], Options]
"""Returns the options with what was given for one of them. Raises ValueError."""


@record()
class Option:
    """An option of the dialog.

    label    what stands before its field
    hint     an example, shown in the empty field
    change   puts what was given, which is not empty, into the options
    choices  what may be given; empty for what is typed
    fits     tells whether a format has it
    """

    name: str
    label: str
    hint: str
    change: Change
    choices: tuple[str, ...] = ()
    fits: Callable[[Format], bool] = lambda made: made.cuts


_NESTING = 5.0
"""Seconds for packing parts by their outlines."""


def _nested(options: Options, given: str) -> Options:
    return replace(options, nest=_NESTING if given == "outlines" else None)


def _profiled(options: Options, given: str) -> Options:
    return replace(options, profile=PROFILES[given])


def _is_picture(made: Format) -> bool:
    return made.tiles


OPTIONS = (
    Option("sheet", "Sheet", "600x400, a3", lambda o, given: replace(o, sheet=units.size(given))),
    Option("spacing", "Spacing", "3mm", lambda o, given: replace(o, spacing=units.length(given))),
    Option("nest", "Packed by", "boxes", _nested, ("boxes", "outlines")),
    Option("kerf", "Kerf", "0.15mm", lambda o, given: replace(o, kerf=units.length(given))),
    Option("profile", "Profile", "plain", _profiled, tuple(PROFILES)),
    Option("theme", "Theme", "colour", lambda o, given: replace(o, theme=given), THEMES, _is_picture),
    Option("tile", "Pages", "a4", lambda o, given: replace(o, tile=units.size(given)), fits=_is_picture),
)


def offered() -> dict[str, Any]:
    """Returns the formats, and the options with the formats that have each, as JSON."""
    return {
        "formats": [{"name": name, "label": label} for name, label in OFFERED.items()],
        "options": [
            {
                "name": option.name,
                "label": option.label,
                "hint": option.hint,
                "choices": option.choices,
                "formats": [name for name in OFFERED if option.fits(FORMATS[f".{name}"])],
            }
            for option in OPTIONS
        ],
    }


def changed(options: Options, given: Mapping[str, str]) -> Options:
    """Returns options with what was given in the dialog. Raises ValueError."""
    known = {option.name: option for option in OPTIONS}
    for name, text in given.items():
        if name not in known:
            raise ValueError(f"there is no option `{name}`")
        option, text = known[name], text.strip()
        if not text:
            continue
        if option.choices and text not in option.choices:
            raise ValueError(f"{option.label.lower()} is one of {', '.join(option.choices)}, not `{text}`")
        options = option.change(options, text)
    return options


def packed(stem: str, suffix: str, made: Exported) -> tuple[str, bytes]:
    """Returns the name and the content of what is saved: the file, or an archive of several."""
    if not made.further:
        return stem + suffix, made.data
    archive = io.BytesIO()
    contents = (made.data, *made.further)
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as writing:
        for name, data in zip(file_names(stem + suffix, len(contents)), contents, strict=True):
            writing.writestr(zipfile.ZipInfo(name), data)
    return f"{stem}-{suffix[1:]}.zip", archive.getvalue()
