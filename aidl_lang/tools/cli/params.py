"""`aidl params`: the knobs of a program, with their ranges and values."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from aidl_lang.common.prose import literal
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.options import add_program
from aidl_lang.tools.cli.report import exit_code, show

if TYPE_CHECKING:
    from aidl_lang.building.model import Knob


def register(parser: argparse.ArgumentParser) -> None:
    add_program(parser)
    parser.add_argument("--json", action="store_true", help="print the list as JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    from aidl_lang import pipeline

    knobs, diagnostics = pipeline.knobs(files.read(arguments.file), files.world(arguments.file))
    show(diagnostics, quiet=True)
    if arguments.json:
        import json

        print(json.dumps([_data(knob) for knob in knobs], indent=2, ensure_ascii=False))
    else:
        _print_table(knobs)
    return exit_code(diagnostics)


def _data(knob: Knob) -> dict[str, object]:
    names = ("path", "value", "low", "high", "choices", "step", "unit", "doc")
    return {name: getattr(knob, name) for name in names}


def _print_table(knobs: tuple[Knob, ...]) -> None:
    rows = [_row(knob) for knob in knobs]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())


def _row(knob: Knob) -> tuple[str, ...]:
    from aidl_lang.common.render import escape

    value = f"= {literal(knob.value)}{knob.unit}"
    cells = (knob.path, value, _domain(knob), (knob.doc or "").replace("\n", " "))
    return tuple(map(escape, cells))


def _domain(knob: Knob) -> str:
    if knob.choices:
        return f"in [{', '.join(map(literal, knob.choices))}]"
    if knob.low is None or knob.high is None:
        return ""
    step = f" step {literal(knob.step)}" if knob.step else ""
    return f"in {literal(knob.low)}..{literal(knob.high)}{step}"
