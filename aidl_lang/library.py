"""The standard library: the definitions of `stdlib/*.aidl`, parsed once and kept in the user's cache.

A compile touches few of the library's definitions, so each is pickled for itself and unpickled when its name
is first asked for; opening the library reads one file and decodes its index. The cache is named after a
digest of everything the trees depend on, hence it is never stale, only unused. It holds nothing but syntax
trees: the unpickler knows no other classes, and a file that another user could have written is not opened at
all.
"""

from __future__ import annotations

import functools
import hashlib
import io
import os
import pickle
import stat
import struct
import sys
import tempfile
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

from aidl_lang import ast, resources
from aidl_lang.diagnostics import Diagnostic
from aidl_lang.source import SourceFile, Span
from aidl_lang.types import ANY, Signature, Type, parameter_type, type_named

_FORMAT = b"aidl-library-3\n"
_HEAD = struct.Struct(">II32s")
_Place: TypeAlias = tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Library:
    """
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
        """The trees of whole files, in the order of `sources`; needed by documentation only."""
        return self._modules()


@functools.cache
def load() -> Library:
    """The standard library of this installation."""
    files = sorted(resources.resource("stdlib").glob("*.aidl"))
    sources = tuple(SourceFile(f"stdlib/{path.name}", path.read_text("utf-8")) for path in files)
    cache = _cache_file(_digest(sources))
    blob = _read_private(cache) if cache else None
    if blob is not None and (library := _from_cache(blob, sources)) is not None:
        return library
    modules, diagnostics = _parse(sources)
    if cache and not diagnostics:
        _write_private(cache, _to_cache(modules, sources))
    return from_modules(modules, diagnostics)


def from_modules(modules: Sequence[ast.Module], diagnostics: Sequence[Diagnostic] = ()) -> Library:
    """A library of modules at hand: the definitions at their file level."""
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
    """What a definition asks of its callers; `shapes` are the names that may stand as types beside the
    built-in ones. A word that names no type accepts anything here: the checker reports it where it is
    written.
    """
    parameters = tuple(
        (p.name.text, parameter_type(p, shapes) or ANY, p.default is not None) for p in node.parameters or ()
    )
    return Signature(node.name.text, parameters, node, type(node), standard=standard)


class _Stored(Signature):
    """A signature from the cache. Calls choose among many; the tree of the chosen one is decoded."""

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
    """Sort and parameters of a definition, as `ShapeDefinition center:point?,radius:length`."""
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
                case ast.FunctionDefinition() | ast.ShapeDefinition() | ast.ConstraintDefinition():
                    definitions.setdefault(node.name.text, []).append(node)
                case ast.Structure(parameters=parameters) if parameters is not None:
                    definitions.setdefault(node.name.text, []).append(node)
                case ast.Alias(name, target):
                    aliases[name.text] = target.text
                case ast.Let(name):
                    constants[name.text] = node
                case _:
                    pass
    return definitions, aliases, constants


def _shape_names(definitions: Mapping[str, Sequence[ast.Callable]]) -> tuple[str, ...]:
    return tuple(name for name, nodes in definitions.items() if isinstance(nodes[0], ast.ShapeDefinition))


def _parse(sources: Sequence[SourceFile]) -> tuple[tuple[ast.Module, ...], tuple[Diagnostic, ...]]:
    from aidl_lang.parser import parse  # a warm start does not need the parser for the library

    parsed = [parse(source) for source in sources]
    return tuple(p.module for p in parsed), tuple(d for p in parsed for d in p.diagnostics)


# --- The cache -----------------------------------------------------------------------------------


def _digest(sources: Sequence[SourceFile]) -> str:
    """A name for everything the cached trees depend on."""
    here = Path(__file__).parent
    digest = hashlib.sha256(_FORMAT + sys.version.encode())
    code = [here / name for name in ("ast.py", "parser.py", "source.py")]
    for path in [*code, *sorted((here / "syntax").glob("*.py")), resources.resource("grammar/aidl.lark")]:
        digest.update(hashlib.sha256(path.read_bytes()).digest())
    for source in sources:
        digest.update(hashlib.sha256(f"{source.name}\n{source.text}".encode()).digest())
    return digest.hexdigest()


def _cache_file(digest: str) -> Path | None:
    """Where the cache of this user lies; None where there is no home to keep it in."""
    try:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    except RuntimeError:  # no home directory can be found out
        return None
    return base / "aidl" / f"library-{digest[:32]}.pickle" if base.is_absolute() else None


def _is_private(path: Path) -> bool:
    """Whether only this user can have written the file or directory, and it is not a link to elsewhere."""
    state = path.lstat()
    if stat.S_ISLNK(state.st_mode):
        return False
    if not hasattr(os, "getuid"):  # Windows keeps user directories private by access lists
        return True
    return state.st_uid == os.getuid() and not state.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def _read_private(path: Path) -> bytes | None:
    try:
        if _is_private(path.parent) and _is_private(path):
            return path.read_bytes()
    except OSError:
        pass  # no cache yet, or none that can be read: the library is parsed instead
    return None


def _write_private(path: Path, blob: bytes) -> None:
    """Write in one step, so that a reader sees the whole file or none. A cache that cannot be kept is no
    harm.
    """
    temporary = ""
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not _is_private(path.parent):
            return
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=".library-")
        with os.fdopen(handle, "wb") as file:
            file.write(blob)
        os.replace(temporary, path)
        for old in path.parent.glob("library-*.pickle"):
            if old != path:
                old.unlink(missing_ok=True)
    except OSError:
        if temporary:
            Path(temporary).unlink(missing_ok=True)


def _to_cache(modules: Sequence[ast.Module], sources: Sequence[SourceFile]) -> bytes:
    """The format line, the lengths of index and trees, a checksum of the index, the index, and the trees.

    The index maps a name to its overloads, each in brief and with its place, and each alias to its target. A
    place is where a tree begins and ends, and its checksum: what is not used is not read, however large the
    library grows.
    """
    definitions, aliases, constants = _collect(modules)
    body = bytearray()

    def store(node: ast.Node) -> _Place:
        start, tree = len(body), _encode(node, sources)
        body.extend(tree)
        return start, len(body), zlib.crc32(tree)

    index = {
        "definitions": {n: [(_brief(node), store(node)) for node in ns] for n, ns in definitions.items()},
        "shapes": _shape_names(definitions),
        "constants": {name: store(node) for name, node in constants.items()},
        "aliases": aliases,
    }
    head = pickle.dumps(index, protocol=5)
    return _FORMAT + _HEAD.pack(len(head), len(body), hashlib.sha256(head).digest()) + head + bytes(body)


def _from_cache(blob: bytes, sources: tuple[SourceFile, ...]) -> Library | None:
    """None when the file is not what `_to_cache` wrote. A tree that was damaged since is parsed anew."""
    start = len(_FORMAT) + _HEAD.size
    if not blob.startswith(_FORMAT) or len(blob) < start:
        return None
    length, rest, checksum = _HEAD.unpack_from(blob, len(_FORMAT))
    head, body = blob[start : start + length], memoryview(blob)[start + length :]
    if len(body) != rest or hashlib.sha256(head).digest() != checksum:
        return None
    index = _Trees(head, sources).load()
    parsed = functools.cache(lambda: from_modules(*_parse(sources)))

    def tree(place: _Place) -> Any:
        """None if it was damaged."""
        start, end, checksum = place
        return _Trees(body[start:end], sources).load() if zlib.crc32(body[start:end]) == checksum else None

    def overloads(name: str) -> tuple[Signature, ...]:
        def decode(number: int, place: _Place) -> ast.Callable:
            found: ast.Callable | None = tree(place) or parsed().callables[name][number].node
            assert found is not None
            return found

        return tuple(
            _stored(name, brief, index["shapes"], functools.partial(decode, number, place))
            for number, (brief, place) in enumerate(index["definitions"][name])
        )

    def constant(name: str) -> ast.Let:
        found: ast.Let = tree(index["constants"][name]) or parsed().constants[name]
        return found

    return Library(
        sources=sources,
        callables=_Lazy(tuple(index["definitions"]), overloads),
        aliases=index["aliases"],
        constants=_Lazy(tuple(index["constants"]), constant),
        _modules=lambda: _parse(sources)[0],
    )


class _Lazy(Mapping[str, Any]):
    """A mapping whose keys are known and whose values are made when first asked for."""

    def __init__(self, keys: tuple[str, ...], make: Callable[[str], Any]) -> None:
        self._values: dict[str, Any] = dict.fromkeys(keys)
        self._make = make

    def __getitem__(self, key: str) -> Any:
        value = self._values[key]
        if value is None:
            value = self._values[key] = self._make(key)
        return value

    def __contains__(self, key: object) -> bool:
        return key in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)


def _encode(node: ast.Node, sources: Sequence[SourceFile]) -> bytes:
    """A tree without the text it was parsed from; spans as plain calls, which decode several times faster
    than the state of a frozen dataclass with slots.
    """
    order = {id(source): i for i, source in enumerate(sources)}
    buffer = io.BytesIO()
    pickler = pickle.Pickler(buffer, protocol=5)
    pickler.dispatch_table = {
        Span: lambda span: (Span, (span.source, span.start, span.end)),
        SourceFile: lambda source: (_source, (order[id(source)],)),
    }
    pickler.dump(node)
    return buffer.getvalue()


def _source(index: int) -> SourceFile:
    """Stands in a pickle for the source file of that number; `_Trees` puts the file in its place."""
    raise AssertionError(index)


class _Trees(pickle.Unpickler):
    """Decodes syntax trees and nothing else."""

    def __init__(self, blob: bytes | memoryview, sources: Sequence[SourceFile]) -> None:
        super().__init__(io.BytesIO(blob))
        self._sources = sources

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) == (__name__, "_source"):
            return self._sources.__getitem__
        if (module, name) == (Span.__module__, "Span"):
            return Span
        if module == ast.__name__ and isinstance(known := getattr(ast, name, None), type):
            return known
        raise pickle.UnpicklingError(f"{module}.{name} is not part of a syntax tree")
