"""Compiles the variants of a program, in a process that keeps what they have in common: the program as it was
checked, and the places that the last variant had.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

from aidl_lang import pipeline
from aidl_lang.checking import library
from aidl_lang.common.diagnostics import AidlError, Diagnostic, Severity
from aidl_lang.common.prose import significant
from aidl_lang.common.records import record
from aidl_lang.compiled import Compiled
from aidl_lang.export.job import Options
from aidl_lang.geometry.survey import NothingThereError, Part
from aidl_lang.pipeline import Front
from aidl_lang.solver.hierarchy import Memory
from aidl_lang.tools.sweeping.bundle import Bundle, Carried, Change, Measures, Outcome, fault

library.load()  # where processes are forked from one that has loaded this, none of them has to
_MOST_FAULTS = 30
_MOST_CHANGES = 100


@record()
class Making:
    """What is made of a variant.

    suffixes     the formats of the files to write
    best_effort  whether they are written also where it does not solve
    picture      the larger side of a small picture in pixels; 0 for none
    drafted      whether they are drawing sheets
    """

    suffixes: tuple[str, ...] = ()
    options: Options = Options()
    best_effort: bool = False
    picture: int = 0
    drafted: bool = False


def variant(bundle: Bundle, params: Mapping[str, float | str | bool], making: Making) -> Outcome:
    """Returns what comes of a program with some params set."""
    start = time.perf_counter()
    world, front, memory = _kept(bundle)
    world.missing.clear()
    try:
        compiled = pipeline.compile(bundle.source, world, params, bundle.settings, (), memory, front)
    except BaseException:
        _kept.cache_clear()  # it may hold half of a solution
        raise
    outcome = _outcome(compiled, making)
    if missing := tuple(sorted(world.missing)):
        _kept.cache_clear()  # it was checked without these
        return Outcome("wrong", False, missing=missing)
    return replace(outcome, seconds=round(time.perf_counter() - start, 4))


@lru_cache(maxsize=1)
def _kept(bundle: Bundle) -> tuple[Carried, Front, Memory]:
    """Returns what this process has of a program already: it is the same over and over."""
    world = Carried(bundle.files)
    return world, pipeline.front(bundle.source, world, bundle.settings), Memory()


def _outcome(compiled: Compiled, making: Making) -> Outcome:
    found = list(compiled.diagnostics)
    measures: Measures = {}
    files: dict[str, tuple[bytes, ...]] = {}
    picture = b""
    is_wanted = compiled.ok or making.best_effort
    if compiled.drawing is not None and (compiled.status == "solved" or is_wanted):
        try:
            measures = _measured(compiled.measured())
        except NothingThereError:
            measures = {}  # strokes alone cover no area
        except AidlError as reason:
            found += reason.diagnostics
    if compiled.drawing is not None and is_wanted:
        files, said = _files(compiled, making)
        found += said
    if compiled.drawing is not None and making.picture:
        picture = _picture(compiled, making)
    errors = [d for d in found if d.is_error]
    warnings = [d for d in found if d.severity is Severity.WARNING]
    model = compiled.model
    return Outcome(
        compiled.status,
        compiled.ok and not errors,
        tuple(map(fault, [*errors, *warnings][:_MOST_FAULTS])),
        {knob.path: knob.value for knob in compiled.knobs},
        measures,
        tuple(
            Change(c.path, significant(c.written), significant(c.solved))
            for c in (model.changed[:_MOST_CHANGES] if model is not None else ())
        ),
        sum(
            not (a.shape or a.extent or a.outline is not None)
            for a in (compiled.built.assertions if compiled.built is not None else ())
        ),
        None if model is None else model.degrees,
        files=files,
        picture=picture,
        parts=0 if model is None else sum(1 for g in model.root.walk_geometry() for _ in g.walk()),
    )


def _measured(whole: Part) -> Measures:
    left, bottom, right, top = whole.box
    found = {
        "width": right - left,
        "height": top - bottom,
        "area": whole.area,
        "perimeter": whole.perimeter,
        "bodies": whole.bodies,
        "pieces": whole.pieces,
        "holes": whole.holes,
        "wall": whole.wall.length if whole.wall else None,
        "gap": whole.gap.length if whole.gap else None,
        "volume": whole.volume and whole.volume * whole.quantity,
        "mass": whole.mass and whole.mass * whole.quantity,
    }
    return {name: significant(value) if isinstance(value, float) else value for name, value in found.items()}


def _files(compiled: Compiled, making: Making) -> tuple[dict[str, tuple[bytes, ...]], list[Diagnostic]]:
    """Returns the files in all formats; none of them if one could not be made."""
    exporting = compiled.exporting(making.options)
    files: dict[str, tuple[bytes, ...]] = {}
    said: list[Diagnostic] = []
    for suffix in making.suffixes:
        try:
            if making.drafted:
                from aidl_lang.export.drafting import Draft

                (made,) = compiled.drafted([suffix], Draft(), making.options)
            else:
                made = exporting(suffix)
        except AidlError as reason:
            return {}, [*said, *reason.diagnostics]
        files[suffix] = (made.data, *made.further)
        said += [note for note in made.notes if note not in said]
    return files, said


def _picture(compiled: Compiled, making: Making) -> bytes:
    options = Options(making.options.show, pixels=making.picture, theme=making.options.theme)
    try:
        return compiled.export(".png", options)
    except AidlError:
        return b""  # a sheet says that there is none
