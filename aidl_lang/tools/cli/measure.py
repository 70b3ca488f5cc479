"""`aidl measure`: areas, inertia, walls, gaps and masses of what a program draws."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from aidl_lang.common.prose import counted
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError, exit_code, show
from aidl_lang.tools.cli.options import add_params, add_program, flag, value

if TYPE_CHECKING:
    from aidl_lang.geometry.boolean import Contact
    from aidl_lang.geometry.curves import Vec
    from aidl_lang.geometry.survey import Part, Survey, Width
    from aidl_lang.pipeline import Compiled

_MOST_PAIRS = 20
_NOTHING = "–"


def register_measure(parser: argparse.ArgumentParser) -> None:
    """`aidl measure`: areas, inertia, walls, gaps and masses of what a program draws."""
    add_program(parser)
    parser.add_argument(
        "paths", nargs="*", metavar="PATH", help="a structure or a geometry (default: each body)"
    )
    add_params(parser)
    value(
        parser,
        "--density",
        "NAME=KG/M3",
        "the density of a material; may be given several times",
        _density,
        [],
        dest="densities",
        action="append",
    )
    flag(parser, "--json", "print everything as JSON, with all digits")
    parser.set_defaults(run=run_measure)


def run_measure(arguments: argparse.Namespace) -> int:
    from aidl_lang import pipeline
    from aidl_lang.geometry.survey import NothingThereError

    source, world = files.read(arguments.file), files.world(arguments.file)
    compiled = pipeline.compile(source, world, params=dict(arguments.params))
    if not compiled.ok:
        show(compiled.diagnostics)
        return exit_code(compiled.diagnostics) or 1
    try:
        found = compiled.surveyed(arguments.paths, dict(arguments.densities))
    except NothingThereError as reason:
        raise UseError.of(reason.diagnostic) from None
    show([*compiled.diagnostics, *found.notes])
    if arguments.json:
        _print_json(compiled, found)
    else:
        print("\n".join(_lines(found, bool(arguments.paths))))
    return exit_code(compiled.diagnostics)


def _density(text: str) -> tuple[str, float]:
    name, _, number = (part.strip() for part in text.rpartition("="))
    try:
        value = float(number.lower().removesuffix("kg/m3").removesuffix("kg/m³"))
    except ValueError:
        value = 0.0
    if not (name and 0 < value < 1e6):
        raise argparse.ArgumentTypeError(f'expected NAME=KG/M3, as in "oak=720", not `{text}`')
    return name, value


# --- Text ----------------------------------------------------------------------------------------


def _lines(found: Survey, asked: bool) -> Iterator[str]:
    from aidl_lang.common.render import escape

    yield from map(escape, _text(found, asked))


def _text(found: Survey, asked: bool) -> Iterator[str]:
    from aidl_lang.geometry.survey import some_of

    yield from _block(found.whole)
    if asked:
        for part in found.parts:
            if part is not found.whole:
                yield ""
                yield from _block(part)
    elif len(found.parts) > 1 or (found.parts and found.parts[0] is not found.whole):
        yield ""
        yield from _table(found.parts)
    if found.pairs:
        yield ""
        yield from _pairs(found)
    if found.alone:
        yield f"touches no other: {some_of(found.alone)}"


def _block(part: Part) -> Iterator[str]:
    """Yields all measures of a part."""
    kinds = {"bodies": counted(part.bodies, "body", "bodies"), "body": "a body"}
    yield f"{part.path}: {kinds.get(part.kind, part.kind)}"
    left, bottom, right, top = part.box
    size = max(right - left, top - bottom)
    squares, tiny = part.inertia, 1e-9 * part.inertia.polar
    largest, least = squares.principal
    rows = [
        ("area", f"{_number(part.area)} mm²"),
        ("perimeter", f"{_number(part.perimeter)} mm"),
        ("size", f"{_number(right - left)} × {_number(top - bottom)} mm"),
        ("box", f"{_place((left, bottom), size)} to {_place((right, top), size)}"),
        ("centroid", _place(part.centroid, size)),
        ("outline", f"{counted(part.pieces, 'piece')}, {counted(part.holes, 'hole')}"),
        (
            "moments",
            f"Ixx {_number(squares.xx)}, Iyy {_number(squares.yy)}, Ixy {_number(squares.xy, tiny)} mm⁴ "
            f"about the centroid",
        ),
        (
            "",
            f"{_number(largest)} about the axis at {_number(squares.angle, 1e-9)}°, "
            f"{_number(least)} across it, polar {_number(squares.polar)} mm⁴",
        ),
        ("wall", _width(part.wall, part, size)),
        ("gap", _width(part.gap, part, size)),
    ]
    if part.thickness is not None:
        rows.append(("thickness", f"{_number(part.thickness)} mm"))
    if part.material is not None:
        known = f"{_number(part.density)} kg/m³" if part.density else "density not known"
        rows.append(("material", f"{part.material}, {known}"))
    if part.quantity > 1:
        rows.append(("quantity", f"{part.quantity} pieces, of which this is one"))
    if part.volume is not None:
        rows.append(("volume", f"{_number(part.volume)} mm³"))
    if part.mass is not None:
        rows.append(("mass", _mass(part.mass)))
    for name, said in rows:
        yield f"  {name:<11}{said}"


def _width(width: Width | None, part: Part, size: float) -> str:
    if width is None:
        return "none"
    inside = f" in {width.part}" if width.part != part.path else ""
    return f"{_number(width.length)} mm, from {_place(width.a, size)} to {_place(width.b, size)}{inside}"


def _table(parts: Sequence[Part]) -> Iterator[str]:
    """Yields one line for each body."""
    heads = (
        "body",
        "area mm²",
        "perimeter mm",
        "size mm",
        "holes",
        "wall mm",
        "gap mm",
        "mass g",
        "quantity",
    )
    rows = [heads]
    for p in parts:
        left, bottom, right, top = p.box
        rows.append(
            (
                p.path,
                _number(p.area),
                _number(p.perimeter),
                f"{_number(right - left)} × {_number(top - bottom)}",
                str(p.holes),
                _number(p.wall.length) if p.wall else _NOTHING,
                _number(p.gap.length) if p.gap else _NOTHING,
                _number(p.mass) if p.mass is not None else _NOTHING,
                str(p.quantity) if any(each.quantity > 1 for each in parts) else _NOTHING,
            )
        )
    shown = [k for k in range(len(heads)) if any(row[k] != _NOTHING for row in rows[1:])]
    widths = [max(len(row[k]) for row in rows) for k in shown]
    for row in rows:
        cells = [f"{row[k]:{'<' if k == 0 else '>'}{width}}" for k, width in zip(shown, widths, strict=True)]
        yield "  ".join(cells).rstrip()


def _pairs(found: Survey) -> Iterator[str]:
    rows = found.pairs[:_MOST_PAIRS]
    one, other = (max(len(getattr(p, side)) for p in rows) for side in ("a", "b"))
    for pair in rows:
        yield f"{pair.a:<{one}}  {pair.b:<{other}}  {_relation(pair)}"
    if more := len(found.pairs) - len(rows):
        yield f"and {counted(more, 'more pair')}, {_relation(found.pairs[_MOST_PAIRS])} or further"
    if found.is_partial:
        yield "pairs that are far from each other are not listed"


def _relation(pair: Contact) -> str:
    if pair.relation == "apart":
        return f"{_number(pair.gap or 0.0)} mm apart"
    return f"overlapping, {_number(pair.area or 0.0)} mm²" if pair.relation == "overlapping" else "touching"


def _number(value: float, tiny: float = 0.0) -> str:
    """Writes six digits; nothing below `tiny`."""
    return f"{0.0 if abs(value) <= tiny else value:.6g}"


def _place(p: Vec, size: float) -> str:
    return f"({_number(p[0], 1e-9 * size)}, {_number(p[1], 1e-9 * size)})"


def _mass(grams: float) -> str:
    return f"{_number(grams)} g" if grams < 1000 else f"{_number(grams / 1000)} kg"


# --- JSON ----------------------------------------------------------------------------------------


def _print_json(compiled: Compiled, found: Survey) -> None:
    import json

    from aidl_lang.common.prose import rounded
    from aidl_lang.common.render import to_dict

    document = {
        "units": "mm",
        "whole": found.whole.to_dict(),
        "parts": [part.to_dict() for part in found.parts],
        "pairs": [_pair_dict(pair) for pair in found.pairs],
        "all_pairs": not found.is_partial,
        "alone": list(found.alone),
        "diagnostics": [to_dict(d) for d in [*compiled.diagnostics, *found.notes]],
    }
    print(json.dumps(rounded(document), indent=1, ensure_ascii=False, allow_nan=False))


def _pair_dict(pair: Contact) -> dict[str, Any]:
    entry = {name: getattr(pair, name) for name in ("a", "b", "relation", "gap", "area")}
    return {name: value for name, value in entry.items() if value is not None}
