"""The standard library: the definitions of `stdlib/*.aidl`, parsed once, when the package is built.

A compile touches few of the library's definitions, so each is kept for itself, as JSON, and decoded when its
name is first looked up; opening the library reads one file and decodes its index. An installation brings that
file along, a checkout makes it anew when anything it depends on has changed (`resources.derived`).
"""

from __future__ import annotations

import functools
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any

from aidl_lang.checking.types import ANY, Signature, Type, parameter_type, type_named
from aidl_lang.common import resources
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.syntax import ast

DERIVED = "library.jsonl"


@record(eq=False)
class Library:
    """The definitions of the standard library.

    sources      the files, in the order of their names
    callables    overloads under one name, in the order of writing
    aliases      synonym → the name it stands for
    constants    file-level `let`s
    diagnostics  of the library itself: empty unless somebody is editing it
    """

    sources: tuple[SourceFile, ...]
    callables: Mapping[str, tuple[Signature, ...]]
    aliases: Mapping[str, str]
    constants: Mapping[str, ast.Let]
    diagnostics: tuple[Diagnostic, ...] = ()
    _modules: Callable[[], tuple[ast.Module, ...]] = field(default=tuple, repr=False)

    @functools.cached_property
    def modules(self) -> tuple[ast.Module, ...]:
        """Returns the trees of whole files, in the order of `sources`; needed by documentation only."""
        return self._modules()


@functools.cache
def load() -> Library:
    """Returns the standard library of this installation, or of this checkout as it stands."""
    try:
        return _opened(resources.derived(DERIVED, _inputs, built), _sources())
    except MistakenLibraryError as found:
        return found.library


class MistakenLibraryError(Exception):
    """Raised for a library with mistakes, as while somebody edits it: they are in its diagnostics."""

    def __init__(self, library: Library) -> None:
        super().__init__("\n".join(d.message for d in library.diagnostics))
        self.library = library


def _sources() -> tuple[SourceFile, ...]:
    return tuple(SourceFile(f"stdlib/{path.name}", path.read_text("utf-8")) for path in _files())


def _files() -> list[Path]:
    return sorted(resources.resource("stdlib").glob("*.aidl"))


def _inputs() -> list[Path]:
    here = Path(__file__).parents[1]
    code = [here / name for name in ("checking/library.py", "common/source.py", "parser.py")]
    code += sorted((here / "syntax").glob("*.py"))
    return [*code, resources.resource("grammar/aidl.lark"), *_files()]


def from_modules(modules: Sequence[ast.Module], diagnostics: Sequence[Diagnostic] = ()) -> Library:
    """Returns a library of the definitions at the file level of some modules."""
    definitions, aliases, constants = _collect(modules)
    shapes = _shape_names(definitions)
    return Library(
        sources=tuple(module.source for module in modules),
        callables={
            name: tuple(signature(node, shapes, standard=True) for node in nodes)
            for name, nodes in definitions.items()
        },
        aliases=aliases,
        constants=constants,
        diagnostics=tuple(diagnostics),
        _modules=lambda: tuple(modules),
    )


def signature(node: ast.Callable, shapes: Sequence[str] = (), *, standard: bool = False) -> Signature:
    """Returns the signature of a definition; `shapes` are the names that may stand as types beside the
    built-in ones. A word that names no type accepts anything here: the checker reports it where it is
    written.
    """
    parameters = tuple(
        (p.name.text, parameter_type(p, shapes) or ANY, p.default is not None) for p in node.parameters or ()
    )
    return Signature(node.name.text, parameters, node, type(node), standard=standard)


class _Stored(Signature):
    """A signature from the data, whose tree is decoded when a call chooses it among many."""

    def __init__(
        self,
        name: str,
        parameters: tuple[tuple[str, Type, bool], ...],
        kind: type[ast.Callable],
        decode: Callable[[], ast.Callable],
    ) -> None:
        fields = {"name": name, "parameters": parameters, "kind": kind, "takes_any": False, "standard": True}
        for field_name, value in (*fields.items(), ("_decode", decode)):
            object.__setattr__(self, field_name, value)

    @functools.cached_property
    def node(self) -> ast.Callable:
        decode: Callable[[], ast.Callable] = self._decode  # type: ignore[attr-defined]
        return decode()


def _brief(node: ast.Callable) -> str:
    """Returns sort and parameters of a definition, as `ShapeDefinition center:point?,radius:length`."""
    parameters = (
        f"{p.name.text}:{p.type.text if p.type else 'any'}{'?' if p.default is not None else ''}"
        for p in node.parameters or ()
    )
    return f"{type(node).__name__} {','.join(parameters)}"


