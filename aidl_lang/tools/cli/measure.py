"""`aidl measure` and `aidl diff`: what a program draws in numbers, and what differs between two."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import counted
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError, exit_code, print_json, say, show
from aidl_lang.tools.cli.options import add_params, add_pixels, add_program, flag, value

if TYPE_CHECKING:
    from aidl_lang.export.comparison import Comparison
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
    about = "the density of a material; may be given several times"
    value(parser, "--density", "NAME=KG/M3", about, _density, [], dest="densities", action="append")
    flag(parser, "--json", "print everything as JSON, with all digits")


def run_measure(arguments: argparse.Namespace) -> int:
    from aidl_lang import pipeline
    from aidl_lang.common.render import escape

    source, world = files.read(arguments.file), files.world(arguments.file)
    compiled = pipeline.compile(source, world, params=dict(arguments.params))
    if not compiled.ok:
        show(compiled.diagnostics)
        return exit_code(compiled.diagnostics) or 1
    found = compiled.surveyed(arguments.paths, dict(arguments.densities))
    show([*compiled.diagnostics, *found.notes])
    if arguments.json:
        _print_json(compiled, found)
    else:
        print("\n".join(map(escape, _text(found, bool(arguments.paths)))))
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
        rows = found.pairs[:_MOST_PAIRS]
        one, other = (max(len(getattr(p, side)) for p in rows) for side in ("a", "b"))
        for pair in rows:
            yield f"{pair.a:<{one}}  {pair.b:<{other}}  {_relation(pair)}"
        if more := len(found.pairs) - len(rows):
            yield f"and {counted(more, 'more pair')}, {_relation(found.pairs[_MOST_PAIRS])} or further"
        if found.is_partial:
            yield "pairs that are far from each other are not listed"
    if found.alone:
        yield f"touches no other: {some_of(found.alone)}"


def _block(part: Part) -> Iterator[str]:
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
        grams = part.mass
        rows.append(("mass", f"{_number(grams)} g" if grams < 1000 else f"{_number(grams / 1000)} kg"))
    for name, said in rows:
        yield f"  {name:<11}{said}"


def _width(width: Width | None, part: Part, size: float) -> str:
    if width is None:
        return "none"
    inside = f" in {width.part}" if width.part != part.path else ""
    return f"{_number(width.length)} mm, from {_place(width.a, size)} to {_place(width.b, size)}{inside}"


def _table(parts: Sequence[Part]) -> Iterator[str]:
    heads = tuple("body,area mm²,perimeter mm,size mm,holes,wall mm,gap mm,mass g,quantity".split(","))
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


def _relation(pair: Contact) -> str:
    if pair.relation == "apart":
        return f"{_number(pair.gap or 0.0)} mm apart"
    return f"overlapping, {_number(pair.area or 0.0)} mm²" if pair.relation == "overlapping" else "touching"


def _number(value: float, tiny: float = 0.0) -> str:
    """Writes six digits; nothing below `tiny`."""
    return f"{0.0 if abs(value) <= tiny else value:.6g}"


def _place(p: Vec, size: float) -> str:
    return f"({_number(p[0], 1e-9 * size)}, {_number(p[1], 1e-9 * size)})"


def _print_json(compiled: Compiled, found: Survey) -> None:
    from aidl_lang.common.prose import rounded
    from aidl_lang.common.render import to_dict
    from aidl_lang.export.json import contact

    document = {
        "units": "mm",
        "whole": found.whole.to_dict(),
        "parts": [part.to_dict() for part in found.parts],
        "pairs": [*map(contact, found.pairs)],
        "all_pairs": not found.is_partial,
        "alone": list(found.alone),
        "diagnostics": [to_dict(d) for d in [*compiled.diagnostics, *found.notes]],
    }
    print_json(rounded(document), 1)


LONGEST = 20.0
"""Seconds of the processor's time for the picture of two versions."""


