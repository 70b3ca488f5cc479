"""`aidl grammar`: the grammar, for servers that constrain what a model may write, and for readers."""

from __future__ import annotations

import argparse

from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.report import UseError, say
from aidl_lang.tools.grammars import FENCED_FORMATS, FORMATS


def register(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--format", default="lark", metavar="FORMAT", help=f"{', '.join(FORMATS)} (default: lark)"
    )
    parser.add_argument(
        "--fenced",
        action="store_true",
        help="free text first, then the program in a block opened by ```aidl",
    )
    parser.add_argument(
        "-o",
        "--output",
        default=files.STANDARD,
        metavar="OUT",
        help="where to write (default: standard output)",
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    from aidl_lang.tools.grammars import export

    if arguments.format not in FORMATS:
        raise UseError(
            "E0940", f"there is no format `{arguments.format}`", f"the formats: {', '.join(FORMATS)}"
        )
    if arguments.fenced and arguments.format not in FENCED_FORMATS:
        raise UseError(
            "E0941",
            f"`{arguments.format}` has no form for free text before a program",
            f"`--fenced` goes with {' and '.join(f'`--format {f}`' for f in FENCED_FORMATS)}",
        )
    files.require_directory(arguments.output)
    text = export(arguments.format, arguments.fenced)
    files.write(arguments.output, text.encode())
    if arguments.output != files.STANDARD:
        say(f"{arguments.output}: written")
    return 0
