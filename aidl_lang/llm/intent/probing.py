"""Trying whether what was lost still fits: it is put back, and the program is compiled."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

from aidl_lang import ast
from aidl_lang.diagnostics import Diagnostic
from aidl_lang.llm.intent.canonical import Key, Path
from aidl_lang.llm.intent.changes import Changes
from aidl_lang.llm.intent.inventory import Inventory, Item, Kind
from aidl_lang.llm.intent.placing import PutBack, put_back
from aidl_lang.pipeline import Compiled, Settings, compile
from aidl_lang.resolving.resolution import Resolution
from aidl_lang.solved import SolvedGeometry, SolvedModel
from aidl_lang.source import SourceFile, Span
from aidl_lang.world import World

_SECONDS = 5.0
"""For solving once with something put back."""
_PATIENCE = 30.0
"""Seconds after which nothing more is tried."""
_SAME = 1e-6
"""How far a value may move, relative to the size of the drawing, and still count as unmoved."""
_FAILED, _TIMED_OUT, _REPEATED = "E0604", "E0603", "N0602"
_UNSOLVED = frozenset({"E0601", "E0602", "E0605"})
_CONTACTS = frozenset({"W0705", "W0736"})
"""Remarks on parts that touch nothing; what brings them about does not fit."""


class State(StrEnum):
    """What is known of something lost."""

    UNTRIED = "untried"  # the program has errors, or there was too much to try
    HOMELESS = "homeless"  # what it speaks of, or the place for it, is not there any more
    IMPLIED = "implied"  # it holds, and takes no freedom: other words say it
    FITS = "fits"
    CONFLICTS = "conflicts"


@dataclass(frozen=True)
class Finding:
    """
    parties  the statements that something lost conflicts with, as they are written
    reason   what is said of the program with it, where it is no conflict of statements
    """

    state: State
    parties: tuple[str, ...] = ()
    reason: str = ""


UNTRIED = Finding(State.UNTRIED)


@dataclass(frozen=True)
class Trial:
    """A program with something put back, compiled."""

    finding: Finding
    source: SourceFile
    compiled: Compiled | None = None


class Prober:
    """Tries losses in one program: at most so many times, and no more after some time."""

    def __init__(self, name: str, world: World | None, settings: Settings, most: int) -> None:
        seconds = min(settings.solving.seconds, _SECONDS)
        self.name, self.world, self.left = name, world, most
        self.end = time.monotonic() + _PATIENCE
        self.settings = replace(settings, solving=replace(settings.solving, seconds=seconds))

    def compiled(self, source: SourceFile) -> Compiled:
        """A compilation that counts."""
        self.left -= 1
        return compile(source, self.world, settings=self.settings)

    def tried(self, item: Item, changes: Changes, base: Compiled | None) -> Trial:
        """What comes of putting an item back into the later program, which came out as `base`."""
        here = changes.after.source
        is_over = self.left <= 0 or time.monotonic() > self.end
        if is_over or base is None or not stands(base):
            return Trial(UNTRIED, here)
        edit = put_back(item, changes)
        if edit is None:
            return Trial(Finding(State.HOMELESS), here)
        source = SourceFile(self.name, edit.text)
        result = self.compiled(source)
        new = list(_new_errors((*base.diagnostics, *_contacts(changes)), result))
        if any(d.code == _TIMED_OUT for d in new):
            self.left = 0  # each further trial would take as long
            return Trial(UNTRIED, here)
        if result.model is None:
            return Trial(Finding(State.HOMELESS), here)
        if new:
            solving = [d for d in new if d.code in _UNSOLVED]
            reason = "" if solving else new[0].message
            return Trial(Finding(State.CONFLICTS, tuple(_parties(solving, source, edit)), reason), here)
        implied = _is_implied(item, edit, base, result, changes.before)
        return Trial(Finding(State.IMPLIED if implied else State.FITS), source, result)


def stands(compiled: Compiled | None) -> bool:
    """Whether a program solves; an assert of it may fail."""
    if compiled is None or compiled.model is None or compiled.status != "solved":
        return False
    return not any(d.is_error and d.code != _FAILED for d in compiled.diagnostics)


def _contacts(changes: Changes) -> Iterator[Diagnostic]:
    """What touched nothing when what was lost was still there."""
    return (d for d in changes.before.diagnostics if d.code in _CONTACTS)


def _new_errors(before: Iterable[Diagnostic], result: Compiled) -> Iterator[Diagnostic]:
    known = Counter(_mark(d) for d in before)
    for d in result.diagnostics:
        if d.is_error or d.code in _CONTACTS:
            mark = _mark(d)
            if not known[mark]:
                yield d
            known[mark] -= 1


def _mark(d: Diagnostic) -> tuple[str, str]:
    """What a diagnostic says; of contacts, of which part, as the distance may change."""
    return d.code, d.message.split("`")[1] if d.code in _CONTACTS else d.message


def _parties(errors: list[Diagnostic], source: SourceFile, edit: PutBack) -> Iterable[str]:
    """The statements named in a conflict as they are written, but for the one that was put back."""
    own = Span(source, edit.start, edit.end)
    spans = [span for d in errors for span in (d.span, *(label.span for label in d.secondary)) if span]
    others = (span for span in spans if not span.overlaps(own))
    return dict.fromkeys(span.one_line for span in sorted(others, key=lambda span: span.start))


# --- What follows from the rest ------------------------------------------------------------------------


def _is_implied(item: Item, edit: PutBack, base: Compiled, result: Compiled, before: Inventory) -> bool:
    """Whether the program says as much without an item: nothing moves when it is put back, and nothing is
    less free. An inequality takes no freedom, and a structure that nothing speaks of has none: there the
    solver has to say what follows from what.
    """
    if item.kind not in (Kind.CONSTRAINT, Kind.ROTATION):
        return False
    assert base.model is not None
    assert result.model is not None
    if base.model.degrees != result.model.degrees or not _unmoved(base.model, result.model):
        return False
    return _is_repeated(edit, base, result) or (
        _is_at_home(item, before.things) and _is_exact(item, before.resolution)
    )


def _is_repeated(edit: PutBack, base: Compiled, result: Compiled) -> bool:
    """Whether the solver says that it follows from others, or another from it."""
    known = {d.message for d in base.diagnostics}
    for d in result.diagnostics:
        if d.code == _REPEATED and d.message not in known:
            spans = [d.span, *(label.span for label in d.secondary)]
            if any(span and span.start < edit.end and edit.start < span.end for span in spans):
                return True
    return False


def _is_at_home(item: Item, things: Mapping[Path, Item]) -> bool:
    """Whether it speaks of geometry of its own structure alone. What speaks of another structure may be all
    that keeps that one where it happens to stand.
    """
    spoken_of = [things.get(path) for path in item.things]
    return all(thing and thing.kind is Kind.GEOMETRY and thing.home == item.home for thing in spoken_of)


def _is_exact(item: Item, resolution: Resolution) -> bool:
    """Whether a statement is made of equations alone."""
    seen: set[ast.Node] = set()
    stack: list[ast.Node] = [item.node]
    while stack:
        for node in ast.walk(stack.pop()):
            if isinstance(node, ast.Membership):
                return False
            if isinstance(node, ast.Comparison) and set(node.operators) != {"=="}:
                return False
            for signature in resolution.candidates.get(node, ()) if isinstance(node, ast.Call) else ():
                body = signature.node
                if isinstance(body, ast.ConstraintDefinition) and body not in seen:
                    seen.add(body)
                    resolution.scope_of(body)
                    stack.append(body.body)
    return True


def _unmoved(a: SolvedModel, b: SolvedModel) -> bool:
    first, second = dict(_values(a)), dict(_values(b))
    size = max([1.0, *map(abs, first.values())])
    return first.keys() == second.keys() and all(
        abs(value - second[key]) <= _SAME * size for key, value in first.items()
    )


def _values(model: SolvedModel) -> Iterator[tuple[Key, float]]:
    """Every number of a drawing, by where it stands."""
    for structure in model.root.walk():
        frame = structure.frame
        for name, value in (("x", frame.x), ("y", frame.y), ("rotation", frame.rotation)):
            yield (structure.path, name), value
        for number, geometry in enumerate(structure.geometry):
            for part_number, part in enumerate(geometry.walk()):
                yield from _numbers((structure.path, number, part_number), part)


def _numbers(place: Key, geometry: SolvedGeometry) -> Iterator[tuple[Key, float]]:
    for name, value in geometry.values.items():
        stack: list[tuple[Key, object]] = [((*place, name), value)]
        while stack:
            key, each = stack.pop()
            if isinstance(each, float | int):
                yield key, float(each)
            elif isinstance(each, tuple):
                stack += [((*key, i), inner) for i, inner in enumerate(each)]