def register_diff(parser: argparse.ArgumentParser) -> None:
    """`aidl diff`: what moved, turned, grew, appeared and vanished between two versions of a program."""
    parser.add_argument("before", metavar="BEFORE", help="a program; - reads standard input")
    parser.add_argument(
        "after", nargs="?", metavar="AFTER", help="another; without it BEFORE with the params of --to"
    )
    parser.add_argument(
        "-o", "--output", action="append", default=[], metavar="OUT", help="draw both over each other"
    )
    value(parser, "--format", "SUFFIX", "format of outputs whose name does not tell it")
    add_params(parser)
    add_params(parser, "--from", "params_before", "the same for BEFORE alone")
    add_params(parser, "--to", "params_after", "the same for AFTER alone")
    add_pixels(parser)
    flag(parser, "--json", "print the differences as JSON")
    flag(parser, "--exit-code", "exit with 1 if there is a difference")
    flag(parser, "--best-effort", "compare how far the solver came even if it did not solve")


def run_diff(arguments: argparse.Namespace) -> int:
    outputs = [(name, _suffix(name, arguments)) for name in arguments.output]
    on_standard = sum(name == files.STANDARD for name, _ in outputs)
    if on_standard + arguments.json > 1:
        raise UseError("E0914", "2 files do not fit on standard output", "name a file with -o")
    comparison = _comparison(arguments)
    if isinstance(comparison, int):
        return comparison
    _draw(comparison, outputs, arguments.pixels)
    if arguments.json:
        print_json(comparison.to_dict(), 1)
    elif on_standard:
        say(str(comparison))
    else:
        print(comparison)
    return int(arguments.exit_code and not comparison.is_equal)


def _suffix(name: str, arguments: argparse.Namespace) -> str:
    from aidl_lang.export import PICTURES, suffix_of

    files.require_directory(name)
    fallback = arguments.format or ".svg" * (name == files.STANDARD)
    return suffix_of(name, fallback, PICTURES, "differences cannot be drawn as `{}`")


def _comparison(arguments: argparse.Namespace) -> Comparison | int:
    """Returns the comparison, or the exit code if a side is wrong, which has been reported."""
    from aidl_lang import pipeline

    names = arguments.before, arguments.after or arguments.before
    if arguments.after is None and not (arguments.params_before or arguments.params_after):
        hint = "name a second program, or say what differs, as in `--to width=200`"
        raise UseError("E0922", f"there is nothing to compare `{names[0]}` with", hint)
    sources = {name: files.read(name) for name in dict.fromkeys(names)}
    versions: list[Compiled] = []
    code = 0
    for name, own in zip(names, (arguments.params_before, arguments.params_after), strict=True):
        params = dict(arguments.params) | dict(own)
        compiled = pipeline.compile(sources[name], files.world(name), params=params)
        may_be_used = compiled.ok or arguments.best_effort
        if may_be_used and compiled.model is not None and compiled.drawing is not None:
            versions.append(compiled)
        else:
            show([*compiled.errors, _refusal(name, compiled)], quiet=True)
            code = max(code, exit_code(compiled.errors), 1)
    return code or versions[0].compared(versions[1])


def _refusal(name: str, compiled: Compiled) -> Diagnostic:
    if compiled.drawing is None:
        return Diagnostic("E0922", f"`{name}` cannot be compared: it does not compile")
    what = "its constraints do not solve" if compiled.status != "solved" else "an assertion in it fails"
    return Diagnostic(
        "E0922", f"`{name}` cannot be compared: {what}", hints=("`--best-effort` compares it as it is",)
    )


def _draw(comparison: Comparison, outputs: list[tuple[str, str]], pixels: int) -> None:
    if not outputs:
        return
    from aidl_lang.common.diagnostics import within
    from aidl_lang.export import render
    from aidl_lang.export.comparison.showing import overlay
    from aidl_lang.export.job import Options

    with within(LONGEST, "drawing the differences in"):
        picture = overlay(comparison)
        made = [(name, render(picture, suffix, Options(pixels=pixels))) for name, suffix in outputs]
    files.require_unread(name for name, _ in made)
    for name, data in made:
        files.write(name, data)
        if name != files.STANDARD:
            say(f"{name}: drawn")
