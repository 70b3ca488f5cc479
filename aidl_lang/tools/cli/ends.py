"""The ends of params, for `aidl check --ends`: tried with progress, and reported."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from aidl_lang.common.prose import counted
from aidl_lang.tools.cli.report import say

if TYPE_CHECKING:
    from aidl_lang.common.source import SourceFile
    from aidl_lang.common.world import World
    from aidl_lang.pipeline import Compiled, Settings
    from aidl_lang.tools.ends import Sweep


def swept(source: SourceFile, world: World, settings: Settings, compiled: Compiled) -> Sweep:
    """Tries a working program at the ends of its params, with progress on a terminal."""
    from aidl_lang.tools.ends import SweepJob, sweep

    job = SweepJob(source.name, source.text, world, settings)
    try:
        return sweep(job, compiled.knobs, compiled.diagnostics, _progress)
    finally:
        _progress(0, 0)


def _progress(done: int, count: int) -> None:
    """Prints progress over the last line of a terminal; removes it when done."""
    if sys.stderr.isatty():
        text = f"{done} of {count} ends tried" if count else ""
        print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


def tell(name: str, sweep: Sweep) -> None:
    """Prints the faults on standard output; then a summary."""
    from aidl_lang.common.render import escape
    from aidl_lang.tools.ends import sentence

    for each in sweep.turned:
        if text := sentence(each, name):
            print(f"{name}: {'' if each.ok else 'error '}{escape(text)}")
    say(f"{name}: {_summary(sweep)}")


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


def data(name: str, sweep: Sweep) -> dict[str, Any]:
    """Returns the results for JSON."""
    from aidl_lang.tools.ends import described

    return {
        "file": name,
        "ok": sweep.ok,
        "tried": described(sweep),
        "without_range": [knob.path for knob in sweep.rangeless],
        "left": sweep.left,
        "compiled": sweep.compiled,
        "seconds": round(sweep.seconds, 3),
    }
