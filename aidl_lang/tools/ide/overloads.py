"""Matches the overloads of a call with its arguments so far, and finds the meant one."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.checking.calls import arguments
from aidl_lang.checking.resolving.symbols import SymbolScope
from aidl_lang.checking.synonyms import PAIRS, PARAMETERS
from aidl_lang.checking.types import ListType, NumberType, PointType, Signature, Type, accepts
from aidl_lang.common.names import fold
from aidl_lang.common.records import record
from aidl_lang.syntax import ast
from aidl_lang.typecheck import Program

_WRONG = 100
"""Cost of an argument that does not fit, against the conversions of those that do."""
_GATHERED = 1


@record()
class Reading:
    """An overload with the arguments of a call.

    taken  the parameter of each argument, the receiver first; None without one
    cost   distance of the arguments from the overload's types
    """

    signature: Signature
    taken: tuple[str | None, ...]
    cost: int

    @property
    def fits(self) -> bool:
        """True if no argument so far contradicts it."""
        return self.cost < _WRONG

    def type_of(self, parameter: str) -> Type | None:
        return next((kind for name, kind, _ in self.signature.parameters if name == parameter), None)

    @property
    def open(self) -> list[tuple[str, Type, bool]]:
        """The parameters without an argument yet."""
        return [p for p in self.signature.parameters if p[0] not in self.taken]


def readings(program: Program, scope: SymbolScope, call: ast.Call) -> list[Reading]:
    """Returns the readings of a call: those that fit, the nearest first; else all as they are defined."""
    candidates = program.resolution.candidates.get(call)
    if candidates is None:
        found = scope.called(call.callee.text)
        candidates = tuple(found[1]) if found is not None else ()
    nodes = arguments(program.inference, call)
    kinds = [program.inference.fact(node).type for node in nodes]
    words: list[str | None] = [None] * (len(nodes) - len(call.arguments))
    words += [a.name.text if a.name is not None else None for a in call.arguments]
    own = [c for c in candidates if not c.standard]
    found_all = [_read(candidate, words, kinds) for candidate in (own or candidates)]
    return sorted(found_all, key=lambda reading: reading.cost)


def _read(signature: Signature, words: Sequence[str | None], kinds: Sequence[Type]) -> Reading:
    positional = iter(_positional(signature, words, kinds))
    named = {signature.by_fold[fold(word)] for word in words if word and fold(word) in signature.by_fold}
    taken: list[str | None] = []
    cost = 0
    for word, kind in zip(words, kinds, strict=True):
        name = (
            next(positional, None) if word is None else meant(signature, word, {*named, *filter(None, taken)})
        )
        taken.append(name)
        if name is None and word is not None and (signature.takes_any or fold(word) in PAIRS):
            continue
        wanted = next((k for n, k, _ in signature.parameters if n == name), None)
        gathered = word is None and _gathers(signature, words, kinds)
        distance = _GATHERED if gathered else accepts(wanted, kind) if wanted is not None else None
        cost += _WRONG if distance is None else distance
    return Reading(signature, tuple(taken), cost)


def meant(signature: Signature, word: str, taken: set[str]) -> str | None:
    """Returns the parameter of a named argument, by its name or as the only one it can mean."""
    if (name := signature.by_fold.get(fold(word))) is not None:
        return name
    names = (signature.by_fold.get(fold(m)) for m in PARAMETERS.get(fold(word), ()))
    open_names = [name for name in names if name is not None and name not in taken]
    return open_names[0] if len(open_names) == 1 else None


def _positional(signature: Signature, words: Sequence[str | None], kinds: Sequence[Type]) -> list[str]:
    """Returns the parameters of the arguments without a name, in order; those behind a named one fill what is
    left.
    """
    named = {meant(signature, word, set()) for word in words if word is not None}
    are_late = words[:1] != [None] and named != {None}
    names = [name for name, _, _ in signature.parameters if not (are_late and name in named)]
    count = sum(word is None for word in words)
    if _gathers(signature, words, kinds):
        return names[:1] * count
    first = next((kind for word, kind in zip(words, kinds, strict=True) if word is None), None)
    if signature.parameters and isinstance(first, NumberType):
        _, kind, is_optional = signature.parameters[0]
        if is_optional and isinstance(kind, PointType):  # `circle(5)`: sizes in order, without the centre
            names = names[1:]
    return names[:count]


def _gathers(signature: Signature, words: Sequence[str | None], kinds: Sequence[Type]) -> bool:
    """True if the arguments without a name are the members of the list that comes first."""
    first = [kind for word, kind in zip(words, kinds, strict=True) if word is None][:2]
    return signature.gathers and not (len(first) == 1 and isinstance(first[0], ListType))
