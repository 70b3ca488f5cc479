"""`aidl check`, `aidl fmt` and `aidl params`: what is asked of programs without drawing them."""

from __future__ import annotations

import argparse
from functools import partial
from typing import TYPE_CHECKING, Any

from aidl_lang.common.diagnostics import Diagnostic, has_errors
from aidl_lang.common.prose import counted, literal
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError, exit_code, pass_by, print_json, say, show
from aidl_lang.tools.cli.options import add_program, add_variant, flag

if TYPE_CHECKING:
    from aidl_lang.building.model import Knob
    from aidl_lang.common.world import World
    from aidl_lang.pipeline import Compiled, Settings
    from aidl_lang.tools.ends import Sweep, SweepJob


# --- The ends and ranges of params, for `aidl check --ends` and `--range`: tried with progress, and reported.


@record()
class _Swept:
    """What came of trying params: whether all is well, in lines, in one line, and as data."""

    ok: bool
    lines: list[str]
    summary: str
    data: dict[str, Any]


def _ends(name: str, job: SweepJob, compiled: Compiled) -> _Swept:
    from aidl_lang.tools.ends import described, sentence, sweep

    found = sweep(job, compiled.knobs, compiled.diagnostics, partial(_progress, "ends tried"))
    told = [(each, sentence(each, name)) for each in found.turned]
    data = {
        "file": name,
        "ok": found.ok,
        "tried": described(found),
        "without_range": [knob.path for knob in found.rangeless],
        "left": found.left,
        "compiled": found.compiled,
        "seconds": round(found.seconds, 3),
    }
    lines = [f"{'' if each.ok else 'error '}{text}" for each, text in told if text]
    return _Swept(found.ok, lines, _summary(found), data)


def _walks(name: str, job: SweepJob, compiled: Compiled, in_pairs: bool) -> _Swept:
    from aidl_lang.tools.ranges import described, ranges, sentences, summary, together

    found = ranges(job, compiled.knobs, partial(_progress, "params walked"), in_pairs=in_pairs)
    lines = [text for walk in found.walks for text in sentences(walk)]
    lines += [text for pair in found.pairs for text in together(pair)]
    return _Swept(found.ok, lines, summary(found), described(name, found))


def _progress(what: str, done: int, count: int) -> None:
    pass_by(f"{done} of {count} {what}")


def _summary(sweep: Sweep) -> str:
    if not sweep.turned and not sweep.left:
        return "no param has a range, so there is nothing to turn"
    params = {each.knob.path for each in sweep.turned}
    failed = sum(not each.ok for each in sweep.turned)
    parts = [
        f"{counted(len(sweep.turned), 'end')} of {counted(len(params), 'param')} tried, "
        f"{failed or 'none'} {'fails' if failed == 1 else 'fail'}, {sweep.seconds:.1f} s"
    ]
    if sweep.rangeless:
        has = "has" if len(sweep.rangeless) == 1 else "have"
        parts.append(f"{counted(len(sweep.rangeless), 'param')} {has} no range")
    if sweep.left:
        parts.append(f"{counted(sweep.left, 'end')} left untried: there are too many, or they take too long")
    return "; ".join(parts)


_WHY = "it changes what you wrote, so the choice is yours", "it would make things worse"
"""Why `--fix` leaves a fix that is not sure, and one that is."""


@record()
class _Checked:
    """The findings in a file, the fixes made, and the status of solving; "" if it was not tried."""

    diagnostics: list[Diagnostic]
    fixes: tuple[str, ...] = ()
    status: str = ""
    was_read: bool = True
    swept: _Swept | None = None


def register_check(parser: argparse.ArgumentParser) -> None:
    """`aidl check`: find what is wrong without writing anything, and mend what can be mended."""
    parser.add_argument("files", nargs="+", metavar="FILE", help="a program; - reads standard input")
    flag(parser, "--fix", "write the program with the fixes applied that are sure")
    how_far = parser.add_mutually_exclusive_group()
    about = "try both ends of the range of each param as well, one at a time, and tell how far each may go"
    flag(how_far, "--ends", about)
    flag(how_far, "--range", "walk each param over its range, and tell where something changes kind")
    about = "as --range, and two params at a time"
    how_far.add_argument("--pairs", dest="range", action="store_const", const="pairs", help=about)
    about = "find only what can be found without solving and drawing, which is quick"
    how_far.add_argument("--no-solve", dest="solve", action="store_false", help=about)
    flag(parser, "--json", "print the diagnostics as JSON")
    add_variant(parser)


