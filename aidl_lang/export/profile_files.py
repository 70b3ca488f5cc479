"""Profiles of workshops in files of their own: TOML, with every key and value checked."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

from aidl_lang.common.colors import css_color, hexadecimal, rgb
from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean, listed, ticked
from aidl_lang.export import ExportError
from aidl_lang.export.profiles import CUT, ENGRAVE, FILL, OPERATIONS, PROFILES, Layer, Look, Profile

_KEYS = ("base", "order", "letters", "layers", *OPERATIONS)
_LOOK = ("color", "width", "layer", "colour")
_FIELDS = {"colour": "color"}
THINNEST, WIDEST = 0.001, 5.0
"""Widths of lines, mm."""
_LONGEST = 255
"""Characters of the name of a layer, as DXF has them."""


def parsed(text: str, name: str) -> Profile:
    """Returns the profile in the text of a file called `name`. Raises ExportError (E0957)."""
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as reason:
        raise _wrong(name, f"it is not TOML: {reason}") from None
    except RecursionError:
        raise _wrong(name, "its values are nested too deeply") from None
    return _Reader(name).profile(table)


def _wrong(name: str, what: str, *hints: str) -> ExportError:
    return ExportError("E0957", f"the profile `{name}` cannot be used: {what}", *hints)


class _Reader:
    """Reads the tables of a file; its errors name the key."""

    def __init__(self, name: str) -> None:
        self._name = name

    def profile(self, table: Mapping[str, Any]) -> Profile:
        self._known(table, _KEYS, "")
        base = PROFILES[self._word(table.get("base", "plain"), PROFILES, "base")]
        looks = {op: self._look(table.get(op, {}), base.looks[op], op, _LOOK) for op in OPERATIONS}
        layers = self._table(table.get("layers", {}), "layers")
        made = replace(
            base,
            name=self._name,
            looks=looks,
            order=self._order(table.get("order", list(base.order))),
            letters=self._word(table.get("letters", base.letters), (FILL, ENGRAVE), "letters"),
        )
        return made.with_layers({layer: self._layer(said, layer, looks) for layer, said in layers.items()})

    def _layer(self, said: Any, layer: str, looks: Mapping[str, Look]) -> Layer:
        where = f"layers.{layer}"
        if isinstance(said, str):
            return Layer(self._word(said, (*OPERATIONS, CUT), where))
        table = self._table(said, where, "the name of an operation, or a table")
        if "as" not in table:
            raise _wrong(self._name, f"`{where}` does not say what is done with it", 'say it: `as = "score"`')
        operation = self._word(table["as"], OPERATIONS, f"{where}.as")
        return Layer(operation, self._look(table, looks[operation], where, ("as", *_LOOK)))

    def _look(self, said: Any, base: Look, where: str, keys: Iterable[str]) -> Look:
        table = self._table(said, where)
        self._known(table, keys, f"{where}.")
        made = base
        readers: dict[str, Callable[[Any, str], Any]] = {
            "color": self._color,
            "colour": self._color,
            "width": self._width,
            "layer": self._layer_name,
        }
        for key, read in readers.items():
            if key in table:
                made = replace(made, **{_FIELDS.get(key, key): read(table[key], f"{where}.{key}")})
        return made

    def _known(self, table: Mapping[str, Any], keys: Iterable[str], where: str) -> None:
        known = tuple(keys)
        for key in table:
            if key not in known:
                near = did_you_mean(nearest(key, known)) or [f"there are {listed(ticked(known))}"]
                raise _wrong(self._name, f"there is no key `{where}{key}`", *near)

    def _table(self, said: Any, where: str, wanted: str = "a table") -> Mapping[str, Any]:
        if not isinstance(said, Mapping):
            raise _wrong(self._name, f"`{where}` is {wanted}, not {_shown(said)}")
        return said

    def _word(self, said: Any, words: Iterable[str], where: str) -> str:
        known = tuple(words)
        if said not in known:
            near = did_you_mean(nearest(said, known)) if isinstance(said, str) else []
            wanted = listed(ticked(known), last="or")
            raise _wrong(self._name, f"`{where}` is {wanted}, not {_shown(said)}", *near)
        return str(said)

    def _order(self, said: Any) -> tuple[str, ...]:
        if not isinstance(said, list) or sorted(map(str, said)) != sorted(OPERATIONS):
            raise _wrong(
                self._name,
                f"`order` names each operation once, not {_shown(said)}",
                f"the usual one is {listed(ticked(OPERATIONS))}",
            )
        return tuple(map(str, said))

    def _color(self, said: Any, where: str) -> str:
        color = css_color([said]) if isinstance(said, str) else None
        if color is None:
            raise _wrong(self._name, f'`{where}` is a colour such as "#ff0000" or "red", not {_shown(said)}')
        return hexadecimal(rgb(color))

    def _width(self, said: Any, where: str) -> float:
        is_number = isinstance(said, int | float) and not isinstance(said, bool)
        if not is_number or not THINNEST <= said <= WIDEST:
            wanted = f"millimetres from {THINNEST:g} to {WIDEST:g}"
            raise _wrong(self._name, f"`{where}` is {wanted}, not {_shown(said)}")
        return float(said)

    def _layer_name(self, said: Any, where: str) -> str:
        if not isinstance(said, str) or not 0 < len(said.strip()) <= _LONGEST:
            raise _wrong(self._name, f"`{where}` is a name of 1 to {_LONGEST} letters, not {_shown(said)}")
        return said


def _shown(value: Any) -> str:
    text = f'"{value}"' if isinstance(value, str) else str(value)
    return f"`{text if len(text) <= 60 else text[:59] + '…'}`"
