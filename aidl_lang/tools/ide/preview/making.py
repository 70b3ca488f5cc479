"""Makes the preview of a view: the picture and the data beside it."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.drawing_time import TooLongError, within
from aidl_lang.pipeline import Compiled, Settings
from aidl_lang.solver.memory import Memory
from aidl_lang.tools.ide.dragging import Handle, grips, handles, is_somewhere
from aidl_lang.tools.ide.preview.elements import Elements, elements
from aidl_lang.tools.ide.preview.picture import svg_of
from aidl_lang.tools.ide.preview.problems import conflicts, problems
from aidl_lang.tools.ide.preview.sliders import sliders
from aidl_lang.tools.ide.preview.values import FREEDOM, LAYERS, Preview, Way
from aidl_lang.tools.ide.preview.ways import ways
from aidl_lang.tools.ide.view import SETTINGS, View, hasty, run

_NOWHERE = (0.0, 0.0, 0.0, 0.0)


def preview(
    view: View, show: Collection[str] = (), *, tried: bool = False, known: Iterable[Handle] = ()
) -> Preview:
    """Returns the preview of a program that was run, with some of LAYERS over it, and FREEDOM if wanted.

    A program that does not draw shows the last one that did, and its own problems. What can be dragged takes
    longer to find out than all the rest (see `with_handles`): here are those that are `known` from another
    picture of it, where they are now.
    """
    assert view.outcome is not None, "the view was not run"
    found = elements(view)
    drawn = view.drawn
    has_picture = drawn is not None and _is_anything_drawn(drawn)
    svg, unpainted = _painted(drawn, found, show) if drawn is not None and has_picture else (None, ())
    return Preview(
        status=_status(view.outcome),
        stale=has_picture and view.is_stale,
        tried=tried,
        seconds=sum(view.outcome.timings.values()),
        svg=svg,
        box=drawn.drawing.box if drawn is not None and drawn.drawing is not None else _NOWHERE,
        elements=found.values,
        knobs=tuple(sliders(view)),
        handles=tuple(_moved(view, known)),
        problems=tuple(problems(view, found, unpainted, tried=tried)),
        conflicts=tuple(conflicts(view, found)),
        ways=tuple(_ways(view, found)) if FREEDOM in show else (),
        degrees=view.outcome.model.degrees if view.outcome.model is not None else None,
    )


def _status(outcome: Compiled) -> str:
    """Returns how a program stands: one that solved may still be `wrong`, as when an `assert` fails."""
    is_wrong = outcome.status == "solved" and bool(outcome.errors)
    return "wrong" if is_wrong else outcome.status


def _painted(
    drawn: Compiled, found: Elements, show: Collection[str]
) -> tuple[str | None, tuple[Diagnostic, ...]]:
    """Returns the SVG; or, if painting takes too long, the diagnostics about that."""
    try:
        with within(drawn.limit, "painting"):
            return svg_of(drawn, found, set(show) & set(LAYERS)), ()
    except TooLongError as reason:
        return None, (reason.diagnostic,)


def with_handles(made: Preview, view: View) -> Preview:
    """Returns the preview with all handles. Raises Cancelled as `run` does."""
    return replace(made, handles=tuple(handles(view)))


def _moved(view: View, known: Iterable[Handle]) -> Iterator[Handle]:
    """Yields those handles that still exist, at their present places."""
    outcome, wanted = view.outcome, {handle.id: handle for handle in known}
    if not wanted or view.is_stale or outcome is None or outcome.built is None or outcome.evaluate is None:
        return
    for grip in grips(outcome.built):
        if grip.id in wanted and is_somewhere(at := grip.at(outcome.evaluate)):
            yield replace(wanted[grip.id], at=at)


def _is_anything_drawn(outcome: Compiled) -> bool:
    if outcome.model is None or outcome.drawing is None:
        return False
    return bool(outcome.drawing.bodies or outcome.drawing.strokes or outcome.model.root.box)


def _ways(view: View, found: Elements) -> Iterator[Way]:
    """Yields the remaining motions; none for the picture of an earlier text."""
    if view.outcome is not None and not view.is_stale:
        yield from ways(view.outcome, found)


def tried(
    view: View,
    knobs: Mapping[str, float | str | bool],
    memory: Memory | None = None,
    settings: Settings = SETTINGS,
    *,
    rests: bool = False,
) -> View:
    """Returns the view with other values of some params; why they do not hold is explained if what changes
    them `rests`. Raises Cancelled as `run` does.
    """
    how = settings if rests else hasty(settings)
    return run(view, view, memory, {**(view.params or {}), **knobs}, how)
