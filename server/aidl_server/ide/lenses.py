"""What stands beside a text: inlay hints, and lenses above structures and params."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeAlias

from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.names import fold
from aidl_lang.common.prose import counted, first_few, fixed, literal
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.solved import ConstraintReport, Motion, Scalar, SolvedModel, SolvedStructure
from aidl_lang.pipeline import Settings
from aidl_lang.syntax import ast
from aidl_lang.tools import ends
from aidl_lang.tools.ends import Sweep, Turned, valued
from aidl_lang.tools.ranges import Ranges, Walk, ranges, sentence
from aidl_server.ide.guesses import Guess, factor, guesses, number_for
from aidl_server.ide.workspace import Solved, View

# --- Inlay hints: the solved values of first guesses, the chosen meaning of an ambiguous call, and values of
# `param`s that were set from outside.

_DECIMALS = 3
_ARROW = "→"


@record()
class Inlay:
    """A hint shown at an offset; `edits` write it into the text, if that can be done. One that `is_reading`
    tells how an ambiguous call was taken, others tell values.
    """

    offset: int
    text: str
    tooltip: str
    edits: tuple[Edit, ...] = ()
    is_reading: bool = False


def inlays(view: View, span: Span | None = None) -> list[Inlay]:
    """Returns the hints in a part of the text, or in all of it; none before it is drawn."""
    if view.solved is None:
        return []
    found = [*_solved(view), *_readings(view, view.solved.model), *_set_from_outside(view, view.solved)]
    wanted = (i for i in found if span is None or span.start <= i.offset <= span.end)
    return sorted(wanted, key=lambda inlay: inlay.offset)


def _solved(view: View) -> Iterator[Inlay]:
    for guess in guesses(view):
        if guess.solved is None or not guess.is_off(guess.solved):
            continue
        text = f"{_ARROW} {_shown(guess.solved)}{guess.behind}"
        edits = () if guess.is_shared else (Edit(guess.span, number_for(guess, guess.solved)),)
        yield Inlay(guess.span.end, text, _told(guess), edits)


def _told(guess: Guess) -> str:
    kind = "a size that had to change" if guess.is_kept else "a first guess"
    many = f", and of {len(guess.uses) - 1} more" if len(guess.uses) > 1 else ""
    written, solved = _shown(guess.written), fixed(guess.solved or 0.0)
    return f"`{guess.path}`{many}: {kind}, written as {written} and solved to {solved}{guess.behind}"


def _readings(view: View, model: SolvedModel) -> Iterator[Inlay]:
    for reading in model.readings:
        if reading.span.source is view.source:
            said = f"`{reading.span.one_line}` has several meanings"
            about = f"{said}. By what is written it is {reading.text}."
            yield Inlay(reading.span.end, reading.text, about, is_reading=True)


def _set_from_outside(view: View, solved: Solved) -> Iterator[Inlay]:
    """Yields the `param` values given to a run, if they differ from the text."""
    given, root = view.set_outside, solved.model.root.path
    for knob in solved.outcome.knobs if given else ():
        declared = view.declaration(knob) if _is_own(view, knob) else None
        if declared is None or given.isdisjoint({fold(knob.path), fold(f"{root}.{knob.path}")}):
            continue
        if _as_written(declared.value) != knob.value:
            unit = f" {knob.unit}" if knob.unit else ""
            text = f"{_ARROW} {_shown(knob.value)}{unit}"
            place = declared.value.span.end
            yield Inlay(place, text, f"`{knob.path}` is set from outside")


def _as_written(node: ast.Expression) -> Scalar | None:
    match node:
        case ast.String(value=value) | ast.Boolean(value=value):
            return value
        case ast.Number(value=value, unit=unit):
            return value * factor(unit)
        case ast.Unary(operator="-", operand=ast.Number(value=value, unit=unit)):
            return -value * factor(unit)
        case _:
            return None


def _shown(value: Scalar) -> str:
    return literal(value) if isinstance(value, bool | str) else fixed(value, _DECIMALS)


# --- Lenses above params: the results of the program at the ends of their ranges and between, once tried.


@record()
class Found:
    """What became of the params of a program at their ends, and on the way there."""

    sweep: Sweep
    ranges: Ranges


def can_be_tried(view: View) -> bool:
    """True for a program that works as written, and has a param with a range."""
    return view.outcome is not None and view.outcome.ok and any(map(ends.has_range, view.knobs))


def tried(view: View, settings: Settings, progress: Callable[[int, int], None], seconds: float) -> Found:
    """Tries a program at the ends of its params, and walks between them, in half of the time each. Raises
    ValueError if it cannot be tried, and Cancelled if the request was given up.
    """
    if not can_be_tried(view):
        raise ValueError("the program has to work as it is written, and have a param with a range")
    job = ends.SweepJob(view.source.name, view.source.text, view.world, settings)
    sweep = ends.sweep(job, view.knobs, view.diagnostics, progress, seconds / 2)
    return Found(sweep, between(view, settings, progress, seconds / 2))


def between(view: View, settings: Settings, progress: Callable[[int, int], None], seconds: float) -> Ranges:
    """Walks the params of a program that `can_be_tried`. Raises Cancelled as `tried` does."""
    job = ends.SweepJob(view.source.name, view.source.text, view.world, settings)
    return ranges(job, view.knobs, progress, seconds)


Lens: TypeAlias = tuple[Span, str]
"""A place, and the line above it."""


def end_lenses(view: View, found: Found | None) -> list[Lens]:
    """Returns one lens above each param that was tried; before, one that offers to try."""
    if not can_be_tried(view):
        return []
    return list(_offer(view) if found is None else _told_at_ends(view, found))


def _offer(view: View) -> Iterator[Lens]:
    knobs = [k for k in view.knobs if ends.has_range(k)]
    own = [k for k in knobs if _is_own(view, k)]
    if own and own[0].span is not None:
        count = len({k.path for k in knobs})
        title = f"try the ends of {count} params" if count > 1 else "try the ends of this param"
        yield own[0].span, title


def _is_own(view: View, knob: Knob) -> bool:
    return knob.span is not None and knob.span.source is view.source


def _told_at_ends(view: View, found: Found) -> Iterator[Lens]:
    by_place: dict[Span, dict[str, list[Turned]]] = {}
    walks = {walk.knob.path: walk for walk in found.ranges.walks}
    for each in found.sweep.turned:
        if each.knob.span is not None and _is_own(view, each.knob):
            by_place.setdefault(each.knob.span, {}).setdefault(each.knob.path, []).append(each)
    for span, by_path in by_place.items():
        name = view.source.name
        texts = dict.fromkeys(_title(turned, walks.get(p), name) for p, turned in by_path.items())
        yield span, " · ".join(texts)


def _title(turned: Sequence[Turned], walk: Walk | None, name: str) -> str:
    said = [text for each in turned if (text := ends.sentence(each, name))]
    between = [t for t in walk.turns if any(c.kind != "error" for c in t.changes)] if walk else []
    said += [sentence(walk, turn) for turn in between if walk is not None]
    if said:
        return first_few(said, _NAMED, " · …", " · ")
    knob = turned[0].knob
    if knob.range is None or isinstance(knob.value, bool):
        return f"works with {' and '.join(valued(knob, each.value) for each in turned)}"
    low, high = (valued(knob, end) for end in knob.range)
    throughout = ", one kind throughout" if walk is not None and walk.ok else ""
    return f"works from {low} to {high}{throughout}"


# --- Lenses above structures: whether each solves, and its remaining motions.

_NAMED = 3
"""Most things that one title names, and most different statements in it."""
_HELD = "fully constrained"


def lenses(view: View) -> list[Lens]:
    """Returns one lens for each structure of the solved text; none while it is being solved."""
    solved = view.solved
    if solved is None:
        return []
    model, made, shown = solved.model, dict[Span, list[SolvedStructure]](), list[Lens]()
    for structure in model.root.walk():
        if structure.span is not None:
            made.setdefault(structure.span, []).append(structure)
    motions = [motion for motion in model.motions if motion.things != (model.root.path,)]
    for node in ast.walk(view.module):
        if isinstance(node, ast.Structure) and (found := made.get(node.span)):
            said = list(dict.fromkeys(_one(each, motions, model.constraints) for each in found))
            times = f"{len(found)} times · " if len(found) > 1 else ""
            title = times + first_few(said, _NAMED, " …", " | ")
            if found[0] is model.root:
                as_whole = "moves only as a whole" if model.degrees else _HELD
                title = f"{_status(solved)} · {title.replace(_HELD, as_whole)}"
            shown.append((node.name.span, title))
    return shown


def _status(solved: Solved) -> str:
    degrees = solved.model.degrees
    if solved.holds:
        return "solved" if degrees is None else f"solved, {counted(degrees, 'degree')} of freedom"
    return "some constraints do not hold" if solved.outcome.status == "partial" else "does not solve"


def _one(structure: SolvedStructure, motions: Sequence[Motion], reports: Sequence[ConstraintReport]) -> str:
    own = [report for report in reports if report.path == structure.path and not report.soft]
    broken = [report for report in own if not report.satisfied]
    held = f"{counted(len(own), 'constraint')} · " if own else ""
    if broken:
        return f"{len(broken)} of {counted(len(own), 'constraint')} not met"
    inside = f"{structure.path}."
    free = [
        f"{_names(motion, inside)}can {motion.words}"
        for motion in motions
        if all(thing == structure.path or thing.startswith(inside) for thing in motion.things)
    ]
    return f"{held}{first_few(free, _NAMED, ' …')}" if free else f"{held}{_HELD}"


def _names(motion: Motion, inside: str) -> str:
    """Returns the moving things as named in a structure; "" for the structure itself."""
    names = [thing.removeprefix(inside) for thing in motion.things if thing.startswith(inside)]
    return first_few(names, _NAMED, " …") + " " * bool(names)
