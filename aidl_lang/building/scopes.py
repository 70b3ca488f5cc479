"""The scopes in which names are found while a program is built: a chain, each with values and callables
apart.

A value that other code may read in its own frame, or before its line was reached, is kept as a binding and
evaluated when it is read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import field
from typing import TYPE_CHECKING, TypeAlias

from aidl_lang.building.expression import Unknown
from aidl_lang.building.model import Geometry, Structure
from aidl_lang.checking.types import Signature
from aidl_lang.common.records import record
from aidl_lang.syntax import ast

if TYPE_CHECKING:
    from aidl_lang.building.values import Value


def indexed(name: str, indices: Sequence[int]) -> str:
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
    binding: Binding
    source: Geometry
    carry: Callable[[str, Value, Structure], Value]


Binding: TypeAlias = "Value | LetBinding | ParamBinding | VarBinding | PassedBinding | CopiedBinding"


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
    values: dict[str, Binding] = field(default_factory=dict)
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
