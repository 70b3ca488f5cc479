"""Names of files for single parts, made of a pattern such as `parts/{part}.dxf`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePath
from typing import Protocol

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean, listed, ticked
from aidl_lang.export import Exported, ExportError, file_names
from aidl_lang.export.cut_list import Item

WORDS = ("part", "number", "material", "quantity")
_TELLING = ("part", "number")
"""Of these, what is another for each item."""
_WORD = re.compile(r"\{([A-Za-z_]+)\}")
_REFUSED = re.compile(r"[^\w.+-]+")
"""What file systems do not take, or take for something else: all but letters, digits, `_`, `.`, `+`, `-`."""
_RESERVED = re.compile(r"(con|prn|aux|nul|conin\$|conout\$|com\d|lpt\d)(\..*)?", re.IGNORECASE)
"""Names that stand for devices on Windows, whatever their suffix."""
_LONGEST = 80
"""Characters of a name of a part."""


def is_pattern(name: str) -> bool:
    """Tells whether the name of an output is one for each part. Raises ExportError (E0926) for a word that
    stands for nothing, and if all parts would go into one file.
    """
    words = _WORD.findall(name)
    for word in words:
        if word not in WORDS:
            raise ExportError(
                "E0926",
                f"`{{{word}}}` in `{name}` stands for nothing",
                *(
                    did_you_mean(_braced(nearest(word, WORDS)))
                    or [f"there are {listed(ticked(_braced(WORDS)))}"]
                ),
            )
    if words and not set(words) & set(_TELLING):
        raise ExportError(
            "E0926",
            f"`{name}` is one name for several parts",
            "name them apart: with `{part}`, or with `{number}`",
        )
    return bool(words)


def _braced(words: Sequence[str]) -> list[str]:
    return [f"{{{word}}}" for word in words]


class Writing(Protocol):
    """Writes a drawing in the format of a suffix, as a whole or part by part."""

    def __call__(self, suffix: str) -> Exported: ...

    def parts(self, suffix: str) -> list[tuple[Item, Exported]]: ...


def contents(
    writing: Writing, name: str, suffix: str
) -> tuple[list[tuple[str, bytes]], tuple[Diagnostic, ...]]:
    """Returns all files of an output, each with its name, and diagnostics about them. Raises as `writing`
    does.
    """
    if not is_pattern(name):
        made = writing(suffix)
        datas = (made.data, *made.further)
        return list(zip(file_names(name, len(datas)), datas, strict=True)), made.notes
    parts = writing.parts(suffix)
    items = [item for item, _ in parts]
    names, notes = names_of_parts(name, items)
    several = [
        f"`{PurePath(n).stem}` ×{i.quantity}" for n, i in zip(names, items, strict=True) if i.quantity > 1
    ]
    if several and "quantity" not in _WORD.findall(name):
        notes.append(_several_note(several))
    files = []
    for own, (_, made) in zip(names, parts, strict=True):
        datas = (made.data, *made.further)
        files += list(zip(file_names(own, len(datas)), datas, strict=True))
        notes += made.notes
    return files, tuple(dict.fromkeys(notes))


def names_of_parts(pattern: str, items: Sequence[Item]) -> tuple[list[str], list[Diagnostic]]:
    """Returns a name for each item, no two of them alike, with a warning if some had to be told apart."""
    taken: set[str] = set()
    names, changed = [], []
    for item in items:
        wanted = PurePath(_filled(pattern, item))
        path, count = wanted, 1
        # Some file systems take capital and small letters for the same.
        while str(path).casefold() in taken:
            count += 1
            path = wanted.with_name(f"{wanted.stem}-{count}{wanted.suffix}")
        taken.add(str(path).casefold())
        names.append(str(path))
        if count > 1:
            changed.append(str(path))
    return names, [_changed_note(pattern, changed)] if changed else []


def _filled(pattern: str, item: Item) -> str:
    values = {
        "part": _safe(item.name.replace(", ", "+")),
        "number": str(item.number),
        "material": _safe(item.material) if item.material else "no-material",
        "quantity": str(item.quantity),
    }
    return _WORD.sub(lambda found: values[found[1]], pattern)


def _safe(text: str) -> str:
    """Returns a text as a name that every file system takes for a plain file."""
    name = _REFUSED.sub("-", text)[:_LONGEST].strip("-. ") or "part"
    return f"{name}_" if _RESERVED.fullmatch(name) else name


def _changed_note(pattern: str, changed: Sequence[str]) -> Diagnostic:
    return Diagnostic(
        "W0758",
        f"`{pattern}` gives several parts one name: {listed(ticked(changed), 4)} "
        f"{'is' if len(changed) == 1 else 'are'} numbered",
        hints=("`{number}` tells them apart: `{number}-{part}`",),
    )


def _several_note(several: Sequence[str]) -> Diagnostic:
    return Diagnostic(
        "N0759",
        f"a file has one piece, and several are to be cut: {listed(several, 8)}",
        hints=("`{quantity}` in the name of an output says how many: `{number}-{part}-x{quantity}`",),
    )
