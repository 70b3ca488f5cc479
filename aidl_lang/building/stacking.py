"""The stated order of drawing: `@behind` and `@in_front`, read when all structures side by side are there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from aidl_lang.building.evaluate import evaluate
from aidl_lang.building.model import Structure
from aidl_lang.building.scopes import Scope
from aidl_lang.building.state import Env, Interpreter, Reach
from aidl_lang.building.values import Nothing, TextVal, each_of
from aidl_lang.checking.builtins import BEHIND, IN_FRONT, STACKING
from aidl_lang.common.diagnostics import Label
from aidl_lang.common.prose import listed
from aidl_lang.common.records import record
from aidl_lang.syntax import ast


@record()
class StatedOrder:
    """An attribute of order, its name, and the scope in which it is read."""

    name: str
    attribute: ast.Attribute
    scope: Scope


def state_order(it: Interpreter, s: Structure, stated: StatedOrder) -> None:
    """Keeps what is said of the order of a structure until all beside it are there."""
    if s.parent is None:
        message = f"`{s.name}` is the whole drawing: nothing is beside it"
        hint = f"`{stated.attribute.span.one_line}` stands before a structure in `{s.name}`"
        it.report("E0521", message, stated.attribute, hints=[hint])
    else:
        it.orders.setdefault(s, []).append(stated)


def settle_order(it: Interpreter, parent: Structure) -> None:
    """Gives the structures in one that was run the names of those that they are behind or in front of."""
    stated: dict[Structure, dict[Structure, ast.Attribute]] = {}
    for s in parent.children:
        if s.source is not None:
            _take_over(it, s, s.source, parent, stated)
        if s in it.orders:
            _read(it, s, parent, it.orders[s], stated)
    if cycle := _cycle(stated):
        _report_cycle(it, cycle, stated)


def _read(
    it: Interpreter,
    s: Structure,
    parent: Structure,
    orders: list[StatedOrder],
    stated: dict[Structure, dict[Structure, ast.Attribute]],
) -> None:
    names: dict[str, list[str]] = {}
    for order in orders:
        attribute = order.attribute
        values = [evaluate(it, a.value, Env(order.scope, parent, Reach.READ)) for a in attribute.arguments]
        if any(isinstance(value, Nothing) for value in values):
            continue
        others = [list(each_of(value, Structure)) for value in values]
        if not others or not all(others):
            taken = f"takes the names of structures beside it, as in `@{order.name}(wall)`"
            it.report("E0517", f"`@{attribute.name.text}` {taken}", attribute)
            continue
        for other in (o for group in others for o in group if o is not s or len(group) == 1):
            if other.parent is not parent or other is s:
                _misplaced(it, s, other, parent, order)
                continue
            names.setdefault(order.name, []).append(other.name)
            back, front = (s, other) if order.name == BEHIND else (other, s)
            stated.setdefault(back, {})[front] = attribute
    for name, found in names.items():
        s.attributes[name] = tuple(map(TextVal, dict.fromkeys(found)))


def _misplaced(
    it: Interpreter, s: Structure, other: Structure, parent: Structure, order: StatedOrder
) -> None:
    hints = ["the order is stated between structures that stand side by side in one structure"]
    if other is s:
        why = f"`{s.name}` cannot be {_WORDS[order.name]} itself"
        hints = ["name another structure beside it"]
    elif s.is_within(other):
        why = f"`{s.name}` is a part of `{other.name}`, and parts are drawn on the whole"
    else:
        why = f"`{other.name}` is not beside `{s.name}`"
        beside = next((c for c in parent.children if other.is_within(c) and c is not s), None)
        if other.is_within(s):
            why = f"`{other.name}` is a part of `{s.name}`, and parts are drawn on the whole"
        elif beside is not None:
            hints = [f"all of `{beside.name}` is drawn together: `@{order.name}({beside.name})`"]
    it.report("E0521", why, order.attribute, hints=hints)


def _take_over(
    it: Interpreter,
    s: Structure,
    source: Structure,
    parent: Structure,
    stated: dict[Structure, dict[Structure, ast.Attribute]],
) -> None:
    """Leaves to a copy what is said of its source, not of itself, and holds beside the copy, too."""
    beside = {child.name: child for child in parent.children if child is not s}
    own = {order.name for order in it.orders.get(s, ())}
    for name in STACKING:
        values = source.attributes.get(name, ()) if name not in own else ()
        kept = tuple(v for v in values if isinstance(v, TextVal) and v.value in beside)
        s.attributes.pop(name, None)
        if not kept:
            continue
        s.attributes[name] = kept
        attribute = _stated(it, source, name)
        for value in kept:
            back, front = (s, beside[value.value]) if name == BEHIND else (beside[value.value], s)
            stated.setdefault(back, {})[front] = attribute


def _stated(it: Interpreter, s: Structure, name: str) -> ast.Attribute:
    """Returns the attribute of a name by which the order of a structure is stated, or that of its source."""
    here: Structure | None = s
    while here is not None:
        for order in it.orders.get(here, ()):
            if order.name == name:
                return order.attribute
        here = here.source
    raise KeyError(name)


def _cycle(stated: Mapping[Structure, Mapping[Structure, ast.Attribute]]) -> list[Structure]:
    """Returns structures each behind the next, and the last behind the first; none if there are none."""
    done: set[Structure] = set()
    for start in stated:
        way: dict[Structure, Iterator[Structure]] = {} if start in done else {start: iter(stated[start])}
        while way:
            last = next(reversed(way))
            following = next(way[last], None)
            if following is None:
                done.add(last)
                del way[last]
            elif following in way:
                found = list(way)
                return found[found.index(following) :]
            elif following not in done:
                way[following] = iter(stated.get(following, ()))
    return []


def _report_cycle(
    it: Interpreter, cycle: list[Structure], stated: Mapping[Structure, Mapping[Structure, ast.Attribute]]
) -> None:
    rest = [*cycle[1:], cycle[0]]
    attributes = [stated[back][front] for back, front in zip(cycle, rest, strict=True)]
    chain = ", which is behind ".join(f"`{s.name}`" for s in rest)
    it.report(
        "E0521",
        f"`{cycle[0].name}` would be behind itself: it is behind {chain}",
        attributes[0],
        hints=[f"leave one of {listed(f'`{a.span.one_line}`' for a in attributes)} out"],
        secondary=[Label(a.span, "and this") for a in attributes[1:]],
    )


_WORDS = {BEHIND: "behind", IN_FRONT: "in front of"}
