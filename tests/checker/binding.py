"""The arguments of a call for the parameters of a definition: overloads by type, other words for names."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from aidl_lang.checking.binding import COORDINATES, PAIRS, PARAMETERS
from aidl_lang.syntax import ast
from tests.checker.tree import Array, Geo, Node
from tests.checker.values import Boxed, MistakeError, Num, Point, Scope, UnavailableError, fold

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator

_PRIMITIVES = ("line", "circle", "arc", "ellipse", "bezier")
_GATHERED = 10


def respelled(
    known: Sequence[str],
    named: dict[str, Any],
    taken: Iterable[str] = (),
    value_of: Callable[[Any], Any] = lambda value: value,
) -> dict[str, Any]:
    """Named arguments by the names of the parameters they can only mean; other words stay as they are."""
    by_fold = {fold(p): p for p in known}
    found = {by_fold.get(fold(n), n): v for n, v in named.items()}
    used = {*taken, *found}
    for pair, parts in PAIRS.items():
        if pair in found and pair not in by_fold and set(parts) <= set(known):
            halves = _halves(value_of(found[pair]))
            if halves is not None:
                del found[pair]
                found |= dict(zip(parts, halves, strict=True))
    for x, y, meanings in COORDINATES:
        words = {fold(n): n for n in found if fold(n) not in by_fold}
        target = next((m for m in meanings if m in by_fold), None)
        if target is not None and x in words and y in words:
            found[by_fold[target]] = [value_of(found.pop(words[w])) for w in (x, y)]
    for word in [n for n in found if fold(n) not in by_fold]:
        meant = [by_fold[fold(m)] for m in PARAMETERS.get(fold(word), ()) if fold(m) in by_fold]
        free = [m for m in meant if m not in used]
        if len(free) == 1:
            found[free[0]] = found.pop(word)
            used.add(free[0])
    return found


def _halves(value: Any) -> tuple[Any, Any] | None:
    """The two numbers of a pair."""
    if isinstance(value, Point):
        return value.x, value.y
    return (value[0], value[1]) if isinstance(value, list) and len(value) == 2 else None


def bound(
    definition: Any, positional: Sequence[Any], named: dict[str, Any], value_of: Callable[[Any], Any]
) -> tuple[dict[str, Any], int] | None:
    """The arguments by parameter, with how far they are from what is wanted; None when they do not fit.

    `value_of` gives the value of an argument, which may be an expression that waits.
    """
    names = [p.name.text for p in definition.parameters]
    gathers = bool(names) and _kind(definition.parameters[0]) in ("list", "points")
    for gather in (False, True) if gathers and positional else (False,):
        if gather:
            given = {names[0]: list(map(value_of, positional))}
        elif len(positional) <= len(names):
            given = dict(zip(names, positional, strict=False))
        else:
            continue
        words = respelled(names, named, given, value_of)
        if not set(words) <= set(names) or set(words) & set(given):
            continue
        given |= words
        steps = [_step(p, given, value_of) for p in definition.parameters]
        if all(s is not None for s in steps):
            return given, sum(s for s in steps if s is not None) + gather * _GATHERED
    return None


def _step(parameter: ast.Parameter, given: dict[str, Any], value_of: Callable[[Any], Any]) -> int | None:
    """How far an argument is from what its parameter wants; a default is as far as nothing."""
    if parameter.name.text not in given:
        return None if parameter.default is None else 0
    kind = _kind(parameter)
    try:
        return 4 if kind is None else fits(kind, value_of(given[parameter.name.text]))
    except UnavailableError:
        return 4


def _kind(parameter: ast.Parameter) -> str | None:
    return None if parameter.type is None else fold(parameter.type.text)


def fits(kind: str, value: Any) -> int | None:
    """0 for a value of the very type, more for one that is converted, None for one that is not."""
    match kind:
        case "angle" | "turn":
            return (0 if value.is_angle else 1) if isinstance(value, Num) else None
        case "length" | "number" | "area" | "integer":
            return _number(value, is_whole=kind == "integer")
        case "text" | "string":
            return 0 if isinstance(value, str) else None
        case "bool" | "boolean":
            return 0 if isinstance(value, bool) else None
        case "point":
            return _point(value)
        case "list" | "points":
            return 0 if isinstance(value, list | Array) else None
        case "record":
            return 0 if isinstance(value, dict) else None
        case "structure":
            return 0 if isinstance(value, Node) else None
        case "geometry":
            return 1 if isinstance(value, Geo | Point) else None
        case "box":
            return _box(value)
        case _:
            return 0 if isinstance(value, Geo) and fold(value.type) == kind else None


def _number(value: Any, is_whole: bool) -> int | None:
    """An edge stands for its coordinate."""
    if isinstance(value, Geo) and value.type == "line" and not is_whole:
        return 2
    if not isinstance(value, Num) or value.is_angle:
        return None
    return None if is_whole and value.value != round(value.value) else 0


def _point(value: Any) -> int | None:
    if isinstance(value, list):
        return 2 if len(value) == 2 and all(isinstance(v, Num) for v in value) else None
    return 0 if isinstance(value, Point) or (isinstance(value, Geo) and value.type == "point") else None


def _box(value: Any) -> int | None:
    if isinstance(value, list):
        return None if any(isinstance(v, Num | str | bool) for v in value) else 2
    if isinstance(value, Boxed):
        return 0
    return 2 if isinstance(value, Array) else 1 if isinstance(value, Node | Geo | Point) else None


def chosen(
    candidates: Sequence[tuple[Any, Scope]],
    positional: Sequence[Any],
    named: dict[str, Any],
    value_of: Callable[[Any], Any],
) -> tuple[Any, Scope] | None:
    """The definition that fits best, the first of equals, and the scope of a call of it."""
    fitting = []
    for order, (definition, home) in enumerate(candidates):
        found = bound(definition, positional, named, value_of)
        if found is not None:
            given, distance = found
            defaults = len(definition.parameters) - len(given)
            fitting.append((home.is_library, distance, defaults, order, definition, Scope(home, given)))
    return min(fitting, key=lambda f: f[:4])[4:] if fitting else None


def with_defaults(ev: Evaluator, definition: Any, inner: Scope) -> Scope:
    """What was not given, evaluated in the scope of the call."""
    for parameter in definition.parameters:
        if parameter.name.text not in inner.names:
            if parameter.default is None:
                raise MistakeError(f"{definition.name.text} needs {parameter.name.text}")
            inner.names[parameter.name.text] = ev.value(parameter.default, inner)
    return inner
