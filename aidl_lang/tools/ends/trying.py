"""Compiles a program with one param set, in a process of its own."""

from __future__ import annotations

import time
from dataclasses import field, replace

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic, Severity
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.pipeline import Front, Settings
from aidl_lang.tools.ends.results import Fault, Tried
from aidl_lang.tools.ends.values import Value

_SPARE = 10.0
"""Seconds that a process gets beyond the limits: for starting, checking, reasons."""


@record()
class SweepJob:
    """A program as passed to another process."""

    name: str
    text: str
    world: World | None = field(default=None, compare=False)
    settings: Settings = field(default=Settings(), compare=False)

    @property
    def seconds(self) -> float:
        """Returns the time that one compile may take."""
        limits = self.settings
        return limits.building.seconds + limits.solving.seconds + limits.drawing + _SPARE


_known: dict[SweepJob, Front] = {}
"""The program that this process has checked already: it is the same over and over."""


def tried(job: SweepJob, path: str, value: Value, explained: bool) -> Tried:
    """Returns the result of a value. Conflicts are looked into only if `explained`."""
    start = time.perf_counter()
    settings = replace(job.settings, solving=replace(job.settings.solving, explain=explained))
    source = SourceFile(job.name, job.text)
    if job not in _known:
        _known.clear()
        _known[job] = pipeline.front(source, job.world, settings)
    compiled = pipeline.compile(source, job.world, {path: value}, settings, checked=_known[job])
    wanted = Severity.WARNING if compiled.ok else Severity.ERROR
    found = tuple(fault(d) for d in compiled.diagnostics if d.severity is wanted)
    return Tried(compiled.ok, found, time.perf_counter() - start)


def fault(diagnostic: Diagnostic) -> Fault:
    span = diagnostic.span
    if span is None:
        return Fault(diagnostic.code, diagnostic.message, diagnostic.label)
    return Fault(
        diagnostic.code,
        diagnostic.message,
        diagnostic.label,
        span.one_line,
        span.source.name,
        span.line,
    )
