"""`aidl sweep`: many variants of a program, their drawings, and a table of what came of each."""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from aidl_lang.common.diagnostics import AidlError
from aidl_lang.common.prose import counted, named
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError, exit_code, print_json, say, show
from aidl_lang.tools.cli.options import (
    add_drawing_options,
    add_outputs,
    add_program,
    add_strict,
    add_variant,
    choice,
    count_to,
    flag,
    value,
)

if TYPE_CHECKING:
    from aidl_lang.tools.sweeping.outputs import Outputs, Row
    from aidl_lang.tools.sweeping.plan import Plan, Rows
    from aidl_lang.tools.sweeping.session import Job, Progress, Sweep


# --- How far a sweep is: a line on a terminal, or JSON lines for programs.

_OFTEN = 1.0
"""Seconds between two lines of JSON."""
_REDRAWN = 0.1
"""Seconds between two drawings of the line."""
_PATIENCE = 10.0
"""Seconds without workers after which that is said."""
_WIDTH = 110
"""Columns of a terminal that does not know its own."""
_NOW = 60
"""Columns for what runs now."""


@contextmanager
def progress(kind: str) -> Iterator[Callable[[Progress], None]]:
    """Returns what is to be told of a sweep's progress: `auto`, `off` or `json`."""
    if kind == "json":
        yield _JsonLines()
    elif kind == "off" or not sys.stderr.isatty():
        yield _Quiet()
    else:
        bar = _Bar()
        try:
            yield bar
        finally:
            bar.close()


class _Quiet:
    """Says nothing, but once that there is nobody to do the work."""

    def __init__(self) -> None:
        self._since: float | None = None
        self._was_said = False

    def __call__(self, progress: Progress) -> None:
        if progress.places:
            self._since = None
            return
        self._since = self._since or time.monotonic()
        if not self._was_said and time.monotonic() - self._since > _PATIENCE:
            self._was_said = True
            say("the cluster has no workers; waiting for some")


class _Bar:
    """A line with what is done, the rate and the time left, what fails, and what runs now."""

    def __init__(self) -> None:
        from tqdm import tqdm

        self._last = 0.0
        # a terminal may not know its size, and what is larger than none is not shown
        width = os.get_terminal_size(sys.stderr.fileno()).columns or _WIDTH
        self._bar = tqdm(
            total=None, unit=" variants", file=sys.stderr, ncols=width, nrows=_WIDTH, leave=False
        )

    def __call__(self, progress: Progress) -> None:
        from aidl_lang.common.render import escape
        from aidl_lang.tools.sweeping.plan import labels

        bar = self._bar
        bar.total, bar.initial = progress.count, progress.kept
        bar.n = progress.done
        parts = [f"{progress.failed} failing"] if progress.failed else []
        if progress.kept:
            parts.append(f"{progress.kept} known")
        if not progress.places:
            parts.append("waiting for workers")
        elif progress.running:
            now = escape(labels(progress.running[0].values)).replace("\n", " ")
            parts.append(f"now {now[:_NOW]}")
        bar.set_postfix_str(", ".join(parts), refresh=False)
        if time.monotonic() - self._last > _REDRAWN or progress.done == progress.count:
            self._last = time.monotonic()
            bar.refresh()

    def close(self) -> None:
        self._bar.close()


class _JsonLines:
    """A line of JSON now and then, and one at the end."""

    def __init__(self) -> None:
        self._start, self._last = time.monotonic(), 0.0

    def __call__(self, progress: Progress) -> None:
        now = time.monotonic()
        if now - self._last < _OFTEN and progress.done < progress.count:
            return
        self._last = now
        seconds = now - self._start
        computed = progress.done - progress.kept
        rate = computed / seconds if computed and seconds > 0 else None
        told = {
            "done": progress.done,
            "count": progress.count,
            "failed": progress.failed,
            "kept": progress.kept,
            "begun_again": progress.given_again,
            "places": progress.places,
            "seconds": round(seconds, 3),
            "rate": rate and round(rate, 3),
            "left": rate and round((progress.count - progress.done) / rate, 1),
            "running": [dict(each.values) for each in progress.running],
        }
        say(json.dumps(told, ensure_ascii=False))


_MOST_TOLD = 20
"""Most failures that are listed; the table has all."""


