"""Compiles a program with one param set, in a process of its own."""

from __future__ import annotations

import time
from dataclasses import field, replace

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Severity
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.pipeline import Front, Settings
from aidl_lang.tools.ends.results import Tried
from aidl_lang.tools.ends.values import Value
from aidl_lang.tools.sweeping.bundle import patience
from aidl_lang.tools.sweeping.faults import fault


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
        return patience(self.settings)


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
