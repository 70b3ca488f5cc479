"""Finds every place that names a thing, in all programs of a project."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from aidl_lang.checking.resolving.symbols import Symbol
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.tools.ide.meaning import Place, mention_at, mentions, place_of
from aidl_lang.tools.ide.project import Project
from aidl_lang.tools.ide.view import View


@record()
class Occurrence:
    """A place in a file that names or declares a thing."""

    path: Path
    span: Span
    is_declaration: bool


def references(project: Project, view: View, offset: int) -> list[Occurrence]:
    """Returns all occurrences of the thing named at an offset, including its declarations."""
    mention = mention_at(view, offset)
    if mention is None:
        return []
    symbol = mention.symbol
    place = place_of(view, symbol)
    if place is None:  # built in: known by its name alone, in this file
        found = [m for m in mentions(view) if m.symbol.kind == symbol.kind and m.symbol.name == symbol.name]
        return _ordered(Occurrence(view.path, m.span, False) for m in found if not m.symbol.declarations)
    return _ordered([*declarations(view, symbol), *_named(project, view, symbol, place)])


def highlights(view: View, offset: int) -> list[Occurrence]:
    """Returns the same in this file alone."""
    mention = mention_at(view, offset)
    place = place_of(view, mention.symbol) if mention is not None else None
    if mention is None or place is None:
        return []
    own = [d for d in declarations(view, mention.symbol) if d.path == view.path]
    return _ordered([*own, *occurrences(view, place)])


def occurrences(view: View, place: Place) -> Iterator[Occurrence]:
    """Yields the places where a program names a thing declared at a place."""
    for mention in mentions(view):
        if place_of(view, mention.symbol) == place:
            yield Occurrence(view.path, mention.span, mention.is_declaration)


def declarations(view: View, symbol: Symbol) -> Iterator[Occurrence]:
    """Yields the declarations of a symbol; the branches of an `if` may have several."""
    for declaration in symbol.declarations:
        if (file := view.file(declaration.span.source)) is not None:
            yield Occurrence(file, declaration.span, True)


def _named(project: Project, view: View, symbol: Symbol, place: Place) -> Iterator[Occurrence]:
    """Yields occurrences in the view that was asked, and in all other programs."""
    yield from occurrences(view, place)
    for other in project.views_with(symbol.name):
        if other.path != view.path:
            yield from occurrences(other, place)


def _ordered(found: Iterator[Occurrence] | list[Occurrence]) -> list[Occurrence]:
    """Orders occurrences by file and place, each once."""
    unique = {(o.path, o.span.start, o.span.end): o for o in found}
    return [unique[key] for key in sorted(unique)]