def register_sweep(parser: argparse.ArgumentParser) -> None:
    """`aidl sweep`: many variants of a program, their drawings, and a table of what came of each."""
    parser.epilog = (
        "Values: width=60..200/8 (so many of a range), width='60..200 step 20', style=round,square, "
        "style='*' (all choices). Several -D make a grid. Exit codes: 0 all variants are well, "
        "1 some are not, 2 wrong use."
    )
    add_program(parser)
    value(parser, "-D", "NAME=VALUES", "vary a param", _axis, [], dest="params", action="append")
    value(parser, "--table", "CSV", "a variant for each row; columns are params")
    value(parser, "--random", "N", "draw so many variants within the ranges of params", count_to(1_000_000))
    value(parser, "--seed", "N", "of what is drawn (default: 1)", int, 1)
    add_outputs(
        parser,
        "drawings (out/{width}-{n}.dxf: a name in braces stands for a value, {n} for the number), "
        "a table (.csv, .jsonl, .parquet) or a contact sheet (.html, .pdf, .png); may be given several times",
    )
    about = "make the drawings technical drawings on paper, as `aidl sheet` does: .pdf, .svg or .png"
    flag(parser, "--drawing-sheet", about)
    add_drawing_options(parser)
    add_variant(parser)
    add_strict(parser)
    running = parser.add_argument_group("running")
    add = partial(value, running)
    add("--on", "ENGINE", "local (the default), or a scheduler of Dask: tcp://host:8786", str, "local")
    add("--jobs", "N", "processes of this machine (default: one for each processor)", count_to(1000))
    about = "for each variant (default: what a compile, its files and measures may take)"
    add("--time-limit", "SECONDS", about, count_to(100_000))
    flag(running, "--stop-on-error", "stop at the first variant that fails")
    flag(running, "--resume", "go on with the same sweep that was broken off")
    add("--cache", "DIR", "keep what comes of variants there, and take what is kept")
    add("--cache-size", "MB", "most that the cache keeps (default: 4096)", count_to(1_000_000))
    about = "leave the seconds out of tables, which are the same every time then"
    running.add_argument("--no-timings", dest="timings", action="store_false", help=about)
    about = "a line on a terminal (the default), nothing, or JSON lines on standard error"
    choice(running, "--progress", ("auto", "off", "json"), about)
    flag(running, "--json", "print a summary with all failures as JSON")


def run_sweep(arguments: argparse.Namespace) -> int:
    from aidl_lang.common.processes import prepared
    from aidl_lang.tools.sweeping.session import LOCAL, Sweep, engine, preloads

    if arguments.file == files.STANDARD and arguments.resume:
        raise UseError("E0971", "a sweep of standard input cannot go on", "give the program a file")
    source = files.read(arguments.file)
    if arguments.on == LOCAL:
        prepared(preloads(arguments.output))  # they load while the program is read
    else:
        import logging

        logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what there is to say is said here
    try:
        job = _job(arguments, source)
    except AidlError as reason:
        show(reason.diagnostics)
        return exit_code(reason.diagnostics)
    start = partial(engine, arguments.on, arguments.jobs, len(job.plan), arguments.output)
    with Sweep(job, start) as session:
        try:
            with progress(arguments.progress) as session.listen:
                for _ in session:
                    pass
        except AidlError as reason:
            show(reason.diagnostics)
            if session.rows:
                _tell_unfinished(session)
            return exit_code(reason.diagnostics)
        except KeyboardInterrupt:
            _tell_unfinished(session)
            raise
    _tell(session, arguments)
    return 0 if session.is_complete and not session.failed else 1


def _axis(text: str) -> tuple[str, str]:
    name, equals, values = text.partition("=")
    if not (name.strip() and equals and values.strip()):
        raise argparse.ArgumentTypeError(f"expected NAME=VALUES, as in width=60..200/8, not `{text}`")
    return name.strip(), values


def _require_sheets(wanted: Outputs, words: Sequence[str]) -> None:
    """Raises UseError for outputs and options that drawing sheets do not have."""
    from aidl_lang.tools.cli.build import sheet_suffix

    if not wanted.patterns:
        raise UseError("E0973", "`--drawing-sheet` has no sheets to make", "name them: `-o '{n}.pdf'`")
    for each in wanted.patterns:
        sheet_suffix(each.text)
    for word in words:
        if word.startswith("--") and word != "--pixels":
            raise UseError("E0973", f"a drawing sheet has no `{word}`", f"leave out `{word}`")


def _job(arguments: argparse.Namespace, source: Any) -> Job:
    from aidl_lang import pipeline
    from aidl_lang.tools.cli.options import options, said
    from aidl_lang.tools.sweeping.outputs import outputs
    from aidl_lang.tools.sweeping.session import Job, opened, reproducing
    from aidl_lang.tools.sweeping.working import Making

    settings = pipeline.Settings.of(arguments.variant, strict=arguments.strict)
    bundle, world, knobs = opened(source, files.world(arguments.file), settings)
    plan = _plan(arguments, knobs)
    words = said(arguments)
    wanted = outputs(arguments.output, plan, world.reads, arguments.format)
    if arguments.drawing_sheet:
        _require_sheets(wanted, words)
    return Job(
        plan,
        bundle,
        world,
        Making(
            options=options(arguments), best_effort=arguments.best_effort, drafted=arguments.drawing_sheet
        ),
        wanted,
        lambda variant, name: reproducing(
            arguments.file, plan, variant, name, words, verb="sheet" if arguments.drawing_sheet else "compile"
        ),
        arguments.cache or "",
        arguments.cache_size * 1_000_000 if arguments.cache_size else Job.cache_size,
        arguments.resume,
        arguments.stop_on_error,
        arguments.timings,
        arguments.time_limit,
    )


