"""How far a sweep is: a line on a terminal, or JSON lines for programs."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from aidl_lang.tools.cli.report import say

if TYPE_CHECKING:
    from aidl_lang.tools.sweeping.session import Progress

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
