"""Lenses above params: the results of the program at the ends of their ranges, once tried."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from aidl_lang.building.model import Knob
from aidl_lang.common.source import Span
from aidl_lang.pipeline import Settings
from aidl_lang.tools import ends
from aidl_lang.tools.ends import Sweep, Turned
from aidl_lang.tools.ends.wording import valued
from aidl_lang.tools.ide.lenses import Lens
from aidl_lang.tools.ide.view import View


def can_be_tried(view: View) -> bool:
    """True for a program that works as written, and has a param with a range."""
    outcome = view.outcome
    return outcome is not None and outcome.ok and any(ends.has_range(knob) for knob in outcome.knobs)


def tried(view: View, settings: Settings, progress: Callable[[int, int], None], seconds: float) -> Sweep:
    """Tries a program at the ends of its params. Raises ValueError if it cannot be tried, and Cancelled if
    the request was given up.
    """
    if view.outcome is None or not can_be_tried(view):
        raise ValueError("the program has to work as it is written, and have a param with a range")
    job = ends.SweepJob(view.source.name, view.source.text, view.world, settings)
    return ends.sweep(job, view.outcome.knobs, view.outcome.diagnostics, progress, seconds)


def end_lenses(view: View, found: Sweep | None) -> list[Lens]:
    """Returns one lens above each param that was tried; before, one that offers to try."""
    if not can_be_tried(view):
        return []
    return list(_offer(view) if found is None else _told(view, found))


def _offer(view: View) -> Iterator[Lens]:
    assert view.outcome is not None
    knobs = [k for k in view.outcome.knobs if ends.has_range(k)]
    own = [k for k in knobs if _is_own(view, k)]
    if own and own[0].span is not None:
        count = len({k.path for k in knobs})
        title = f"try the ends of {count} params" if count > 1 else "try the ends of this param"
        yield Lens(own[0].span, title, tuple(k.path for k in knobs))


def _is_own(view: View, knob: Knob) -> bool:
    return knob.span is not None and knob.span.source is view.source


def _told(view: View, found: Sweep) -> Iterator[Lens]:
    by_place: dict[Span, dict[str, list[Turned]]] = {}
    for each in found.turned:
        if each.knob.span is not None and _is_own(view, each.knob):
            by_place.setdefault(each.knob.span, {}).setdefault(each.knob.path, []).append(each)
    for span, by_path in by_place.items():
        texts = dict.fromkeys(_title(turned, view.source.name) for turned in by_path.values())
        yield Lens(span, " · ".join(texts), tuple(by_path))


def _title(turned: Sequence[Turned], name: str) -> str:
    """Returns the results of one param as a title."""
    said = [text for each in turned if (text := ends.sentence(each, name))]
    if said:
        return " · ".join(said)
    knob = turned[0].knob
    if knob.low is None or knob.high is None or isinstance(knob.value, bool):
        return f"works with {' and '.join(valued(knob, each.value) for each in turned)}"
    return f"works from {valued(knob, knob.low)} to {valued(knob, knob.high)}"
