"""`aidl check`: find what is wrong without writing anything, and mend what can be mended."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from aidl_lang.common.diagnostics import Diagnostic, has_errors
from aidl_lang.common.records import record
from aidl_lang.tools.cli import ends, files
from aidl_lang.tools.cli.options import add_variant
from aidl_lang.tools.cli.report import UseError, exit_code, say, show

if TYPE_CHECKING:
    from aidl_lang.common.source import SourceFile
    from aidl_lang.common.world import World
    from aidl_lang.pipeline import Settings
    from aidl_lang.tools.ends import Sweep

_WHY = "it changes what you wrote, so the choice is yours", "it would make things worse"
"""Why `--fix` leaves a fix that is not sure, and one that is."""


@record()
class _Checked:
    """The findings in a file, the titles of the fixes made, and the result of solving: `solved`, `partial`,
    `failed`; "" if it was not tried.
    """

    diagnostics: list[Diagnostic]
    fixes: tuple[str, ...] = ()
    status: str = ""
    was_read: bool = True
    sweep: Sweep | None = None


def register(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("files", nargs="+", metavar="FILE", help="a program; - reads standard input")
    parser.add_argument(
        "--fix", action="store_true", help="write the program with the fixes applied that are sure"
    )
    how_far = parser.add_mutually_exclusive_group()
    how_far.add_argument(
        "--ends",
        action="store_true",
        help="try both ends of the range of each param as well, one at a time, and tell how far each may go",
    )
    how_far.add_argument(
        "--no-solve",
        dest="solve",
        action="store_false",
        help="find only what can be found without solving and drawing, which is quick",
    )
    parser.add_argument("--json", action="store_true", help="print the diagnostics as JSON")
    add_variant(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    found: list[Diagnostic] = []
    fixes: list[dict[str, str]] = []
    is_solved = is_well = True
    swept: list[dict[str, object]] = []
    for name in arguments.files:
        checked = _check(name, arguments)
        found += checked.diagnostics
        fixes += [{"file": name, "title": title} for title in checked.fixes]
        is_solved = is_solved and checked.status == "solved"
        if checked.sweep is not None:
            is_well = is_well and checked.sweep.ok
            swept.append(ends.data(name, checked.sweep))
        if not arguments.json:
            _tell(name, checked, mends=arguments.fix, asks_for_ends=arguments.ends)
    if arguments.json:
        import json

        from aidl_lang.common.render import to_dict

        document = {
            "ok": is_well and exit_code(found) == 0,
            "solved": is_solved,
            "fixed": fixes,
            "diagnostics": [
                to_dict(d) | ({"not_fixed": _WHY[d.fix.is_sure]} if arguments.fix and d.fix else {})
                for d in found
            ],
            **({"ends": swept} if arguments.ends else {}),
        }
        print(json.dumps(document, indent=2, ensure_ascii=False))
    return exit_code(found) or (0 if is_well else 1)


def _check(name: str, arguments: argparse.Namespace) -> _Checked:
    """Checks one file; an unreadable file is a finding like others, so that the rest is checked."""
    from aidl_lang import pipeline

    settings = pipeline.Settings.of(arguments.variant)
    try:
        source, world = files.read(name), files.world(name)
        if not arguments.fix:
            return _found(source, world, settings, arguments)
        from aidl_lang.tools.mending import mend

        mended = mend(source, world, settings)
        if name == files.STANDARD or mended.source.text != source.text:
            files.rewrite(name, mended.source.text.encode())
        if has_errors(mended.diagnostics):
            return _Checked(mended.diagnostics, mended.fixes)  # the rest would add nothing
        return _found(mended.source, world, settings, arguments, mended.fixes)
    except UseError as reason:
        return _Checked([reason.diagnostic], was_read=False)


def _found(
    source: SourceFile,
    world: World,
    settings: Settings,
    arguments: argparse.Namespace,
    fixes: tuple[str, ...] = (),
) -> _Checked:
    """Returns the findings in a program as it stands."""
    from aidl_lang import pipeline

    if not arguments.solve:
        return _Checked(pipeline.check(source, world, settings), fixes)
    compiled = pipeline.compile(source, world, settings=settings)
    status = compiled.status if compiled.model is not None else ""
    sweep = ends.swept(source, world, settings, compiled) if arguments.ends and compiled.ok else None
    return _Checked(compiled.diagnostics, fixes, status, sweep=sweep)


def _tell(name: str, checked: _Checked, *, mends: bool, asks_for_ends: bool) -> None:
    from aidl_lang.common.render import summary

    for title in checked.fixes:
        say(f"{name}: fixed: {title}")
    show(checked.diagnostics)
    for fix in (d.fix for d in checked.diagnostics if mends and d.fix is not None):
        say(f"{name}: not fixed: {fix.title}: {_WHY[fix.is_sure]}")
    if checked.was_read:
        unsolved = "" if checked.status else "; nothing was solved"
        untried = "; the ends of its params were not tried" if asks_for_ends and checked.sweep is None else ""
        say(f"{name}: {summary(checked.diagnostics) or 'no mistakes found'}{unsolved}{untried}")
    if checked.sweep is not None:
        ends.tell(name, checked.sweep)
