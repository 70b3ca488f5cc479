"""The intents of a program, and the canonical keys by which statements of the same meaning are equal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import field
from enum import StrEnum
from functools import cached_property

from aidl_lang.checking.symbols import Resolution
from aidl_lang.checking.units import UNITS
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.syntax import ast

# --- Canonical keys of statements: equal for statements of the same meaning, however they are spelled.
#
# A key is a nested tuple. References are resolved to whole paths, names to what they are synonyms of,
# methods to calls and units to millimetres and degrees; operands stand in a fixed order where order does not
# matter.

Path = tuple[str, ...]
"""Names from the outermost structure inwards; a written index is a component of its own, as `[3]`."""
Key = tuple[object, ...]

_EITHER_WAY = """
coincident concentric parallel perpendicular collinear equal equal_length equal_radius tangent distance
horizontal vertical horizontal_distance vertical_distance clearance gap overlaps touching no_overlap
overlapping same_width same_height same_size align_left align_right align_top align_bottom align_center_x
align_center_y min max
"""
_SYMMETRIC = frozenset(_EITHER_WAY.split())
_TURNED = {">=": "<=", ">": "<"}


def index_of(node: ast.Expression) -> str | None:
    """Returns the component of a path for a written index; None for a computed one."""
    return f"[{node.text}]" if isinstance(node, ast.Number) else None


def own_path(name: ast.Identifier, indices: Collection[ast.Expression]) -> Path:
    """Returns the last components of the path declared by `name[indices]`."""
    written = [index_of(i) for i in indices]
    return (name.text, *(i for i in written if i is not None)) if all(written) else (name.text,)


@record()
class Reader:
    """Makes keys of the expressions of one structure.

    home    the path of the structure
    things  all paths of structures and geometry
    names   canonical spellings of names, members, callees and arguments
    loops   variables of the loops around, and how deep each is
    """

    home: Path
    things: Collection[Path]
    names: Mapping[ast.Node, str]
    loops: Mapping[str, int] = field(default_factory=dict)

    def spelled(self, node: ast.Identifier | ast.Name) -> str:
        return self.names.get(node, node.text)

    def thing_named(self, name: str) -> Path | None:
        """Returns the thing that a name means here, the nearest first."""
        if name == "self":
            return self.home
        paths = ((*self.home[:k], name) for k in range(len(self.home), -1, -1))
        return next((path for path in paths if path in self.things), None)

    def reference(self, node: ast.Expression) -> tuple[Path, Path] | None:
        """Returns the thing that an expression refers to, and its field or index."""
        match node:
            case ast.Name():
                thing = None if node.text in self.loops else self.thing_named(self.spelled(node))
                return None if thing is None else (thing, ())
            case ast.Member(value, name):
                return self._further(value, self.spelled(name))
            case ast.Index(value, index):
                return self._further(value, index_of(index) or f"[{self.key(index)!r}]")
        return None

    def _further(self, value: ast.Expression, component: str) -> tuple[Path, Path] | None:
        known = self.reference(value)
        if known is None:
            return None
        thing, rest = known
        is_turn = all(r.startswith("[") for r in rest)
        if is_turn and (path := (*thing, component)) in self.things:
            return path, rest
        return thing, (*rest, component)

    def key(self, node: ast.Node) -> Key:
        if isinstance(node, ast.Name | ast.Member | ast.Index) and (known := self.reference(node)):
            return ("ref", *known)
        match node:
            case ast.Number(value, unit):
                return ("number", round(value * (UNITS[unit][0] if unit in UNITS else 1.0), 9))
            case ast.Name(text):
                return ("loop", self.loops[text]) if text in self.loops else ("name", self.spelled(node))
            case ast.Member(value, name):
                return ("member", self.key(value), self.spelled(name))
            case ast.Unary("-", ast.Number() as operand):
                _, size = self.key(operand)
                assert isinstance(size, float)
                return ("number", -size)
            case ast.Call():
                return self._call(node)
            case ast.Comparison((left, right), (operator,)):
                return self.comparison(operator, left, right)
            case ast.Binary(operator, left, right):
                sides = [self.key(left), self.key(right)]
                return (operator, *(ordered(sides) if operator in "+*" else sides))
            case ast.Comprehension(element, variables, iterable, condition):
                inner = self.inside(variables)
                test = inner.key(condition) if condition is not None else ()
                return ("members" if node.is_joined else "list", self.key(iterable), inner.key(element), test)
            case ast.ForArguments(variables, iterable, body):
                return ("for", self.key(iterable), self.inside(variables).key(body))
        plain = [v for v in vars(node).values() if isinstance(v, str | bool | float)]
        return (type(node).__name__, *plain, *map(self.key, ast.children(node)))

    def inside(self, variables: Collection[ast.Identifier]) -> Reader:
        """Returns the reader for the body of a loop."""
        loops = dict(self.loops)
        loops.update((variable.text, len(self.loops) + i) for i, variable in enumerate(variables))
        return Reader(self.home, self.things, self.names, loops)

    def comparison(self, operator: str, left: ast.Expression, right: ast.Expression) -> Key:
        sides = [self.key(left), self.key(right)]
        if operator in _TURNED:
            return (_TURNED[operator], *reversed(sides))
        return (operator, *(ordered(sides) if operator in ("==", "!=") else sides))

    def _call(self, node: ast.Call) -> Key:
        positional = [self.key(a.value) for a in node.arguments if a.name is None]
        named = [(self.spelled(a.name), self.key(a.value)) for a in node.arguments if a.name is not None]
        if node.receiver is not None:
            positional.insert(0, self.key(node.receiver))
        name = self.spelled(node.callee)
        if name in _SYMMETRIC:
            positional = ordered(positional)
        return ("call", name, tuple(positional), tuple(sorted(named, key=repr)))


def ordered(keys: list[Key]) -> list[Key]:
    """Orders keys so that numbers decide last."""
    return sorted(keys, key=lambda key: (repr(shape(key)), repr(key)))


def _replaced(key: Key, replace: Callable[[Key], Key | None]) -> Key:
    """Returns a key with parts of it replaced, from the outside inwards."""
    other = replace(key)
    if other is not None:
        return other
    return tuple(_replaced(part, replace) if isinstance(part, tuple) else part for part in key)


def shape(key: Key) -> Key:
    """Returns a key without its numbers; what they are added to stays."""
    return _replaced(key, _without_numbers)


def _without_numbers(key: Key) -> Key | None:
    if key[:1] in (("+",), ("-",)) and len(key) == 3:
        rest = [part for part in key[1:] if isinstance(part, tuple) and not _is_number(part)]
        return shape(rest[0]) if len(rest) == 1 else None
    return ("number",) if _is_number(key) else None


def _is_number(key: Key) -> bool:
    return len(key) == 2 and key[0] == "number" and isinstance(key[1], float)


def translated(key: Key, paths: Mapping[Path, Path]) -> Key:
    """Returns a key with things at other paths."""

    def other(part: Key) -> Key | None:
        if part[:1] != ("ref",) or len(part) != 3:
            return None
        _, thing, rest = part
        return ("ref", paths.get(thing, thing), rest)  # type: ignore[call-overload]

    return _replaced(key, other)


def things_in(key: Key) -> Iterator[Path]:
    if key[:1] == ("ref",) and len(key) == 3:
        yield key[1]  # type: ignore[misc]
        return
    for part in key:
        if isinstance(part, tuple):
            yield from things_in(part)


def names_in(key: Key) -> frozenset[str]:
    """Returns the names of parameters and other values in a key."""
    if key[:1] == ("name",) and len(key) == 2 and isinstance(key[1], str):
        return frozenset([key[1]])
    return frozenset().union(*(names_in(part) for part in key if isinstance(part, tuple)))


# --- The intents of a program: its structures, geometry, constraints, rotations, asserts and parameters.


class Kind(StrEnum):
    STRUCTURE = "structure"
    GEOMETRY = "geometry"
    PARAM = "param"
    ROTATION = "rotation"
    OPERATION = "operation"
    CONSTRAINT = "constraint"
    ASSERT = "assert"


STATED = frozenset({Kind.CONSTRAINT, Kind.ROTATION, Kind.OPERATION, Kind.ASSERT})
"""Kinds that state something of things; the others are things, and parameters."""


@record(eq=False)
class Step:
    """A block between a structure's body and a statement in it: a loop, a branch, `constrain { }`.

    opening  what stands before its contents, and ends with the brace
    key      equal for blocks that are the same
    """

    block: ast.Block
    opening: str
    key: Key


@record(eq=False)
class Item:
    """Something a program means to have. Items compare by identity.

    home      the path of the structure, or the definition, that holds it
    node      what states it: of a condition the expression or equation, else the statement or the argument
    span      the statement
    text      the author's words, on one line
    steps     the blocks around it, from its structure inwards
    thing     the path of a structure or geometry itself; of an argument or placement that of its owner
    word      of a structure its kind or its template, of geometry what it is made by
    key       equal for items that mean the same
    wish      it is preferred, not asked for
    wrong     it carried an error
    may_go    a diagnostic offered to leave it out, as it says nothing new
    may_bend  a diagnostic offered to make it a wish
    clashes   it was one of those that could not hold together
    """

    kind: Kind
    home: Path
    node: ast.Node
    span: Span
    text: str
    steps: tuple[Step, ...]
    key: Key
    thing: Path = ()
    word: str = ""
    wish: bool = False
    wrong: bool = False
    may_go: bool = False
    may_bend: bool = False
    clashes: bool = False

    @cached_property
    def things(self) -> frozenset[Path]:
        return frozenset(things_in(self.key))

    @cached_property
    def shape(self) -> Key:
        return shape(self.key)

    @property
    def context(self) -> Key:
        """The loops and branches around it."""
        return tuple(step.key for step in self.steps if step.key != CONSTRAIN)


CONSTRAIN: Key = ("constrain",)


@record(eq=False)
class Inventory:
    """The intents of a program.

    diagnostics  the diagnostics with a place in the program
    things       the items of structures and geometry by path; of several with one path, the first
    bodies       the blocks of structures and definitions by path
    readers      the reader of the expressions in each structure
    knobs        names of params, and of values worked out from them
    counts       how many there are in the model by path without indices; empty if there is no model
    """

    resolution: Resolution
    diagnostics: tuple[Diagnostic, ...]
    items: tuple[Item, ...]
    things: dict[Path, Item]
    bodies: dict[Path, ast.Block]
    readers: dict[Path, Reader]
    knobs: frozenset[str]
    counts: Counter[Path]

    @property
    def source(self) -> SourceFile:
        return self.resolution.main.source

    def inside(self, path: Path) -> Iterator[Item]:
        """Yields the items in a structure, at any depth."""
        return (item for item in self.items if item.home[: len(path)] == path)


def unnumbered(path: Path) -> Path:
    return tuple(component for component in path if not component.startswith("["))
