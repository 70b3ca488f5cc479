"""`aidl sheet`: a technical drawing on paper, with dimensions, a frame and a title block."""

from __future__ import annotations

import argparse
import re
import time
from pathlib import Path

from aidl_lang.common.materials import PAPERS
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError, exit_code, say, show
from aidl_lang.tools.cli.options import add_outputs, add_params, add_pixels, add_program, choice, value

_DEFAULT = ".pdf"


def register_sheet(parser: argparse.ArgumentParser) -> None:
    """`aidl sheet`: a technical drawing on paper, with dimensions, a frame and a title block."""
    add_program(parser)
    add_outputs(
        parser, "where to write: .pdf, .svg or .png; may be given several times (default: FILE with .pdf)"
    )
    add_params(parser)
    value(parser, "--paper", "NAME", f"{', '.join(PAPERS)} (default: by fit)", _paper)
    way = parser.add_mutually_exclusive_group()
    way.add_argument(
        "--landscape", dest="landscape", action="store_const", const=True, help="lay the paper wide"
    )
    way.add_argument("--portrait", dest="landscape", action="store_const", const=False, help="stand it up")
    value(parser, "--scale", "N:M", "as in 1:2 (default: by fit)", _scale)
    value(parser, "--date", "TEXT", "the date in the title block (default: none)", str, "")
    choice(parser, "--standard", ("iso", "ansi"), "paper and projection (default: iso)", "iso")
    add_pixels(parser)
    parser.set_defaults(run=run_sheet)


def run_sheet(arguments: argparse.Namespace) -> int:
    from aidl_lang import pipeline
    from aidl_lang.export import Options, file_names
    from aidl_lang.export.drafting import Draft
    from aidl_lang.tools.cli.build import Target, require_one

    start = time.perf_counter()
    source = files.read(arguments.file)
    targets = [Target(name, sheet_suffix(name)) for name in arguments.output or [_default(arguments.file)]]
    for target in targets:
        files.require_directory(target.name)
    compiled = pipeline.compile(source, files.world(arguments.file), params=dict(arguments.params))
    show(compiled.diagnostics)
    if not compiled.ok:
        return exit_code(compiled.diagnostics) or 1
    draft = Draft(
        arguments.paper, arguments.landscape, arguments.scale, arguments.standard, arguments.date.strip()
    )
    made = compiled.drafted([t.suffix for t in targets], draft, Options(pixels=arguments.pixels))
    written = []
    for target, result in zip(targets, made, strict=True):
        datas = (result.data, *result.further)
        require_one(target.name, len(datas))
        for name, data in zip(file_names(target.name, len(datas)), datas, strict=True):
            files.write(name, data)
            written.append(name)
    show(dict.fromkeys(note for result in made for note in result.notes))
    say(f"{', '.join(written)}: {time.perf_counter() - start:.2f} s")
    return exit_code(compiled.diagnostics)


def _default(program: str) -> str:
    return files.STANDARD if program == files.STANDARD else str(Path(program).with_suffix(_DEFAULT))


def sheet_suffix(name: str) -> str:
    """Returns the format of a sheet; raises UseError for one that has none."""
    from aidl_lang.export import PICTURES

    suffix = _DEFAULT if name == files.STANDARD else Path(name).suffix.lower()
    if suffix not in PICTURES:
        asked = suffix.lstrip(".")
        message = f"there are no sheets of the format `{asked}`" if asked else f"`{name}` tells no format"
        raise UseError("E0905", message, f"formats: {', '.join(sorted(s.lstrip('.') for s in PICTURES))}")
    return suffix


def _paper(text: str) -> str:
    name = text.strip().lower()
    if name not in PAPERS:
        raise argparse.ArgumentTypeError(f"there is no `{text}`; there are {', '.join(PAPERS)}")
    return name


def _scale(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"\s*([1-9]\d{0,4})\s*[:/]\s*([1-9]\d{0,4})\s*", text)
    if found is None:
        raise argparse.ArgumentTypeError(f"expected a scale such as 1:2 or 5:1, not `{text}`")
    return int(found[1]), int(found[2])
