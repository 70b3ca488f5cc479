"""The meaning of each name in a text: where names are defined and used, and renaming everywhere."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from pathlib import Path
from typing import TypeAlias

from aidl_lang.checking.calls import arguments
from aidl_lang.checking.symbols import Symbol, SymbolKind
from aidl_lang.checking.types import Signature
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.names import find, fold
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import FileError
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import load_tables, tokenize
from aidl_server.ide.site import around, scope_at
from aidl_server.ide.workspace import Project, View, Workspace, applied, look


class CannotError(Exception):
    """Raised if a request cannot be carried out, with the reason for people."""


Place: TypeAlias = tuple[Path, int]
"""The file and the offset of the first declaration of a symbol: the same in every view of a project."""


@record()
class Mention:
    """One occurrence of a name. `node` is the named node: a Name, Member, Call, Identifier, …"""

    span: Span
    node: ast.Node
    symbol: Symbol

    @property
    def is_declaration(self) -> bool:
        return any(self.span == declaration.span for declaration in self.symbol.declarations)


def mentions(view: View) -> Iterator[Mention]:
    """Yields every name of the file whose meaning is known."""
    for node in ast.walk(view.module):
        yield from _mentions_of(view, node)


def mention_at(view: View, offset: int) -> Mention | None:
    """Returns the name at an offset, or that ends there."""
    for node in reversed(around(view.module, offset)):
        for mention in _mentions_of(view, node):
            if mention.span.start <= offset <= mention.span.end:
                return mention
    return None


def place_of(view: View, symbol: Symbol) -> Place | None:
    """Returns the first declaration of a symbol; None for a built-in."""
    if not symbol.declarations:
        return None
    first = symbol.declarations[0].span
    file = view.file(first.source)
    return None if file is None else (file, first.start)


def _mentions_of(view: View, node: ast.Node) -> Iterator[Mention]:
    uses = view.resolution.uses
    symbol = uses.get(node)
    match node:
        case ast.Name() | ast.Identifier() if symbol is not None:
            yield Mention(node.span, node, symbol)
        case ast.Member() if symbol is not None:
            yield Mention(node.name.span, node, symbol)
        case ast.Call():
            if symbol is not None:
                yield Mention(node.callee.span, node, _as_written(view, node, symbol))
            yield from _named_arguments(view, node)
        case ast.Import():
            yield from _imported_names(view, node)
        case ast.Alias():
            yield from _alias_target(view, node)


def _as_written(view: View, call: ast.Call, symbol: Symbol) -> Symbol:
    if fold(call.callee.text) == fold(symbol.name):
        return symbol
    for scope in scope_at(view, call.span.start).chain():
        if (name := find(call.callee.text, scope.aliases)) is not None:
            return scope.aliases[name]
    return symbol


def chosen(view: View, call: ast.Call) -> Signature | None:
    """Returns the overload that a call means; of several that fit, the best."""
    fits = view.program.inference.fits.get(call)
    return fits[0].signature if fits else None


def _named_arguments(view: View, call: ast.Call) -> Iterator[Mention]:
    fits = view.program.inference.fits.get(call)
    if not fits:
        return
    offset = len(arguments(view.program.inference, call)) - len(call.arguments)
    for index, argument in enumerate(call.arguments, offset):
        meant = fits[0].parameter_of(index) if argument.name is not None else None
        if argument.name is not None and meant is not None:
            yield Mention(argument.name.span, argument, parameter(view, fits[0].signature, meant))


def parameter(view: View, signature: Signature, name: str) -> Symbol:
    node = parameter_node(signature, name)
    if node is not None and signature.node is not None:
        view.resolution.scope_of(signature.node)  # which enters the names of a library definition
        if (symbol := view.resolution.uses.get(node.name)) is not None:
            return symbol
    return Symbol(name, SymbolKind.ARGUMENT)


def parameter_node(signature: Signature, name: str) -> ast.Parameter | None:
    """Returns the declaration of a parameter; None for a built-in."""
    parameters = (signature.node.parameters or ()) if signature.node is not None else ()
    return next((p for p in parameters if p.name.text == name), None)


def free_name(view: View, name: str) -> str:
    """Returns the name, numbered if the text or the library has it."""
    taken = {fold(node.text) for node in ast.walk(view.module) if isinstance(node, ast.Identifier | ast.Name)}
    taken |= set(map(fold, view.program.library.callables))
    candidate, count = name, 1
    while fold(candidate) in taken:
        count += 1
        candidate = f"{name}_{count}"
    return candidate


def _imported_names(view: View, node: ast.Import) -> Iterator[Mention]:
    target = view.resolution.imports.get(node)
    if target is None:
        return
    scope = view.resolution.scopes[target]
    for name in node.names:
        if name in view.resolution.uses:
            continue  # a value, which stands in the table already
        for signature in scope.callables.get(name.text, ())[:1]:
            if signature.node in view.resolution.of_definition:
                yield Mention(name.span, name, view.resolution.of_definition[signature.node])
        if name.text in scope.aliases:
            yield Mention(name.span, name, scope.aliases[name.text])


def _alias_target(view: View, node: ast.Alias) -> Iterator[Mention]:
    found = scope_at(view, node.span.start).called(node.target.text)
    if found is not None and found[1]:
        definition = found[1][0].node
        symbol = view.resolution.of_definition.get(definition) if definition is not None else None
        if symbol is None and definition is not None:
            symbol = Symbol(found[0], SymbolKind.FUNCTION, definition, None, [definition.name], [definition])
        yield Mention(node.target.span, node, symbol or Symbol(found[0], SymbolKind.BUILTIN))


# --- Where a name leads to, and that of a file.


def definitions(view: View, offset: int) -> list[Span]:
    """Returns the declarations of the name at an offset, or the beginning of the file that is imported."""
    mention = mention_at(view, offset)
    if mention is not None:
        spans = [declaration.span for declaration in mention.symbol.declarations]
        drawings = view.resolution.drawings  # what is defined by one begins where it does: it has no text
        return [Span(s.source, 0, 0) if s.source in drawings else s for s in spans]
    for node in around(view.module, offset):
        if isinstance(node, ast.Import) and node.path.span.start <= offset <= node.path.span.end:
            target = view.resolution.imports.get(node)
            return [Span(target.source, 0, 0)] if target is not None else []
    return []


def links(view: View) -> list[tuple[Span, Path]]:
    """Returns the places of files' names, without quotes, with the files; none that cannot be read."""
    imports = [s for s in view.module.statements if isinstance(s, ast.Import)]
    targets = ((s.path.span, view.resolution.imports[s]) for s in imports if s in view.resolution.imports)
    files = ((span, view.file(target.source)) for span, target in targets)
    return [(view.span(span.start + 1, span.end - 1), file) for span, file in files if file is not None]


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
    others = (other for other in project.views_with(symbol.name) if other.path != view.path)
    named = (occurrence for each in chain([view], others) for occurrence in occurrences(each, place))
    return _ordered([*declarations(view, symbol), *named])


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


