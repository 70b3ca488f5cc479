"""`aidl check`: find what is wrong without drawing, and mend what can be mended."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from aidl_lang.cli import files
from aidl_lang.cli.options import add_variant
from aidl_lang.cli.report import UseError, exit_code, say, show
from aidl_lang.diagnostics import Diagnostic
from aidl_lang.source import SourceFile

if TYPE_CHECKING:
    from aidl_lang.mending import Mended
    from aidl_lang.variants import Variant


def register(verbs: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = verbs.add_parser("check", help="find mistakes without drawing", description=__doc__)
    parser.add_argument("files", nargs="+", metavar="FILE", help="a program; - reads standard input")
    parser.add_argument("--fix", action="store_true", help="write the program with all fixes applied")
    parser.add_argument("--json", action="store_true", help="print the diagnostics as JSON")
    add_variant(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    found: list[Diagnostic] = []
    fixes: list[dict[str, str]] = []
    for name in arguments.files:
        checked = _check(name, arguments.fix, arguments.variant)
        found += checked.diagnostics
        fixes += [{"file": name, "title": title} for title in checked.fixes]
        if not arguments.json:
            _tell(name, checked)
    if arguments.json:
        import json

        from aidl_lang.render import to_dict

        document = {"ok": exit_code(found) == 0, "fixed": fixes, "diagnostics": [to_dict(d) for d in found]}
        print(json.dumps(document, indent=2, ensure_ascii=False))
    return exit_code(found)


def _check(name: str, fix: bool, variant: Variant) -> Mended:
    """Check one file; a file that cannot be read is a finding like others, so that the rest is checked."""
    from aidl_lang import pipeline
    from aidl_lang.mending import Mended, mend

    settings = pipeline.Settings(variant=variant)
    try:
        source, world = files.read(name), files.world(name)
        if not fix:
            return Mended(source, pipeline.check(source, world, settings))
        checked = mend(source, world, settings)
        if name == files.STANDARD or checked.source.text != source.text:
            files.write(name, checked.source.text.encode())
    except UseError as reason:
        return Mended(SourceFile(name, ""), [reason.diagnostic])
    return checked


def _tell(name: str, checked: Mended) -> None:
    from aidl_lang.render import summary

    for title in checked.fixes:
        say(f"{name}: fixed: {title}")
    show(checked.diagnostics)
    if not any(d.span is None for d in checked.diagnostics):
        say(f"{name}: {summary(checked.diagnostics) or 'no mistakes found'}")
