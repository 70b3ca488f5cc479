"""What a program brings in: other files, drawings as files of definitions, and ready-made cuts."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import field, replace
from operator import is_
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, TypeGuard, TypeVar

from aidl_lang.checking.binding import PARAMETERS
from aidl_lang.checking.builtins import COPYING, CUTS, OUTLINES, PATTERNS
from aidl_lang.checking.library import signature
from aidl_lang.checking.rules import blocks
from aidl_lang.checking.symbols import SymbolScope
from aidl_lang.checking.types import Signature
from aidl_lang.common.diagnostics import Diagnostic, Edit, Fix
from aidl_lang.common.names import fold, folded
from aidl_lang.common.prose import rough
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import PROGRAM, WHOLE, FileError, ReadFailure, World, is_drawing, relative_to
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.common.drawings import OutlineFile, Trace

N = TypeVar("N", bound=ast.Node)

# --- Ready-made cuts, such as `clearance_hole("m3")`: holes in a solid or an assembly, elsewhere outlines.
#
# The library has each under one name, as a template and as an operation that makes its outline. The place of
# a call decides which of them it means; the centre given to a hole becomes its placement.

_FOLDED = frozenset(map(fold, CUTS))
_HOLDING = ("solid", "assembly")
_CENTER = 1  # the index of the centre among the arguments of every cut


def with_placed_cuts(module: ast.Module) -> ast.Module:
    """Returns a file in which the centre given to a hole stands behind `at`, or is that of a copy."""
    cuts = _cuts_in(module)
    new: dict[ast.Node, ast.Node | None] = {}
    for node in _assignments(module, cuts):
        if _is_cut(node.value, cuts):
            new[node] = _placed(node)
        else:
            new |= {each: _moved(each) for each in _members(node.value) if _is_cut(each, cuts)}
    return exchanged(module, new) if new else module


def hole_calls(module: ast.Module) -> frozenset[ast.Call]:
    """Returns the calls of a file that make holes, of cuts that can make outlines as well."""
    cuts = _cuts_in(module)
    return frozenset(call for node in _assignments(module, cuts) for call in _made(node.value, cuts))


def meant(candidates: Sequence[Signature], is_hole: bool) -> Sequence[Signature]:
    """Returns the overloads of a ready-made cut that are meant: templates for a hole, else outlines."""
    templates = [c.kind is ast.Structure for c in candidates if c.standard]
    if all(templates) or not any(templates):
        return candidates
    return [c for c in candidates if not c.standard or (c.kind is ast.Structure) is is_hole]


def _cuts_in(module: ast.Module) -> frozenset[str]:
    """Returns the folded names of cuts that a file may mean: none that it defines itself."""
    text = folded(module.source.text)
    found = {name for name in _FOLDED if name in text}
    if found:
        found -= {fold(n.name.text) for n in ast.walk(module) if isinstance(n, ast.Callable | ast.Alias)}
    return frozenset(found)


def _assignments(module: ast.Module, cuts: Set[str]) -> Iterator[ast.Assign]:
    """Yields the assignments of a file in which a cut makes a hole; none if it has no cuts."""
    return _holding(module, "", frozenset()) if cuts else iter(())


def _holding(body: ast.Module | ast.Block, kind: str, outlines: Set[str]) -> Iterator[ast.Assign]:
    """Yields those in a body: `kind` is that of the structure around, of `outlines` others are made."""
    for node in body.statements:
        match node:
            case ast.Structure(body=inner):
                yield from _holding(inner, node.kind, _used_as_outlines(inner))
            case ast.For() | ast.If():
                for block in blocks(node):
                    yield from _holding(block, kind, outlines)
            case ast.Assign(name=name) if kind in _HOLDING and name.text not in outlines:
                yield node


def _is_cut(value: ast.Expression, cuts: Set[str]) -> TypeGuard[ast.Call]:
    return isinstance(value, ast.Call) and fold(value.callee.text) in cuts


def _members(value: ast.Expression) -> Iterator[ast.Expression]:
    """Yields the expressions of which a value is, or which make its members."""
    match value:
        case ast.List(items=items):
            inner: Sequence[ast.Expression] = items
        case ast.Comprehension(element=element):
            inner = (element,)
        case ast.Conditional(then=then, otherwise=otherwise):
            inner = (then, otherwise)
        case _:
            yield value
            return
    for each in inner:
        yield from _members(each)


def _made(value: ast.Expression, cuts: Set[str]) -> Iterator[ast.Call]:
    """Yields the cuts that an assignment makes: its value, members of it, or what it makes copies of."""
    for each in _members(value):
        if _is_cut(each, cuts):
            yield each
        elif isinstance(each, ast.Call) and each.callee.text in COPYING | PATTERNS:
            named = (a.value for a in each.arguments if a.name is None or fold(a.name.text) == "x")
            if (of := each.receiver or next(named, None)) is not None:
                yield from _made(of, cuts)


def _placed(node: ast.Assign) -> ast.Assign:
    assert isinstance(node.value, ast.Call)
    placement, (call, center) = node.placement, _without_center(node.value)
    if center is None or (placement is not None and placement.at is not None):
        return node
    rotated = placement.rotated if placement is not None else None
    return replace(node, value=call, placement=ast.Placement(center, rotated, span=center.span))


def _moved(cut: ast.Call) -> ast.Call:
    """Returns a cut with a centre as a copy that is moved there."""
    call, center = _without_center(cut)
    if center is None:
        return cut
    callee = ast.Identifier("copy", span=cut.callee.span)
    by = ast.Argument(ast.Identifier("by", span=center.span), center, span=center.span)
    return ast.Call(callee, None, (ast.Argument(None, call, span=call.span), by), span=cut.span)


def exchanged(node: N, new: Mapping[ast.Node, ast.Node | None]) -> N:
    """Returns a tree in which some of the nodes below the first are others, or gone; itself if none are."""

    def other(inner: ast.Node) -> ast.Node | None:
        return new[inner] if inner in new else exchanged(inner, new)

    changed: dict[str, object] = {}
    names: tuple[str, ...] = node.__match_args__
    for name in names:
        value = getattr(node, name)
        if isinstance(value, ast.Node):
            held: object = other(value)
        elif type(value) is tuple:
            found = [other(each) if isinstance(each, ast.Node) else each for each in value]
            held = tuple(each for each in found if each is not None)
            held = value if len(held) == len(value) and all(map(is_, value, held)) else held
        else:
            continue
        if held is not value:
            changed[name] = held
    return replace(node, **changed) if changed else node  # type: ignore[arg-type]


def _used_as_outlines(body: ast.Block) -> frozenset[str]:
    calls = (n for n in ast.walk(body) if isinstance(n, ast.Call) and n.callee.text in OUTLINES)
    return frozenset(n.text for call in calls for n in ast.walk(call) if isinstance(n, ast.Name))


def _without_center(call: ast.Call) -> tuple[ast.Call, ast.Expression | None]:
    """Returns a call without its centre, and the centre; None for a call that has none."""
    words = ((a, fold(a.name.text)) for a in call.arguments if a.name is not None)
    named = (a for a, word in words if "center" in (word, *PARAMETERS.get(word, ())))
    unnamed = [a for a in call.arguments if a.name is None]
    by_place = unnamed[_CENTER] if len(unnamed) > _CENTER and call.receiver is None else None
    if (found := next(named, by_place)) is None:
        return call, None
    return replace(call, arguments=tuple(a for a in call.arguments if a is not found)), found.value


# --- Drawings of other programs as files of definitions: a shape for the whole of one, and for each name in
# it.
#
# They are written in AIDL, on what the library has for the purpose, so that a drawing is called, measured,
# completed and explained as any shape is. What they say is no text of the author's: like the library's it is
# not looked through for mistakes, and places in it are told as those of the call.


@record(eq=False)
class ImportedDrawing:
    """A drawing that a program imports: its outlines, and the definitions that stand for them."""

    outlines: OutlineFile
    module: ast.Module
    digest: bytes

    def scope(self, library: SymbolScope) -> SymbolScope:
        """Returns the names that it defines."""
        scope = SymbolScope(self.module, library, (self.module,))
        for node in self.module.statements:
            assert isinstance(node, ast.ShapeDefinition)
            scope.callables.setdefault(node.name.text, []).append(signature(node))
        return scope


def digest(data: bytes) -> bytes:
    """Returns what tells the contents of a file from all others."""
    return hashlib.sha256(data).digest()


def nameless(statement: ast.Import, name: str) -> Diagnostic:
    """Returns the diagnostic on a drawing that is imported without a name."""
    span = statement.path.span
    edit = Edit(Span(span.source, span.end, span.end), f" as {name}")
    message = f"`{statement.path.value}` is a drawing, and is imported under a name"
    span = statement.span
    hint = f"then `{name}()` is all of it, and `{name}.part()` what is called `part` in it"
    fix = Fix(f"call it `{name}`", (edit,), is_sure=True)
    return Diagnostic("E0361", message, span, "nothing says how it is called here", hints=(hint,), fix=fix)


def read(path: str, data: bytes) -> ImportedDrawing:
    """Returns a drawing file. Raises DrawingError."""
    from aidl_lang.common.drawings import outlines
    from aidl_lang.parser import parse

    found = outlines(path, data)
    parsed = parse(SourceFile(path, " ".join(_definitions(found))))
    assert not parsed.diagnostics
    statements = (
        replace(s, doc=_doc(path, found, s.name.text)) if isinstance(s, ast.ShapeDefinition) else s
        for s in parsed.module.statements
    )
    return ImportedDrawing(found, replace(parsed.module, statements=tuple(statements)), digest(data))


def _doc(path: str, found: OutlineFile, name: str) -> str:
    trace = found.trace(name)
    left, bottom, right, top = trace.box
    size = f"{rough(right - left)} × {rough(top - bottom)} mm"
    return f"All outlines of {path}: {size}." if trace is found.whole else f"{name} of {path}: {size}."


_OPTIONS = "angle: turn = 0deg, filled: bool = false, rotatable: bool = false"


def _definitions(found: OutlineFile) -> Iterator[str]:
    """Yields the shapes: about the file's origin and the outlines' middle, by a scale, width or height."""
    for name, trace in ((WHOLE, found.whole), *found.parts.items()):
        inner = _inner(found, trace)
        left, bottom, right, top = trace.box
        width, height = right - left, top - bottom
        middle = f"({(left + right) / 2!r}mm * scale, {(bottom + top) / 2!r}mm * scale)"
        from_start = f"let center = start + turned({middle}, angle)"
        from_center = f"let start = center - turned({middle}, angle)"
        sizes = f"let width = {width!r}mm * scale let height = {height!r}mm * scale"
        ways = [
            ("start: point = (0, 0), scale: number = 1", from_start, sizes),
            ("center: point, scale: number = 1", from_center, sizes),
        ]
        if width > 0.0:
            size = f"let scale = width / {width!r}mm let height = {height!r}mm * scale"
            ways.append(("center: point = (0, 0), width: length", from_center, size))
        if height > 0.0:
            size = f"let scale = height / {height!r}mm let width = {width!r}mm * scale"
            ways.append(("center: point = (0, 0), height: length", from_center, size))
        for parameters, place, size in ways:
            yield (
                f"shape {name}({parameters}, {_OPTIONS}) {{ {size} {place} "
                f'art = traced("{name}", start, scale * 1mm, angle, filled) {inner} }}'
            )


def _inner(found: OutlineFile, trace: Trace) -> str:
    """Returns the text of the names within a part: of those that have some of its elements and no others."""
    own = set(trace.elements)
    others = ((name, part) for name, part in found.parts.items() if part is not trace)
    names = (name for name, part in others if own.issuperset(part.elements) and name != trace.name)
    return " ".join(f'let {name} = traced_part(art, "{name}")' for name in names)


# --- The files that a program imports, each read and parsed once.
#
# A path is relative to the file that imports it, ends in `.aidl`, and may not leave the project, which is
# the folder of the program and all below it. Drawings of other programs, `.svg` and `.dxf`, are read as
# files of definitions (see above). No other file is read, as diagnostics on a file quote it. Mistakes
# inside an imported file are reported at their place there.

SUFFIX = PROGRAM
MAX_FILES = 200
MAX_CHARACTERS = 2_000_000
"""Characters of all imported programs together."""
MAX_BYTES = 20_000_000
"""Bytes of all imported drawings together."""


@record(frozen=False)
class ImportedModules:
    """The files of a program.

    modules  every file once, those that are imported before those that import them; the program is the last
    targets  import statements → the file they bring; without those that failed
    drawings  the files among these that are drawings of other programs
    """

    modules: list[ast.Module] = field(default_factory=list)
    targets: dict[ast.Import, ast.Module] = field(default_factory=dict)
    drawings: dict[ast.Module, ImportedDrawing] = field(default_factory=dict)
    diagnostics: list[Diagnostic] = field(default_factory=list)


def load_imports(main: ast.Module, world: World | None) -> ImportedModules:
    """Reads the files that a program imports, directly or by way of others."""
    loader = _Loader(world)
    loader.visit(main, PurePosixPath(main.source.name.replace("\\", "/")).name)
    return loader.result


class _Loader:
    def __init__(self, world: World | None) -> None:
        self.world = world
        self.result = ImportedModules()
        self.known: dict[str, ast.Module] = {}
        self.open: list[str] = []
        self.characters = self.bytes = 0

    def visit(self, module: ast.Module, path: str) -> None:
        """Loads the imports of a file, then counts the file itself."""
        self.known[path] = module
        self.open.append(path)
        for statement in module.statements:
            if isinstance(statement, ast.Import):
                self._import(statement, path)
        self.open.pop()
        self.result.modules.append(module)

    def _import(self, statement: ast.Import, importer: str) -> None:
        written = statement.path.value
        try:
            path = relative_to(written, importer)
        except FileError:
            hint = "a program imports only from its own folder and the folders below it"
            self._report("E0212", f"`{written}` lies outside the project", statement.path, hint)
            return
        if path in self.open:
            chain = " → ".join([*self.open[self.open.index(path) :], path])
            hint = "move what both need into a file of its own, which imports neither"
            self._report("E0211", f"files import each other in a circle: {chain}", statement.path, hint)
            return
        module = self.known.get(path) or self._read(statement, path)
        if module is not None:
            self.result.targets[statement] = module

    def _read(self, statement: ast.Import, path: str) -> ast.Module | None:
        if len(self.known) > MAX_FILES or len(self.open) > MAX_FILES // 4:
            self._report("E0804", f"a program may import at most {MAX_FILES} files", statement.path)
            return None
        if is_drawing(path) and statement.alias is None and not statement.names:
            name = re.sub(r"\W+", "_", PurePosixPath(path).stem).strip("_")
            self.result.diagnostics.append(nameless(statement, name if name.isidentifier() else "art"))
            return None
        if self.world is None:
            message = f"`{statement.path.value}` cannot be imported: only this text is at hand"
            self._report("E0210", message, statement.path)
            return None
        try:
            read_file = self._drawing if is_drawing(path) else self._program
            return read_file(statement, path, self.world)
        except FileError as error:
            hint = "paths are relative to the file that imports"
            if error.reason is ReadFailure.NOT_A_PROGRAM:
                hint = f"`aidl check {path}` tells what is wrong in it"
            self._report("E0210", f"`{path}` cannot be imported: {error.reason}", statement.path, hint)
            return None

    def _program(self, statement: ast.Import, path: str, world: World) -> ast.Module | None:
        if PurePosixPath(path).suffix != SUFFIX:
            other = "the library needs no import"
            if PurePosixPath(path).suffix:
                other = "drawings of other programs end in `.svg` or `.dxf`"
            hints = f"programs end in `{SUFFIX}`: `{statement.path.value}{SUFFIX}`", other
            message = f"`{path}` cannot be imported: its name does not end in `{SUFFIX}`"
            self._report("E0210", message, statement.path, *hints)
            return None
        text = world.read(path)
        self.characters += len(text)
        if self.characters > MAX_CHARACTERS:
            limit = f"{MAX_CHARACTERS:,} characters"
            self._report("E0804", f"what a program imports may have at most {limit}", statement.path)
            return None
        from aidl_lang.parser import parse

        parsed = parse(SourceFile(path, text))
        module, misplaced = with_inner_imports(with_placed_cuts(parsed.module))
        self.result.diagnostics += parsed.diagnostics + misplaced
        self.visit(module, path)
        return module

    def _drawing(self, statement: ast.Import, path: str, world: World) -> ast.Module | None:
        from aidl_lang.common.drawings import DrawingError

        data = world.read_bytes(path)
        self.bytes += len(data)
        if self.bytes > MAX_BYTES:
            most = f"may have at most {MAX_BYTES // 1_000_000} MB"
            self._report("E0804", f"drawings that a program imports {most}", statement.path)
            return None
        try:
            found = read(path, data)
        except DrawingError as error:
            self._report(error.code, error.message, statement.path, *error.hints)
            return None
        self.known[path] = found.module
        self.result.drawings[found.module] = found
        for remark in found.outlines.remarks:
            self._report(remark.code, remark.message, statement.path, *remark.hints)
        return found.module

    def _report(self, code: str, message: str, node: ast.Node, *hints: str) -> None:
        self.result.diagnostics.append(Diagnostic(code, message, node.span, hints=hints))


def with_inner_imports(module: ast.Module) -> tuple[ast.Module, list[Diagnostic]]:
    """Returns a file with the imports of its blocks moved before its statements, and E0353 for each."""
    top = [s for s in module.statements if isinstance(s, ast.Import)]
    if module.source.text.count("import") == len(top):
        return module, []
    inner = list(_imports(s for s in module.statements if not isinstance(s, ast.Import)))
    end = top[-1].span.end if top else 0
    place = Span(module.source, end, end)
    texts = [f"\n{node.span.text}" if top else f"{node.span.text}\n" for node in inner]
    found = [_misplaced(node, Edit(place, text)) for node, text in zip(inner, texts, strict=True)]
    return replace(module, statements=(*inner, *module.statements)), found


def _imports(nodes: Iterator[ast.Node]) -> Iterator[ast.Import]:
    for node in nodes:
        if isinstance(node, ast.Import):
            yield node
        elif isinstance(node, ast.Block | ast.Callable | ast.For | ast.If):
            yield from _imports(ast.children(node))


def _misplaced(node: ast.Import, insertion: Edit) -> Diagnostic:
    message = "an import stands at the top of the file"
    fix = Fix("move it to the top", (Edit(node.span.with_separator, ""), insertion), is_sure=True)
    return Diagnostic("E0353", message, node.span, "what it brings is known in the whole file", fix=fix)
