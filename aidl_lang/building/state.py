"""The state of one run of a program, the scopes in which it finds names, and the reach of its expressions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, NoReturn, TypeAlias

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Unknown
from aidl_lang.building.model import (
    Assertion,
    Comparison,
    Constraint,
    Geometry,
    Holder,
    Knob,
    Literal,
    Structure,
)
from aidl_lang.building.values import (
    NOTHING,
    Exactness,
    ListVal,
    Nothing,
    Num,
    PointVal,
    RecordVal,
    TextVal,
    Value,
    point,
)
from aidl_lang.checking.rules import TypeMisfit
from aidl_lang.checking.types import Binding, Signature
from aidl_lang.checking.units import ANGLE, LENGTH, MaybeDimension
from aidl_lang.common.diagnostics import MOST_ERRORS, Diagnostic, Fix, Label
from aidl_lang.common.records import record
from aidl_lang.common.running import OutOfTime, checkpoint
from aidl_lang.common.source import Span
from aidl_lang.syntax import ast
from aidl_lang.typecheck import Program

if TYPE_CHECKING:
    from aidl_lang.building.attributes import Stated
    from aidl_lang.building.calls import CallSite
    from aidl_lang.building.copies import Copier
    from aidl_lang.common.lettering import Font


# --- The scopes in which names are found while a program is built: a chain, each with values and callables
# apart.
#
# A value that other code may read in its own frame, or before its line was reached, is kept as a binding and
# evaluated when it is read.


Indices: TypeAlias = tuple[int, ...]


def indexed(name: str, indices: Indices) -> str:
    """Returns the name of a member of an array: `dot[3]`."""
    return name + "".join([f"[{i}]" for i in indices]) if indices else name


@record(frozen=False, eq=False)
class LetBinding:
    """A name for an expression, evaluated where it is used.

    known  the value, if it is the same everywhere
    seen   the values for one frame and reach each
    """

    node: ast.Expression
    scope: Scope
    known: Value | None = None
    seen: dict[object, Value] = field(default_factory=dict)
    running: bool = False


@record(frozen=False, eq=False)
class ParamBinding:
    """A knob, evaluated once with the value set from outside."""

    node: ast.Param
    scope: Scope
    structure: Structure
    known: Value | None = None
    running: bool = False


@record(frozen=False, eq=False)
class VarBinding:
    """An unknown declared with `var`."""

    value: Value
    unknown: Unknown


@record(frozen=False, eq=False)
class PassedBinding:
    """An argument of a template: a number with its status, or a reference that each structure using it gets
    as an unknown of its own, tied by an equality in `holder`.
    """

    name: str
    value: Value
    instance: Structure
    holder: Structure
    node: ast.Node
    tied: dict[Structure, Value] = field(default_factory=dict)


@record(frozen=False, eq=False)
class CopiedBinding:
    """A name in a copied shape: its value in the source, as `carry` moves it."""

    name: str
    binding: NameBinding
    source: Geometry
    carry: Callable[[str, Value, Structure], Value]


CallEdit: TypeAlias = "Callable[[Binding, dict[str, Value]], dict[str, Value]]"
NameBinding: TypeAlias = "Value | LetBinding | ParamBinding | VarBinding | PassedBinding | CopiedBinding"


@record(eq=False)
class Candidate:
    """A callable and the scope its body sees; `scope` is None for a built-in one."""

    signature: Signature
    scope: Scope | None


@record(frozen=False, eq=False)
class Scope:
    """The names of one body while it is run.

    container  the structure or compound shape whose members its declarations become, or None
    turn       one turn of a `for`: its lets are its own, its other declarations go to the container
    labels     loop variables of the turns around, for messages
    unbuilt    names that an `if` did not build, and that `if`
    """

    parent: Scope | None
    container: Structure | Geometry | None = None
    turn: bool = False
    labels: tuple[str, ...] = ()
    values: dict[str, NameBinding] = field(default_factory=dict)
    callables: dict[str, list[Candidate]] = field(default_factory=dict)
    aliases: dict[str, str] = field(default_factory=dict)
    unbuilt: dict[str, ast.If] = field(default_factory=dict)
    supply: Callable[[str], Iterable[Candidate]] | None = None
    """looks up callables that are kept elsewhere (the library's)"""
    _candidates: dict[str, list[Candidate]] = field(default_factory=dict, repr=False)

    def chain(self) -> Iterable[Scope]:
        scope: Scope | None = self
        while scope is not None:
            yield scope
            scope = scope.parent

    def find(self, name: str) -> Scope | None:
        """Returns the nearest scope that has a value of this name."""
        scope: Scope | None = self
        while scope is not None and name not in scope.values:
            scope = scope.parent
        return scope

    def declaring(self) -> Scope:
        """Returns the scope whose container gets the declarations made here."""
        scope = self
        while scope.turn and scope.parent is not None:
            scope = scope.parent
        return scope

    def define(self, candidate: Candidate) -> None:
        """Makes a callable known in this scope, before any scope inside has been searched."""
        of_name = self.callables.setdefault(candidate.signature.name, [])
        if all(candidate.signature is not known.signature for known in of_name):
            of_name.append(candidate)
            self._candidates.clear()

    def candidates(self, name: str) -> list[Candidate]:
        """Returns all callables of a name, innermost first; aliases followed. The same list each time."""
        scope = self
        while scope.parent is not None and not (scope.callables or scope.aliases):
            scope = scope.parent
        if (known := scope._candidates.get(name)) is None:
            known = scope._candidates[name] = scope._found(name)
        return known

    def _found(self, name: str) -> list[Candidate]:
        found: list[Candidate] = []
        seen: list[str] = []
        key: str | None = name
        while key is not None and key not in seen:
            seen.append(key)
            alias: str | None = None
            for scope in self.chain():
                found += scope.callables.get(key, ())
                if scope.supply is not None:
                    found += scope.supply(key)
                alias = alias or scope.aliases.get(key)
            key = alias
        return found


_LARGEST_GUESS = 1e12
"""Beyond this nothing is drawn (see `geometry.evaluate.LARGEST`), and the solver has no digits left."""


class Reach(Enum):
    """The unknowns that an expression may read (language reference: validity)."""

    OWN = "geometry: unknowns of its own structure"
    ABOVE = "what geometry is derived of: anything further up, since the solver does not move it"
    SUBTREE = "constraints: unknowns of the holder's subtree"
    READ = "asserts: anything, since they steer nothing"


@record(slots=True)
class Env:
    """The environment of an expression: the names it sees, and the structure in whose frame it is read."""

    scope: Scope
    here: Structure
    reach: Reach = Reach.OWN

    @property
    def holder(self) -> Holder:
        """The structure or shape whose members are declared here."""
        return self.scope.declaring().container or self.here

    def within(self, scope: Scope) -> Env:
        return Env(scope, self.here, self.reach)

    def reaching(self, reach: Reach) -> Env:
        return Env(self.scope, self.here, reach)


@record()
class BuildingLimits:
    """Bounds on what a program may build; exceeding one is a diagnostic."""

    entities: int = 120_000
    turns: int = 200_000
    depth: int = 60
    constraints: int = 50_000
    items: int = 100_000
    seconds: float = 20.0


DEFAULT_LIMITS = BuildingLimits()


class Stop(Exception):  # noqa: N818 (not an error of ours: the program went over a limit, which is reported)
    """Raised to end building; the model so far is the result."""


Executor = Callable[..., None]
"""A function that carries out a statement: (interpreter, statement, environment)."""


@record(frozen=False)
class Ahead:
    """A body that is being run; `next` is the statement after the one that is run now."""

    statements: Sequence[ast.Statement]
    env: Env
    next: int = 0


@record(frozen=False)
class Interpreter:
    """The state of one run."""

    program: Program
    overrides: Mapping[str, str | float | bool]
    limits: BuildingLimits
    executors: Mapping[type, Executor]
    evaluator: Callable[[Interpreter, ast.Expression, Env], Value]
    caller: Callable[[Interpreter, ast.Call, Env], Value]
    diagnostics: list[Diagnostic] = field(default_factory=list)
    unknowns: list[Unknown] = field(default_factory=list)
    following: list[Geometry] = field(default_factory=list)
    """geometry derived of geometry outside of its structure"""
    constraints: list[Constraint] = field(default_factory=list)
    by_hand: list[Constraint] = field(default_factory=list)
    assertions: list[Assertion] = field(default_factory=list)
    knobs: list[Knob] = field(default_factory=list)
    readings: list[tuple[Span, str]] = field(default_factory=list)
    turned: Mapping[int, int] = field(default_factory=dict)
    """for readings, by number, how many places from the nearest to what is written they are to be taken"""
    states_constants: bool = False
    """conditions over constants become constraints of the model like others, and those of asserts too"""
    literals: list[Literal] = field(default_factory=list)
    pending: dict[Structure, list[tuple[ast.Statement, Env]]] = field(default_factory=dict)
    orders: dict[Structure, list[Stated]] = field(default_factory=dict)
    """what is said of the order of structures beside others"""
    clips: dict[Structure, Stated] = field(default_factory=dict)
    """what is said of the outlines that structures are clipped to"""
    written: dict[ast.Node, tuple[float, float] | float] = field(default_factory=dict)
    """the written values of expressions that break a rule of validity, for their fixes"""
    watched: frozenset[ast.Node] = frozenset()
    used_overrides: set[str] = field(default_factory=set)
    call_sites: list[ast.Node] = field(default_factory=list)
    hidden: list[tuple[Geometry, tuple[Comparison, ...]]] = field(default_factory=list)
    runaway: set[ast.Node] = field(default_factory=set)
    copiers: list[Copier] = field(default_factory=list)  # the makers of the copies, in order
    ahead: list[Ahead] = field(default_factory=list)
    edits: dict[ast.Call, CallEdit] = field(default_factory=dict)
    """calls that are run with their arguments changed"""
    edited: set[tuple[ast.Call, tuple[str, ...]]] = field(default_factory=set)
    """edits that were applied, and in which turns of the loops around"""
    edited_names: dict[int, frozenset[str]] = field(default_factory=dict)
    signatures: dict[ast.Callable, Signature] = field(default_factory=dict)
    """signatures of definitions in bodies"""
    sites: dict[ast.Call, tuple[Sequence[Candidate], CallSite]] = field(default_factory=dict)
    """the overloads of a call's name when it was last met, and the site that follows from these and its
    text"""
    numbers: dict[ast.Number, Num] = field(default_factory=dict)
    """numbers of the text, which are the same each time they are met"""
    fonts: dict[str, Font] = field(default_factory=dict)  # font files by path, as texts name them
    frames_turn: bool = False
    """the program mentions the rotation of structures, which a constraint on it frees"""
    root: Structure | None = None
    errors: int = 0
    entities: int = 0
    turns: int = 0
    runs: int = 0  # of statements that finish corners

    # --- Reporting -----------------------------------------------------------------------------

    def place(self, node: ast.Node | Span | None) -> Span | None:
        """Returns the place of a node in the author's text: in library code, the call that led there."""
        span = node.span if isinstance(node, ast.Node) else node
        if span is not None and span.source in self.library_sources:
            return next((s.span for s in self.call_sites if s.span.source not in self.library_sources), span)
        return span

    def said(self, node: ast.Node, env: Env) -> tuple[str, Span, str]:
        """Returns the text of a statement, its place for the author, and the turn of the loops around."""
        return node.span.one_line, self.place(node) or node.span, ", ".join(env.scope.labels)

    def report(
        self,
        code: str,
        message: str,
        node: ast.Node | Span | None,
        label: str = "",
        hints: Sequence[str] = (),
        fix: Fix | None = None,
        secondary: Sequence[Label] = (),
        *,
        once: bool = False,
    ) -> Nothing:
        """Reports what is found at a node; `once`: not again of the same place, as a loop would. Returns the
        value of what is wrong. Ends building if there are more errors than are reported.
        """
        span = self.place(node)
        written = node.span if isinstance(node, ast.Node) else node
        if span is not None and written is not None and span.source is not written.source:
            inner = message if code in ("E0525", "E0604") else f"in the library, {message}"
            message = f"`{span.one_line}` does not work out: {inner}"
            once = True
        if once and any(d.code == code and d.span == span for d in self.diagnostics):
            return NOTHING
        found = Diagnostic(code, message, span, label, tuple(secondary), tuple(hints), fix)
        self.diagnostics.append(found)
        self.errors += found.is_error
        if self.errors > MOST_ERRORS:
            raise Stop
        return NOTHING

    def misfit(self, found: TypeMisfit, node: ast.Node, fix: Fix | None = None) -> Nothing:
        """Reports a value that does not fit its place."""
        return self.report(found.code, found.message, node, found.label, found.hints, fix)

    def refuse(self, node: ast.Node, why: str, hints: Sequence[str] = ()) -> Nothing:
        """Reports that a call makes no sense of its arguments, at the call that the author wrote."""
        span = self.place(node)
        text = f"`{span.one_line}`" if span is not None else "this"
        return self.report("E0342", f"{text} says nothing: {why}", span, hints=hints, once=True)

    def spelled(self, node: ast.Name | ast.Identifier) -> str:
        """Returns the name as it is defined."""
        return self.program.resolution.canonical.get(node, node.text)

    @cached_property
    def library_sources(self) -> tuple[object, ...]:
        return self.program.resolution.standard_sources

    def evaluate(self, node: ast.Expression, env: Env) -> Value:
        """Returns the value of an expression, for modules that `evaluate` imports."""
        return self.evaluator(self, node, env)

    # --- Limits --------------------------------------------------------------------------------

    def count_entity(self, node: ast.Node | Span | None, count: int = 1) -> None:
        self.entities += count
        if self.entities > self.limits.entities:
            most = self.limits.entities
            self._stop(node, f"this program builds more than {most} structures and geometries")

    def check_time(self, node: ast.Node) -> None:
        """Ends building if it takes too long; called wherever a program may go on for long."""
        try:
            checkpoint()
        except OutOfTime:
            self._stop(node, f"building this program takes more than {self.limits.seconds:g} seconds")

    def count_turn(self, node: ast.Node) -> None:
        self.check_time(node)
        self.turns += 1
        if self.turns > self.limits.turns:
            self._stop(node, f"the loops of this program take more than {self.limits.turns} turns")

    def check_extent(self, node: ast.Node, value: Value) -> None:
        """Stops at a list, record or text that is too large to be looked through again and again."""
        most = self.limits.items
        if isinstance(value, TextVal):
            if len(value.value) > most:
                self._stop(node, f"this text has {len(value.value)} characters; at most {most} are allowed")
        elif isinstance(value, ListVal | RecordVal):
            if value.weight > most:
                kind = "list" if isinstance(value, ListVal) else "record"
                self._stop(node, f"this {kind} holds more than {most} values, with those inside its members")
            if value.depth > self.limits.depth:
                self._stop(node, f"lists are nested more than {self.limits.depth} deep here")

    def add_constraint(self, constraint: Constraint) -> None:
        self.constraints.append(constraint)
        if len(self.constraints) > self.limits.constraints:
            self._stop(None, f"this program states more than {self.limits.constraints} constraints")

    def enter(self, node: ast.Node, definition: ast.Node | None) -> bool:
        """Tells whether a call may be entered; `leave` ends it. What ran too deep is refused from then on."""
        self.check_time(node)
        if definition in self.runaway:
            return False
        if len(self.call_sites) >= self.limits.depth:
            hint = "a definition that calls itself has to end: let an `if … then … else` choose when"
            self.report("E0806", f"calls are nested more than {self.limits.depth} deep", node, hints=[hint])
            if definition is not None:
                self.runaway.add(definition)
            return False
        self.call_sites.append(node)
        return True

    def leave(self) -> None:
        self.call_sites.pop()

    def _stop(self, node: ast.Node | Span | None, message: str) -> None:
        hint = "check the ends of ranges and the end of recursion; the limit is a setting of the API"
        self.report("E0805", message, node, hints=[hint])
        raise Stop

    def too_deep(self, node: ast.Node) -> NoReturn:
        """Reports a value that depends on so many others that the stack is full, and ends building."""
        hint = "values that are worked out from each other one by one are made by a loop, or by `sum`"
        message = "what this says hangs on too many other values, one by way of the next"
        self.report("E0806", message, node, hints=[hint])
        raise Stop

    # --- Unknowns ------------------------------------------------------------------------------

    def unknown(
        self,
        guess: float,
        holder: Holder,
        name: str,
        *,
        owner: Structure | None = None,
        dimension: MaybeDimension = None,
        kept: bool = False,
        frame_of: Structure | None = None,
        cell: bool = False,
        locked: bool = False,
        outline: bool = False,
        since: str = "",
    ) -> ex.Expression:
        """Returns a new unknown as an expression; the structure of its holder owns it if no other does."""
        owner = owner or (holder.owner if isinstance(holder, Geometry) else holder)
        if abs(guess) > _LARGEST_GUESS:
            message = f"`{name}` begins at {guess:g} here, which no drawing reaches"
            hint = f"lengths reach to {_LARGEST_GUESS:g} mm in either direction"
            self.report("E0504", message, holder.span, hints=[hint])
            guess = 0.0
        new = Unknown(guess, owner, holder, name, kept, dimension == ANGLE, frame_of, cell, exact=locked)
        new.locked, new.outline, new.since, new.implied = locked, outline, since, since != ""
        self.unknowns.append(new)
        return ex.unknown(new)

    def became(
        self, written: Num, made: ex.Expression, holder: Holder, name: str, dimension: MaybeDimension = LENGTH
    ) -> ex.Expression:
        """Notes that `made` stands for a number of the text, if `written` is one. Returns `made`."""
        if written.expression.op == "constant" and made.op != "constant":
            node = written.expression.payload
            if isinstance(node, (ast.Number, ast.Unary)):
                self.literals.append(Literal(node, made, holder, name, dimension))
        return made

    def became_point(self, written: PointVal, made: PointVal, holder: Holder, name: str) -> None:
        """Notes the same for both coordinates of a point."""
        if written.x.expression.op == "constant":
            self.became(written.x, made.x.expression, holder, f"{name}.x")
        if written.y.expression.op == "constant":
            self.became(written.y, made.y.expression, holder, f"{name}.y")


Arguments = Mapping[str, Value]
Function = Callable[[Interpreter, Arguments, ast.Call, Env], Value]
"""A function that is built in: (interpreter, arguments by parameter, call, environment)."""


def own_names(scope: Scope, structure: Structure) -> None:
    """Adds `self`, `origin` and the axes, which every structure has."""
    exact = [point(ex.constant(x), ex.constant(y), Exactness.FIXED) for x, y in ((0, 0), (1, 0), (0, 1))]
    scope.values["self"] = structure
    scope.values["origin"] = exact[0]
    for name, end in zip(("x_axis", "y_axis"), exact[1:], strict=True):
        axis = Geometry("line", structure, structure.span, {"start": exact[0], "end": end})
        axis.name, axis.container, axis.construction = name, structure, True
        scope.values[name] = axis
