"""Lenses above structures: whether each solves, and its remaining motions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from aidl_lang.common.prose import counted, first_few
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.solved import ConstraintReport, Motion, SolvedModel, SolvedStructure
from aidl_lang.pipeline import Compiled
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.view import View

_NAMED = 3
"""Most things that one title names, and most different statements in it."""
_HELD = "fully constrained"


@record()
class Lens:
    """A line above the name of a structure, about the structures at `paths`."""

    span: Span
    title: str
    paths: tuple[str, ...]


def lenses(view: View) -> list[Lens]:
    """Returns one lens for each structure of the solved text; none while it is being solved."""
    outcome = view.outcome
    if outcome is None or outcome.model is None:
        return []
    return list(_lenses(view, outcome, outcome.model))


def _lenses(view: View, outcome: Compiled, model: SolvedModel) -> Iterator[Lens]:
    made: dict[Span, list[SolvedStructure]] = {}
    for structure in model.root.walk():
        if structure.span is not None:
            made.setdefault(structure.span, []).append(structure)
    motions = [motion for motion in model.motions if motion.things != (model.root.path,)]
    for node in ast.walk(view.module):
        if isinstance(node, ast.Structure) and (found := made.get(node.span)):
            title = _title(found, motions, model.constraints)
            if found[0] is model.root:
                as_whole = "moves only as a whole" if model.degrees else _HELD
                title = f"{_status(outcome, model)} · {title.replace(_HELD, as_whole)}"
            yield Lens(node.name.span, title, tuple(structure.path for structure in found))


def _status(outcome: Compiled, model: SolvedModel) -> str:
    match outcome.status:
        case "solved" if model.degrees is not None:
            return f"solved, {counted(model.degrees, 'degree')} of freedom"
        case "solved":
            return "solved"
        case "partial":
            return "some constraints do not hold"
        case _:
            return "does not solve"


def _title(
    found: Sequence[SolvedStructure], motions: Sequence[Motion], reports: Sequence[ConstraintReport]
) -> str:
    """Returns the title for the structures that one piece of text made."""
    said = list(dict.fromkeys(_one(structure, motions, reports) for structure in found))
    times = f"{len(found)} times · " if len(found) > 1 else ""
    return times + first_few(said, _NAMED, " …", " | ")


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
    if free:
        return f"{held}{first_few(free, _NAMED, ' …')}"
    return f"{held}{_HELD}"


def _names(motion: Motion, inside: str) -> str:
    """Returns the moving things as named in a structure; "" for the structure itself."""
    names = [thing.removeprefix(inside) for thing in motion.things if thing.startswith(inside)]
    return first_few(names, _NAMED, " …") + " " * bool(names)
