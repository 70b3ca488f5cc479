"""Where names are defined and used: definitions, links to files, references, and renaming everywhere."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

from aidl_lang.checking.resolving.symbols import Symbol
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import FileError
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import load_tables, tokenize
from aidl_lang.tools.ide.meaning import Mention, Place, mention_at, mentions, place_of
from aidl_lang.tools.ide.positions import applied
from aidl_lang.tools.ide.site import around
from aidl_lang.tools.ide.workspace import Project, View, Workspace, look

# --- Reasons for which a request cannot be carried out.


class CannotError(Exception):
    """Raised if a request cannot be carried out, with the reason for people."""


@record()
class Refusal:
    """The same as a value, for requests at every move of a mouse: most places cannot be dragged to."""

    reason: str


# --- Go to definition.


def definitions(view: View, offset: int) -> list[Span]:
    """Returns the declarations of the name at an offset, or the beginning of the file that an import names;
    in this file, in others, or in the library (see `View.file`).
    """
    mention = mention_at(view, offset)
    if mention is not None:
        return [_place(view, declaration.span) for declaration in mention.symbol.declarations]
    for node in around(view.module, offset):
        if isinstance(node, ast.Import) and node.path.span.start <= offset <= node.path.span.end:
            target = view.resolution.imports.get(node)
            return [Span(target.source, 0, 0)] if target is not None else []
    return []


def _place(view: View, span: Span) -> Span:
    """Returns the beginning of a drawing for what is defined by it: its text is none of AIDL."""
    return Span(span.source, 0, 0) if span.source in view.resolution.drawings else span


# --- Links to imported files.


@record()
class Link:
    """The place of a file's name, without its quotes, and the file."""

    span: Span
    path: Path


def links(view: View) -> list[Link]:
    """Returns the links in order of writing; none for a file that cannot be read."""
    found = []
    for statement in view.module.statements:
        target = view.resolution.imports.get(statement) if isinstance(statement, ast.Import) else None
        if isinstance(statement, ast.Import) and target is not None:
            path, span = view.file(target.source), statement.path.span
            if path is not None:
                found.append(Link(view.span(span.start + 1, span.end - 1), path))
    return found


# --- Finds every place that names a thing, in all programs of a project.


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


# --- Renames a thing everywhere, so that the programs keep their meaning.


@record()
class Renaming:
    """Edits by file, each to its present text."""

    edits: Mapping[Path, tuple[Edit, ...]]


def renameable(view: View, offset: int) -> Span:
    """Returns the name at an offset if it can be changed. Raises CannotError."""
    return _own(view, offset).span


def rename(project: Project, view: View, offset: int, name: str) -> Renaming:
    """Returns the edits that rename the thing named at an offset. Raises CannotError if the new name is not
    one, or would change the meaning of any name.
    """
    mention = _own(view, offset)
    _require_name(name)
    found = references(project, view, offset)
    by_file: dict[Path, list[Edit]] = defaultdict(list)
    for occurrence in found:
        by_file[occurrence.path].append(Edit(occurrence.span, name))
    edits = {path: tuple(each) for path, each in by_file.items()}
    _require_same_meaning(project, view, mention.symbol, found, edits, name)
    return Renaming(edits)


def _own(view: View, offset: int) -> Mention:
    mention = mention_at(view, offset)
    if mention is None:
        raise CannotError("there is no name here whose meaning is known")
    symbol = mention.symbol
    if not symbol.declarations:
        raise CannotError(f"`{symbol.name}` is built in")
    if symbol.declarations[0].span.source in view.resolution.drawings:
        raise CannotError(f"`{symbol.name}` is called so in the drawing that is imported")
    if view.is_library(symbol.declarations[0].span.source):
        raise CannotError(f"`{symbol.name}` belongs to the standard library; `alias` gives it a second name")
    return mention


def _require_name(name: str) -> None:
    tokens = tokenize(SourceFile("name", name)).tokens
    if len(tokens) != 2 or tokens[0].text != name or not name.isidentifier():
        raise CannotError(f"`{name}` is no name: names are made of letters, digits and `_`")
    if tokens[0].kind != "NAME" or name in load_tables().reserved:
        raise CannotError(f"`{name}` is a word of the language")


def _require_same_meaning(
    project: Project,
    view: View,
    symbol: Symbol,
    found: list[Occurrence],
    edits: Mapping[Path, tuple[Edit, ...]],
    name: str,
) -> None:
    """Reads the renamed programs, and compares the meaning of every name in them with the old one."""
    before = {view.path: view}
    for known in (symbol.name, name):
        before |= {other.path: other for other in project.views_with(known) if other.path != view.path}
    for occurrence in found:  # a file that is imported and lies elsewhere
        if occurrence.path not in before and (other := project.view(occurrence.path)) is not None:
            before[occurrence.path] = other
    changed = Workspace(open=dict(project.workspace.open))
    for path, each in edits.items():
        changed.open[path] = applied(before[path].source.text, each)
    for path, old in before.items():
        try:
            text = changed.text(path)
        except FileError as reason:
            raise CannotError(str(reason)) from None
        new = look(path, text, changed.world(path))
        if (trouble := _difference(old, new, edits)) is not None:
            raise CannotError(f"`{name}` cannot be the new name: {trouble}")


def _difference(old: View, new: View, edits: Mapping[Path, tuple[Edit, ...]]) -> str | None:
    """Describes a name whose meaning changed."""
    meant = _meanings(old)
    means = _meanings(new)
    expected = {
        _moved((old.path, start), edits)[1]: (_moved(place, edits) if place is not None else what)
        for start, (place, what) in meant.items()
    }
    found = {start: place if place is not None else what for start, (place, what) in means.items()}
    for start in sorted(expected.keys() | found.keys()):
        if expected.get(start) != found.get(start):
            line, _ = new.source.position(start)
            return f"in line {line} of {new.path.name} a name would mean something else"
    if (more := [d for d in new.found if d.is_error])[len([d for d in old.found if d.is_error]) :]:
        return more[0].message
    return None


def _meanings(view: View) -> dict[int, tuple[Place | None, str]]:
    """Returns, per offset of a name, the declaration of its meaning, or else its text."""
    return {m.span.start: (place_of(view, m.symbol), m.symbol.name) for m in mentions(view)}


def _moved(place: Place, edits: Mapping[Path, tuple[Edit, ...]]) -> Place:
    """Returns a place after the edits."""
    path, offset = place
    grown = sum(
        len(e.replacement) - (e.span.end - e.span.start) for e in edits.get(path, ()) if e.span.end <= offset
    )
    return path, offset + grown
