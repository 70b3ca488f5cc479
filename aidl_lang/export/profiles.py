"""Profiles of workshops, and the files that hold them."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any

from aidl_lang.common.colors import css_color, hexadecimal, rgb
from aidl_lang.common.names import fold, nearest
from aidl_lang.common.prose import did_you_mean, listed, shortened, ticked
from aidl_lang.common.records import record
from aidl_lang.export.job import ExportError

if TYPE_CHECKING:
    from aidl_lang.export.cuts import Outline


# A machine is told by colours or by layers what to do with a line. A profile is the table of that: for each
# operation its colour, the width of its lines and its layer, the same in every format.

FILL, ENGRAVE, SCORE, INNER, OUTER = OPERATIONS = ("fill", "engrave", "score", "inner", "outer")
"""Areas that are engraved, lines that are engraved or scored, cuts inside parts, and those around them."""
CUT = "cut"
"""As the operation of a layer: the outlines of parts stay what they are, and lines are cut as inner ones."""
CUTS = (INNER, OUTER)
ON_PARTS = (FILL, ENGRAVE, SCORE)


@record()
class Look:
    """A colour, as `#rrggbb`; the width of lines, mm; the name of a layer, None for that of the program."""

    color: str
    width: float = 0.1
    layer: str | None = None


@record()
class Layer:
    """What is done with all on a layer, one of `OPERATIONS` or `CUT`, and its look if it has one."""

    operation: str
    look: Look | None = None


_BY_NAME = {name: Layer(name) for name in (*OPERATIONS, CUT)}
"""Layers that are named after what is done with them."""


@record()
class Profile:
    """A table of operations.

    looks    by operation
    order    of the operations in the file
    layers   of the program, by their folded name
    letters  the operation for letters in drawings, `fill` or `engrave`
    keeps_colors  whether what is engraved keeps the colour that the program gives it
    """

    name: str
    looks: Mapping[str, Look]
    order: tuple[str, ...] = OPERATIONS
    layers: Mapping[str, Layer] = field(default_factory=lambda: _BY_NAME)
    letters: str = FILL
    keeps_colors: bool = False

    def knows(self, layer: str) -> bool:
        """Tells whether the profile says what becomes of a layer of the program."""
        return fold(layer) in self.layers

    def operation(self, layer: str | None, by_kind: str) -> str:
        """Returns what is done with a line on a layer, which is `by_kind` where the layer does not say."""
        found = self.layers.get(fold(layer)) if layer is not None else None
        if found is None:
            return by_kind
        if found.operation != CUT:
            return found.operation
        return by_kind if by_kind in CUTS else INNER

    def look(self, layer: str | None, operation: str) -> Look:
        found = self.layers.get(fold(layer)) if layer is not None else None
        return self.looks[operation] if found is None or found.look is None else found.look

    def color(self, outline: Outline) -> str:
        if self.keeps_colors and outline.operation not in CUTS and outline.style.color is not None:
            return hexadecimal(rgb(outline.style.color))
        return self.look(outline.style.layer, outline.operation).color


_PLAIN_COLORS = ("#000000", "#0000ff", "#008000", "#ff0000", "#ff0000")
PLAIN = Profile(
    "plain",
    {op: Look(color) for op, color in zip(OPERATIONS, _PLAIN_COLORS, strict=True)},
    letters=ENGRAVE,
    keeps_colors=True,
)
"""Red to cut and blue to engrave, on the layers of the program; nothing but what is asked for is filled."""


_MACHINES = """
lightburn 0.1 #000000 C00-fill #0000ff C01-engrave #00e000 C03-score #ff8000 C05-inner #a00000 C10-outer
glowforge 0.1 #000000 fill #0000ff engrave #00ff00 score #ff0000 inner #ff00ff outer
ponoko 0.01 #000000 area-engraving #ff0000 line-engraving #ff0000 line-engraving \
    #0000ff cutting #0000ff cutting
"""
"""The width of all lines, and a colour and a layer for each operation: colours of LightBurn's palette, from
the front of it to the back as they are carried out; colours that rise, by which Glowforge lists the steps.
"""


def _of_machine(row: str) -> Profile:
    name, width, *said = row.split()
    looks = (Look(color, float(width), layer) for color, layer in zip(said[::2], said[1::2], strict=True))
    return Profile(name, dict(zip(OPERATIONS, looks, strict=True)))


PROFILES = {made.name: made for made in (PLAIN, *map(_of_machine, _MACHINES.strip().splitlines()))}


# --- Profiles of workshops in files of their own: TOML, with every key and value checked.

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
        return replace(
            base,
            name=self._name,
            looks=looks,
            order=self._order(table.get("order", list(base.order))),
            letters=self._word(table.get("letters", base.letters), (FILL, ENGRAVE), "letters"),
            layers={**base.layers, **{fold(k): self._layer(said, k, looks) for k, said in layers.items()}},
        )

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
            hint = f"the usual one is {listed(ticked(OPERATIONS))}"
            raise _wrong(self._name, f"`order` names each operation once, not {_shown(said)}", hint)
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
    return f"`{shortened(text, 60)}`"