def _plan(arguments: argparse.Namespace, knobs: Any) -> Plan:
    from aidl_lang.tools.sweeping.plan import axis, planned, read_table

    rows: Rows | None = None
    if arguments.table:
        rows = read_table(Path(arguments.table), knobs, files.reads)
        if rows.labels:
            say(f"{arguments.table}: carried along, as no param is called so: {named(rows.labels)}")
    is_drawn = arguments.random is not None
    axes = [axis(name, values, knobs, is_drawn=is_drawn) for name, values in arguments.params]
    return planned(knobs, axes, rows, (arguments.random, arguments.seed) if is_drawn else None)


def _tell(session: Sweep, arguments: argparse.Namespace) -> None:
    failures = [row for row in session.rows if not row.ok]
    failures.sort(key=lambda row: row.variant.number)
    turns = session.turns
    if arguments.json:
        print_json(_summary(session, failures, turns))
    _list(failures, turns, arguments.output)
    if session.stale:
        say(
            f"of an earlier run, and left as they are, though their variants fail now: {named(session.stale)}"
        )
    if session.renamed:
        say(f"{counted(session.renamed, 'file')} would have shared a name, and got the number of the variant")
    if session.given_again:
        say(
            f"{counted(session.given_again, 'variant')} had to be begun again, as what compiled them was gone"
        )
    if session.was_stopped:
        _tell_unfinished(session)
    say(f"{arguments.file}: {line(session)}")


def line(session: Sweep) -> str:
    count, done = len(session.job.plan), len(session.rows)
    parts = [counted(count, "variant") if done == count else f"{done} of {counted(count, 'variant')}"]
    parts.append(f"{done - session.failed} well, {session.failed or 'none'} failing")
    if session.kept:
        parts.append(f"{session.kept} known before")
    return f"{', '.join(parts)}, {session.seconds:.1f} s"


def _list(failures: Sequence[Row], turns: Sequence[str], outputs: Sequence[str]) -> None:
    from aidl_lang.common.render import escape
    from aidl_lang.tools.sweeping.outputs import said
    from aidl_lang.tools.sweeping.plan import labels

    for row in failures[:_MOST_TOLD]:
        say(f"failing: {row.variant.number}: {escape(_short(labels(row.variant.values)))}")
        for fault in row.outcome.errors[:3]:
            say(f"  {escape(said(fault))}")
        if not row.outcome.errors:
            say(f"  {escape(row.message)}")
        say(f"  {escape(_short(row.command, 2000))}")
    if (more := len(failures) - _MOST_TOLD) > 0:
        where = "the tables have all" if outputs else "a table has all: `-o table.csv`"
        say(f"and {counted(more, 'failure')} more; {where}")
    for turn in turns[:_MOST_TOLD]:
        say(f"of another kind: {escape(_short(turn))}; `aidl check --range` tells where")
    if (more := len(turns) - _MOST_TOLD) > 0:
        say(f"and {counted(more, 'place')} more; `--json` has all")


def _short(text: str, most: int = 200) -> str:
    text = text.replace("\n", "\\n").replace("\r", "\\r")
    return text if len(text) <= most else f"{text[:most]}… ({len(text)} characters)"


def _tell_unfinished(session: Sweep) -> None:
    count = len(session.job.plan)
    if session.job.cache:
        where = f"`{session.job.cache}` has what is done"
    elif session.unfinished is not None:
        where = f"`{session.unfinished}` has what is done; the same command with `--resume` goes on"
    else:
        where = "nothing is kept, as there are no outputs"
    say(f"{len(session.rows)} of {counted(count, 'variant')} done; {where}")


def _summary(session: Sweep, failures: Sequence[Row], turns: Sequence[str]) -> dict[str, Any]:
    return {
        "variants": len(session.job.plan),
        "done": len(session.rows),
        "ok": len(session.rows) - session.failed,
        "failed": session.failed,
        "kept": session.kept,
        "begun_again": session.given_again,
        "complete": session.is_complete,
        "seconds": round(session.seconds, 3),
        "turns": turns,
        "failures": [
            {
                "n": row.variant.number,
                "params": dict(row.variant.values),
                "labels": dict(row.variant.labels),
                "status": row.outcome.status,
                "messages": [
                    {"code": f.code, "message": f.message, "label": f.label, "file": f.file, "line": f.line}
                    for f in row.outcome.errors
                ],
                "command": row.command,
            }
            for row in failures
        ],
    }