def _ordered(found: Iterable[Occurrence]) -> list[Occurrence]:
    unique = {(o.path, o.span.start, o.span.end): o for o in found}
    return [unique[key] for key in sorted(unique)]


# --- Renames a thing everywhere, so that the programs keep their meaning.


def renameable(view: View, offset: int) -> Span:
    """Returns the name at an offset if it can be changed. Raises CannotError."""
    return _own(view, offset).span


def rename(project: Project, view: View, offset: int, name: str) -> dict[Path, tuple[Edit, ...]]:
    """Returns the edits by file that rename a thing. Raises CannotError if a meaning would change."""
    mention = _own(view, offset)
    tokens = tokenize(SourceFile("name", name)).tokens
    if len(tokens) != 2 or tokens[0].text != name or not name.isidentifier():
        raise CannotError(f"`{name}` is no name: names are made of letters, digits and `_`")
    if tokens[0].kind != "NAME" or name in load_tables().reserved:
        raise CannotError(f"`{name}` is a word of the language")
    found = references(project, view, offset)
    by_file: dict[Path, list[Edit]] = defaultdict(list)
    for occurrence in found:
        by_file[occurrence.path].append(Edit(occurrence.span, name))
    edits = {path: tuple(each) for path, each in by_file.items()}
    _require_same_meaning(project, view, mention.symbol, found, edits, name)
    return edits


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
    expected = {
        _moved((old.path, start), edits)[1]: _moved(what, edits) if isinstance(what, tuple) else what
        for start, what in _meanings(old).items()
    }
    found = _meanings(new)
    for start in sorted(expected.keys() | found.keys()):
        if expected.get(start) != found.get(start):
            line, _ = new.source.position(start)
            return f"in line {line} of {new.path.name} a name would mean something else"
    if (more := [d for d in new.found if d.is_error])[len([d for d in old.found if d.is_error]) :]:
        return more[0].message
    return None


def _meanings(view: View) -> dict[int, Place | str]:
    """Returns, per offset of a name, the declaration of its meaning, or else its text."""
    return {m.span.start: place_of(view, m.symbol) or m.symbol.name for m in mentions(view)}


def _moved(place: Place, edits: Mapping[Path, tuple[Edit, ...]]) -> Place:
    path, offset = place
    before = [edit for edit in edits.get(path, ()) if edit.span.end <= offset]
    grown = sum(len(edit.replacement) - (edit.span.end - edit.span.start) for edit in before)
    return path, offset + grown
