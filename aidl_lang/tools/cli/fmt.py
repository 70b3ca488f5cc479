"""`aidl fmt`: put programs into their canonical form."""

from __future__ import annotations

import argparse

from aidl_lang.common.source import SourceFile
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.report import UseError, exit_code, say, show


def register(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("files", nargs="+", metavar="FILE", help="a program; - is standard input and output")
    parser.add_argument(
        "--check", action="store_true", help="write nothing; exit with 1 if a file would change"
    )
    parser.add_argument("--diff", action="store_true", help="write nothing; print what would change")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    return max(_format(name, arguments.check, arguments.diff) for name in arguments.files)


def _format(name: str, check: bool, diff: bool) -> int:
    """Formats one file and returns its exit code, so that one bad file does not stop the others."""
    from aidl_lang import pipeline

    try:
        source = files.read(name)
        text, diagnostics = pipeline.formatted(source, files.world(name))
        if text is None:
            show(diagnostics)
            return exit_code(diagnostics)
        return _deliver(name, source, text, check, diff)
    except UseError as reason:
        show([reason.diagnostic])
        return 2


def _deliver(name: str, source: SourceFile, text: str, check: bool, diff: bool) -> int:
    changed = text != source.text
    if diff:
        print(_diff(source, text), end="")
    if check and changed:
        say(f"{name}: would be reformatted")
    if not (check or diff) and (changed or name == files.STANDARD):
        files.rewrite(name, text.encode())
    return int(check and changed)


def _diff(source: SourceFile, text: str) -> str:
    from difflib import unified_diff

    lines = unified_diff(
        source.text.splitlines(keepends=True),
        text.splitlines(keepends=True),
        source.name,
        f"{source.name} (formatted)",
    )
    unended = "\n\\ No newline at end of file\n"
    return "".join(line if line.endswith("\n") else line + unended for line in lines)