def _stored(name: str, brief: str, shapes: Sequence[str], decode: Callable[[], ast.Callable]) -> Signature:
    kind, _, parameters = brief.partition(" ")
    read = []
    for parameter in filter(None, parameters.split(",")):
        word, _, type_word = parameter.partition(":")
        wanted = type_named(type_word.removesuffix("?"), shapes) or ANY
        read.append((word, wanted, type_word.endswith("?")))
    return _Stored(name, tuple(read), getattr(ast, kind), decode)


def _collect(
    modules: Sequence[ast.Module],
) -> tuple[dict[str, list[ast.Callable]], dict[str, str], dict[str, ast.Let]]:
    definitions: dict[str, list[ast.Callable]] = {}
    aliases: dict[str, str] = {}
    constants: dict[str, ast.Let] = {}
    for module in modules:
        for node in module.statements:
            match node:
                case _ if ast.is_definition(node):
                    definitions.setdefault(node.name.text, []).append(node)
                case ast.Alias(name, target):
                    aliases[name.text] = target.text
                case ast.Let(name):
                    constants[name.text] = node
    return definitions, aliases, constants


def _shape_names(definitions: Mapping[str, Sequence[ast.Callable]]) -> tuple[str, ...]:
    return tuple(name for name, nodes in definitions.items() if isinstance(nodes[0], ast.ShapeDefinition))


def _parse(sources: Sequence[SourceFile]) -> tuple[tuple[ast.Module, ...], tuple[Diagnostic, ...]]:
    from aidl_lang.parser import parse  # an installation does not parse the library

    parsed = [parse(source) for source in sources]
    return tuple(p.module for p in parsed), tuple(d for p in parsed for d in p.diagnostics)


def built() -> bytes:
    """Returns the library as data: a line of JSON for the index, then one for each tree.

    The index maps a name to its overloads, each in brief and with its place, and each alias to its target. A
    place is the number of the file, and where the tree begins and ends behind the index: trees that no
    program uses are not read, however large the library grows. Raises MistakenLibraryError.
    """
    modules, diagnostics = _parse(_sources())
    if diagnostics:
        raise MistakenLibraryError(from_modules(modules, diagnostics))
    definitions, aliases, constants = _collect(modules)
    numbers = {module.source.name: number for number, module in enumerate(modules)}
    body = bytearray()

    def store(node: ast.Node) -> tuple[int, int, int]:
        start = len(body)
        body.extend(_line(ast.encoded(node)))
        return numbers[node.span.source.name], start, len(body)

    index = {
        "definitions": {n: [(_brief(node), *store(node)) for node in ns] for n, ns in definitions.items()},
        "shapes": _shape_names(definitions),
        "constants": {name: store(node) for name, node in constants.items()},
        "aliases": aliases,
    }
    return _line(index) + bytes(body)


def _line(value: object) -> bytes:
    return json.dumps(value, separators=(",", ":")).encode() + b"\n"


def _opened(data: bytes, sources: tuple[SourceFile, ...]) -> Library:
    """Returns the library from the data of `built`: a tree is decoded when its name is first looked up."""
    trees = data.index(b"\n") + 1
    index = json.loads(data[:trees])

    def tree(file: int, start: int, end: int) -> Any:
        return ast.decoded(json.loads(data[trees + start : trees + end]), sources[file])

    def overloads(name: str) -> tuple[Signature, ...]:
        return tuple(
            _stored(name, brief, index["shapes"], functools.partial(tree, *place))
            for brief, *place in index["definitions"][name]
        )

    return Library(
        sources=sources,
        callables=Lazy(tuple(index["definitions"]), overloads),
        aliases=index["aliases"],
        constants=Lazy(tuple(index["constants"]), lambda name: tree(*index["constants"][name])),
        _modules=lambda: _parse(sources)[0],
    )


class Lazy(Mapping[str, Any]):
    """A mapping of known keys to values that are made when first looked up."""

    def __init__(self, keys: tuple[str, ...], make: Callable[[str], Any]) -> None:
        self._values: dict[str, Any] = dict.fromkeys(keys)
        self._make = make

    def __getitem__(self, key: str) -> Any:
        if (value := self._values[key]) is None:
            value = self._values[key] = self._make(key)
        return value

    def __contains__(self, key: object) -> bool:
        return key in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)
