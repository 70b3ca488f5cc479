"""`aidl new`: a starter program to change."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.report import say

STARTER = """\
// A plate with two holes. `aidl compile {file}` draws it.
solid {name} {{
    param width = 80 in 40..200  // a knob: aidl compile {file} -D width=120

    plate = rounded_rectangle(center: origin, width: width, height: 40, radius: 5)

    hole left {{
        rim = circle(center: (-30, 0), radius: 4)
    }}
    hole right {{
        rim = circle(center: (30, 0), radius: 4)
    }}

    constrain {{
        left.rim.center == plate.center - (width / 2 - 12, 0)
        right.rim.center == plate.center + (width / 2 - 12, 0)
        equal(right.rim, left.rim)
    }}
}}
"""


def register(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", help="what to make: NAME.aidl, never over an existing file")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    path = Path(arguments.name)
    if path.suffix != ".aidl":
        path = path.with_name(f"{path.name}.aidl")
    files.require_directory(str(path))
    files.create(str(path), STARTER.format(name=structure_name(path.stem), file=path.name).encode())
    say(f"{path}: written. Draw it with: aidl compile {path}")
    return 0


def structure_name(stem: str) -> str:
    """Returns a valid name, as near to the file's as possible."""
    from aidl_lang.syntax.tables import load_tables

    name = re.sub(r"\W+", "_", stem.lower(), flags=re.ASCII).strip("_")
    unfit = not name or name[0].isdigit() or name in load_tables().reserved
    return f"part_{name}".rstrip("_") if unfit else name
