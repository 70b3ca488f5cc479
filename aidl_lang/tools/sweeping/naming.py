"""The names of the files that a sweep writes: a pattern such as `out/{width}-{style}.dxf`, with the values of
a variant in it. Whatever a value says, its file lies where the pattern says.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping
from pathlib import PurePath

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.names import fold, nearest
from aidl_lang.common.prose import did_you_mean, first_few, ticked
from aidl_lang.common.records import record
from aidl_lang.tools.sweeping.axes import Value, shown
from aidl_lang.tools.sweeping.plan import Plan, Variant

NUMBER = "n"
"""The field for the number of a variant."""
_FIELD = re.compile(r"\{([^{}]*)\}")
_LONGEST = 60
"""Bytes of one value in a name; file systems take 255 for the whole."""
_RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\..*)?")


@record()
class Pattern:
    """The pattern of a name.

    parts    its texts and, at odd places, its fields
    written  the values that params have where a variant does not set them
    """

    text: str
    suffix: str
    parts: tuple[str, ...]
    written: Mapping[str, Value]

    @property
    def folder(self) -> PurePath:
        """Returns the folder that the names of all variants have in common."""
        return PurePath(f"{self.parts[0]}x").parent

    def named(self, variant: Variant) -> str:
        """Returns the name for a variant."""
        return "".join(self._value(part, variant) if k % 2 else part for k, part in enumerate(self.parts))

    def _value(self, field: str, variant: Variant) -> str:
        if field == NUMBER:
            return str(variant.number)
        if field in variant.labels:
            return safe(variant.labels[field])
        return safe(shown(variant.values.get(field, self.written.get(field, ""))))


def has_fields(text: str) -> bool:
    """Tells whether a name is a pattern: one file for each variant."""
    return _FIELD.search(text) is not None


def pattern(text: str, suffix: str, plan: Plan) -> Pattern:
    """Reads a pattern, which names params and columns of a plan. Raises AidlError."""
    fields = [*plan.labels, *plan.paths]
    parts = _FIELD.split(text)
    by_name = {fold(name): name for name in [*fields, NUMBER]}
    for k in range(1, len(parts), 2):
        known = by_name.get(fold(parts[k].strip()))
        if known is None:
            near = did_you_mean(nearest(parts[k], fields)[:1])
            there = first_few(ticked([f"{{{name}}}" for name in [*fields, NUMBER]]), 12)
            raise AidlError(
                Diagnostic(
                    "E0973",
                    f"`{text}` names `{{{parts[k]}}}`, which is not varied",
                    hints=(*near, f"there is {there}"),
                )
            )
        parts[k] = known
    return Pattern(text, suffix, tuple(parts), {path: knob.value for path, knob in plan.knobs.items()})


def safe(text: str) -> str:
    """Returns a value as a part of a file's name: letters, digits and a few marks, of bounded length, and
    never one that a file system reads otherwise (`..`, `CON`, a leading dot).
    """
    kept = "".join(c if _is_plain(c) else "_" for c in unicodedata.normalize("NFC", text))
    kept = re.sub(r"__+", "_", kept).strip("_. ") if kept != text else kept
    kept = re.sub(r"\.\.+", ".", kept).lstrip(".").rstrip(". ")
    while len(kept.encode()) > _LONGEST:
        kept = kept[:-1]
    return f"_{kept}" if not kept or _RESERVED.fullmatch(kept) else kept


def _is_plain(character: str) -> bool:
    return character.isalnum() or character in "-+._" or unicodedata.category(character) == "Mn"


def distinct(names: Iterable[str]) -> Iterator[str]:
    """Yields the names of variants made different: of several that a file system may take for one, each but
    the first gets its number.
    """
    taken: set[str] = set()
    for number, name in enumerate(names, 1):
        made, path, mark = name, PurePath(name), f"~{number}"
        while (key := unicodedata.normalize("NFC", made).casefold()) in taken:
            made = str(path.with_name(f"{path.stem}{mark}{path.suffix}"))
            mark += "~"
        taken.add(key)
        yield made