def run_check(arguments: argparse.Namespace) -> int:
    found: list[Diagnostic] = []
    fixes: list[dict[str, str]] = []
    is_solved = is_well = True
    swept: list[dict[str, object]] = []
    for name in arguments.files:
        checked = _check(name, arguments)
        found += checked.diagnostics
        fixes += [{"file": name, "title": title} for title in checked.fixes]
        is_solved = is_solved and checked.status == "solved"
        if checked.swept is not None:
            is_well = is_well and checked.swept.ok
            swept.append(checked.swept.data)
        if not arguments.json:
            _tell(name, checked, arguments)
    if arguments.json:
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
            **({"range": swept} if arguments.range else {}),
        }
        print_json(document)
    return exit_code(found) or (0 if is_well else 1)


def _check(name: str, arguments: argparse.Namespace) -> _Checked:
    from aidl_lang import pipeline

    settings = pipeline.Settings.of(arguments.variant)
    try:
        source, world = files.read(name), files.world(name)
        if not arguments.fix:
            return _found(name, source, world, settings, arguments)
        from aidl_lang.tools.mending import mend

        mended = mend(source, world, settings)
        if name == files.STANDARD or mended.source.text != source.text:
            files.rewrite(name, mended.source.text.encode())
        if has_errors(mended.diagnostics):
            return _Checked(mended.diagnostics, mended.fixes)  # the rest would add nothing
        return _found(name, mended.source, world, settings, arguments, mended.fixes)
    except UseError as reason:
        return _Checked([reason.diagnostic], was_read=False)


def _found(
    name: str,
    source: SourceFile,
    world: World,
    settings: Settings,
    arguments: argparse.Namespace,
    fixes: tuple[str, ...] = (),
) -> _Checked:
    from aidl_lang import pipeline

    if not arguments.solve:
        return _Checked(pipeline.check(source, world, settings), fixes)
    compiled = pipeline.compile(source, world, settings=settings)
    status = compiled.status if compiled.model is not None else ""
    swept = None
    if compiled.ok and (arguments.ends or arguments.range):
        from aidl_lang.tools.ends import SweepJob

        job = SweepJob(source.name, source.text, world, settings)
        try:
            if arguments.ends:
                swept = _ends(name, job, compiled)
            else:
                swept = _walks(name, job, compiled, arguments.range == "pairs")
        finally:
            pass_by("")
    return _Checked(compiled.diagnostics, fixes, status, swept=swept)


def _tell(name: str, checked: _Checked, arguments: argparse.Namespace) -> None:
    from aidl_lang.common.render import escape, summary

    for title in checked.fixes:
        say(f"{name}: fixed: {title}")
    show(checked.diagnostics)
    for fix in (d.fix for d in checked.diagnostics if arguments.fix and d.fix is not None):
        say(f"{name}: not fixed: {fix.title}: {_WHY[fix.is_sure]}")
    if checked.was_read:
        unsolved = "" if checked.status else "; nothing was solved"
        what = "the ends of its params were not tried" if arguments.ends else "its params were not walked"
        is_left = (arguments.ends or arguments.range) and checked.swept is None
        untried = f"; {what}" if is_left else ""
        say(f"{name}: {summary(checked.diagnostics) or 'no mistakes found'}{unsolved}{untried}")
    if checked.swept is not None:
        for line in checked.swept.lines:
            print(f"{name}: {escape(line)}")
        say(f"{name}: {checked.swept.summary}")


def register_fmt(parser: argparse.ArgumentParser) -> None:
    """`aidl fmt`: put programs into their canonical form."""
    parser.add_argument("files", nargs="+", metavar="FILE", help="a program; - is standard input and output")
    flag(parser, "--check", "write nothing; exit with 1 if a file would change")
    flag(parser, "--diff", "write nothing; print what would change")


def run_fmt(arguments: argparse.Namespace) -> int:
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
        changed = text != source.text
        if diff:
            print(_diff(source, text), end="")
        if check and changed:
            say(f"{name}: would be reformatted")
        if not (check or diff) and (changed or name == files.STANDARD):
            files.rewrite(name, text.encode())
        return int(check and changed)
    except UseError as reason:
        show([reason.diagnostic])
        return 2


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


def register_params(parser: argparse.ArgumentParser) -> None:
    """`aidl params`: the knobs of a program, with their ranges and values."""
    add_program(parser)
    flag(parser, "--json", "print the list as JSON")


def run_params(arguments: argparse.Namespace) -> int:
    from aidl_lang import pipeline

    knobs, diagnostics = pipeline.knobs(files.read(arguments.file), files.world(arguments.file))
    show(diagnostics, quiet=True)
    if arguments.json:
        names = ("path", "value", "low", "high", "choices", "step", "unit", "doc")
        print_json([{name: getattr(knob, name) for name in names} for knob in knobs])
    else:
        rows = [_row(knob) for knob in knobs]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        for row in rows:
            print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
    return exit_code(diagnostics)


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
