"""The intents of a program, and the canonical keys by which statements of the same meaning are equal.

They are read off the syntax tree, so that a program with errors has an inventory as well: of what could be
read. What stands in a loop or a branch counts once.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import field, replace
from enum import StrEnum
from functools import cached_property

from aidl_lang.checking.symbols import Resolution, SymbolKind
from aidl_lang.checking.units import UNITS
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.geometry.solved import SolvedModel
from aidl_lang.syntax import ast
from aidl_lang.syntax.printer import ExpressionPrinter, format_expression

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

    def count(self, item: Item) -> int:
        """Returns how many of a thing the model has."""
        return self.counts[unnumbered(item.thing)]


def unnumbered(path: Path) -> Path:
    return tuple(component for component in path if not component.startswith("["))


# --- Takes the inventory of a program from its syntax tree, its diagnostics and its model.

_OPERATIONS = frozenset({"rotate", "move", "translate", "scale", "fillet", "chamfer"})
_WRONG = ("E01", "E02", "E03", "E04", "E05")
"""Errors that require another statement in place of the wrong one."""
_CONFLICT = "E0601"
_INDEX = re.compile(r"\[[^\]]*\]")


def inventory(
    resolution: Resolution, diagnostics: Sequence[Diagnostic] = (), model: SolvedModel | None = None
) -> Inventory:
    """Returns the intents of a program, with its `diagnostics` and its `model`."""
    taker = _Taker(resolution)
    for statement in resolution.main.statements:
        taker.statement(statement, _Place((), (), {}))
    items = (item for record in taker.records for item in taker.items_of(record))
    source = resolution.main.source
    here = [d for d in diagnostics if d.span is not None and d.span.source.text == source.text]
    spans = (span for d in here if d.code == _CONFLICT for span in (d.span, *(x.span for x in d.secondary)))
    clashing = [span for span in spans if span is not None and span.source.text == source.text]
    marked = tuple(_marked(item, here, clashing) for item in items)
    things: dict[Path, Item] = {}
    for item in marked:
        if item.kind in (Kind.STRUCTURE, Kind.GEOMETRY):
            things.setdefault(item.thing, item)
    readers = {path: taker.reader(_Place(path, (), {})) for path in taker.bodies}
    counts = _counts(model) if model is not None else Counter[Path]()
    return Inventory(resolution, tuple(here), marked, things, taker.bodies, readers, taker.knobs(), counts)


def _counts(model: SolvedModel) -> Counter[Path]:
    paths = (path for s in model.root.walk() for path in (s.path, *(g.path for g in s.geometry)))
    return Counter(tuple(_INDEX.sub("", path).split(".")) for path in paths)


def _marked(item: Item, diagnostics: Sequence[Diagnostic], clashing: Sequence[Span]) -> Item:
    """Returns an item with the diagnostics at its place, and with its part in conflicts (`clashing`)."""
    if item.kind in (Kind.STRUCTURE, Kind.GEOMETRY, Kind.PARAM):
        return item
    start, end, text = item.span.start, item.span.end, item.span.source.text
    near = [d for d in diagnostics if d.span is not None and d.span.start < end and start < d.span.end]
    wrong = any(d.code.startswith(_WRONG) for d in near)
    clashes = any(span.start < end and start < span.end for span in clashing)
    may_go = may_bend = False
    for edit in (e for d in diagnostics if d.code[1:3] == "06" and d.fix for e in d.fix.edits):
        at = edit.span
        may_go |= not edit.replacement and at.start <= start and end <= at.end
        is_before = at.end <= start and not text[at.end : start].strip()
        may_bend |= is_before and edit.replacement.strip() == "prefer"
    if not (wrong or may_go or may_bend or clashes):
        return item
    return replace(item, wrong=wrong, may_go=may_go, may_bend=may_bend, clashes=clashes)


@record()
class _Place:
    """The place of a statement; `loops` are the variables around it, and how deep each is."""

    home: Path
    steps: tuple[Step, ...]
    loops: Mapping[str, int]

    @property
    def is_condition(self) -> bool:
        return any(step.key == CONSTRAIN for step in self.steps)


class _Taker:
    """Goes through a file twice: first collects all things, then makes keys that refer to them."""

    def __init__(self, resolution: Resolution) -> None:
        self.uses, self.names = resolution.uses, resolution.canonical
        self.printer = ExpressionPrinter()
        self.paths: set[Path] = set()
        self.bodies: dict[Path, ast.Block] = {}
        self.records: list[tuple[ast.Statement, _Place]] = []

    def reader(self, place: _Place) -> Reader:
        return Reader(place.home, self.paths, self.names, place.loops)

    # --- First: what there is --------------------------------------------------------------------

    def statement(self, node: ast.Statement, place: _Place) -> None:
        match node:
            case ast.Structure():
                self.records.append((node, place))
                path = (*place.home, *own_path(node.name, node.indices))
                self.paths.add(path)
                self._body(node.body, _Place(path, (), place.loops))
            case ast.ConstraintDefinition() | ast.ShapeDefinition():
                step = Step(node.body, "constrain {", CONSTRAIN)
                steps = (step,) if isinstance(node, ast.ConstraintDefinition) else ()
                self._body(node.body, _Place((*place.home, node.name.text), steps, place.loops))
            case ast.For(variables, iterable, body):
                inner = self.reader(place).inside(variables)
                header = f"for {', '.join(v.text for v in variables)} in "
                header += self.printer.iterable(iterable).flat()
                self._block(body, place, f"{header} {{", ("for", self._raw(iterable)), inner.loops)
            case ast.If(test, then, otherwise):
                condition, key = f"if {format_expression(test)} {{", self._raw(test)
                self._block(then, place, condition, ("if", key), place.loops)
                if otherwise is not None:
                    self._block(otherwise, place, f"{condition} }} else {{", ("else", key), place.loops)
            case ast.Constrain(items):
                self._block(items, place, "constrain {", CONSTRAIN, place.loops)
            case _:
                if isinstance(node, ast.Assign) and not place.is_condition and self._kind(node):
                    self.paths.add((*place.home, *own_path(node.name, node.indices)))
                self.records.append((node, place))

    def _raw(self, node: ast.Expression) -> Key:
        """Returns the key of the head of a loop or branch, which contains numbers only."""
        return Reader((), (), self.names).key(node)

    def _body(self, body: ast.Block, place: _Place) -> None:
        self.bodies.setdefault(place.home, body)
        for statement in body.statements:
            self.statement(statement, place)

    def _block(
        self, block: ast.Block, place: _Place, opening: str, key: Key, loops: Mapping[str, int]
    ) -> None:
        inner = _Place(place.home, (*place.steps, Step(block, opening, key)), loops)
        for statement in block.statements:
            self.statement(statement, inner)

    def _kind(self, node: ast.Assign) -> Kind | None:
        """Returns the kind of thing that an assignment makes; None if it only names a value."""
        symbol = self.uses.get(node.name)
        if symbol is None:
            return Kind.GEOMETRY if isinstance(node.value, ast.Call | ast.Point) else None
        return {SymbolKind.STRUCTURE: Kind.STRUCTURE, SymbolKind.GEOMETRY: Kind.GEOMETRY}.get(symbol.kind)

    def knobs(self) -> frozenset[str]:
        """Returns the names of params, and of values computed from them."""
        found: set[str] = set()
        for node, place in self.records:
            match node:
                case ast.Param(name):
                    found.add(name.text)
                case ast.Let(name, value) if names_in(self.reader(place).key(value)) & found:
                    found.add(name.text)
        return frozenset(found)

    # --- Then: what it means ---------------------------------------------------------------------

    def items_of(self, record: tuple[ast.Statement, _Place]) -> Iterator[Item]:
        node, place = record
        match node:
            case ast.Structure(kind=kind):
                yield self._thing(node, place, Kind.STRUCTURE, kind)
                yield from self._rotated(node, place)
            case ast.Assign() if place.is_condition:
                target: ast.Expression = ast.Name(node.name.text, span=node.name.span)
                for index in node.indices:
                    target = ast.Index(target, index, span=node.name.span)
                equation = ast.Equation(target, node.value, span=node.span)
                yield from self._conditions(equation, node, place, wish=False)
            case ast.Assign():
                yield from self._assigned(node, place)
            case ast.Param(name, value):
                key = ("param", name.text, self.reader(place).key(value))
                yield self._item(Kind.PARAM, node, node.span, place, key, thing=(*place.home, name.text))
            case ast.ExpressionStatement(value):
                made = self.names.get(value.callee, value.callee.text) if isinstance(value, ast.Call) else ""
                if made in _OPERATIONS and not place.is_condition:
                    kind = Kind.ROTATION if made == "rotate" else Kind.OPERATION
                    yield self._item(kind, value, node.span, place, self.reader(place).key(value))
                else:
                    yield from self._conditions(value, node, place, wish=False)
            case ast.Equation():
                yield from self._conditions(node, node, place, wish=False)
            case ast.Prefer(value):
                yield from self._conditions(value, node, place, wish=True)
            case ast.Assert(test):
                yield self._item(Kind.ASSERT, node, node.span, place, self.reader(place).key(test))

    def _item(self, kind: Kind, node: ast.Node, span: Span, place: _Place, key: Key, **more: object) -> Item:
        text = str(more.pop("text", "")) or node.span.one_line
        return Item(kind, place.home, node, span, text, place.steps, key, **more)  # type: ignore[arg-type]

    def _thing(self, node: ast.Structure | ast.Assign, place: _Place, kind: Kind, word: str) -> Item:
        path = (*place.home, *own_path(node.name, node.indices))
        key: Key = (word,)
        if isinstance(node, ast.Assign):
            key = self.reader(place).key(node.value)
        text = node.span.one_line if kind is Kind.GEOMETRY else node.name.text
        return self._item(kind, node, node.span, place, key, thing=path, word=word, text=text)

    def _assigned(self, node: ast.Assign, place: _Place) -> Iterator[Item]:
        kind, value = self._kind(node), node.value
        if kind is None:
            return
        word = self.names.get(value.callee, value.callee.text) if isinstance(value, ast.Call) else ""
        yield self._thing(node, place, kind, word)
        yield from self._rotated(node, place)
        for argument in value.arguments if isinstance(value, ast.Call) and kind is Kind.GEOMETRY else ():
            name = self.names.get(argument.name, argument.name.text) if argument.name else ""
            turns = name == "angle" and not _is_level(argument.value)
            turns |= name == "rotatable" and isinstance(argument.value, ast.Boolean) and argument.value.value
            if turns:
                yield self._turn(name, argument, place, node)

    def _rotated(self, node: ast.Structure | ast.Assign, place: _Place) -> Iterator[Item]:
        placement = node.placement
        if placement is not None and placement.rotated is not None and not _is_level(placement.rotated):
            yield self._turn("rotated", placement, place, node)

    def _turn(
        self, word: str, node: ast.Placement | ast.Argument, place: _Place, owner: ast.Structure | ast.Assign
    ) -> Item:
        angle, between = (node.value, ": ") if isinstance(node, ast.Argument) else (node.rotated, " ")
        assert angle is not None
        span = node.span if isinstance(node, ast.Argument) else angle.span
        path = (*place.home, *own_path(owner.name, owner.indices))
        said = f"{word}{between}{angle.span.one_line}"
        key = (word, ("ref", path, ()), self.reader(place).key(angle))
        return self._item(Kind.ROTATION, node, span, place, key, thing=path, word=word, text=said)

    def _conditions(
        self, node: ast.Expression | ast.Equation, statement: ast.Statement, place: _Place, wish: bool
    ) -> Iterator[Item]:
        """Yields an item for each part of a chain or of an `and`; a wish has one weight and stays whole."""
        reader = self.reader(place)
        for part in [node] if wish else _parts(node):
            if isinstance(part, ast.Equation):
                key = reader.comparison("==", part.left, part.right)
            else:
                key = reader.key(part)
            text = part.span.one_line if part is node else format_expression(part)  # type: ignore[arg-type]
            kind = Kind.ROTATION if _turns(key) else Kind.CONSTRAINT
            yield self._item(kind, part, statement.span, place, key, text=text, wish=wish)


def _parts(node: ast.Expression | ast.Equation) -> Iterator[ast.Expression | ast.Equation]:
    match node:
        case ast.Binary("and", left, right):
            yield from _parts(left)
            yield from _parts(right)
        case ast.Comparison(operands, operators) if len(operators) > 1:
            for operator, left, right in zip(operators, operands, operands[1:], strict=False):
                yield ast.Comparison((left, right), (operator,), span=node.span)
        case _:
            yield node


def _is_level(angle: ast.Expression) -> bool:
    return isinstance(angle, ast.Number) and angle.value == 0


def _turns(key: Key) -> bool:
    """True for a condition on an angle: `angle(a, b, 30deg)`, `hand.angle == 30deg`."""
    if key[:2] == ("call", "angle"):
        return True
    sides = [part for part in key if isinstance(part, tuple)]
    return key[:1] == ("==",) and any(
        s[:2] == ("call", "angle") or (s[:1] == ("ref",) and s[2][-1:] == ("angle",)) for s in sides
    )
