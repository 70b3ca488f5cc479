"""`aidl check`: find what is wrong without drawing, and mend what can be mended."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import TYPE_CHECKING

from aidl_lang.cli import files
from aidl_lang.cli.report import UseError, exit_code, say, show
from aidl_lang.diagnostics import Diagnostic, apply_fixes
from aidl_lang.source import SourceFile

if TYPE_CHECKING:
    from aidl_lang.world import DiskWorld

_ROUNDS = 20
"""Times that `--fix` looks again: one fix may bring another mistake to light."""


@dataclass(frozen=True)
class Checked:
    """The findings in a program as it stands now, and the titles of the fixes made on the way."""

    source: SourceFile
    diagnostics: list[Diagnostic]
    fixes: tuple[str, ...] = ()


def register(verbs: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = verbs.add_parser("check", help="find mistakes without drawing", description=__doc__)
    parser.add_argument("files", nargs="+", metavar="FILE", help="a program; - reads standard input")
    parser.add_argument("--fix", action="store_true", help="write the program with all fixes applied")
    parser.add_argument("--json", action="store_true", help="print the diagnostics as JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    found: list[Diagnostic] = []
    fixes: list[dict[str, str]] = []
    for name in arguments.files:
        checked = _check(name, arguments.fix)
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


def _check(name: str, fix: bool) -> Checked:
    """Check one file; a file that cannot be read is a finding like others, so that the rest is checked."""
    from aidl_lang import pipeline

    try:
        source, world = files.read(name), files.world(name)
        if not fix:
            return Checked(source, pipeline.check(source, world))
        checked = mend(source, world)
        if name == files.STANDARD or checked.source.text != source.text:
            files.write(name, checked.source.text.encode())
    except UseError as reason:
        return Checked(SourceFile(name, ""), [reason.diagnostic])
    return checked


def mend(source: SourceFile, world: DiskWorld) -> Checked:
    """Apply fixes and look again until nothing changes, the text returns to an earlier one, or the limit."""
    from aidl_lang import pipeline

    fixes: list[str] = []
    seen: set[str] = set()
    for _ in range(_ROUNDS):
        diagnostics = pipeline.check(source, world)
        seen.add(source.text)
        text, applied = apply_fixes(source, diagnostics)
        if not applied or text in seen:
            break
        fixes += [d.fix.title for d in diagnostics if d.fix][:applied]
        source = SourceFile(source.name, text)
    else:
        diagnostics = pipeline.check(source, world)
    return Checked(source, diagnostics, tuple(fixes))


def _tell(name: str, checked: Checked) -> None:
    from aidl_lang.render import summary

    for title in checked.fixes:
        say(f"{name}: fixed: {title}")
    show(checked.diagnostics)
    if not any(d.span is None for d in checked.diagnostics):
        say(f"{name}: {summary(checked.diagnostics) or 'no mistakes found'}")
