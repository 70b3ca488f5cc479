"""The order of drawing: that of writing, but for what `@behind` and `@in_front` say."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from heapq import heapify, heappop, heappush

from aidl_lang.checking.builtins import BEHIND, IN_FRONT, STACKING
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.prose import named
from aidl_lang.geometry.notes import united_notes
from aidl_lang.geometry.solved import SolvedStructure

_REMEDY = "make `{0}` an `assembly` of several bodies"


def stacked(root: SolvedStructure) -> Iterator[SolvedStructure]:
    """Yields a structure and all below it from back to front; parts lie on the whole."""
    yield root
    for child in _ordered(root.structures):
        yield from stacked(child)


def idle_orders(root: SolvedStructure, bodies: Collection[str]) -> list[Diagnostic]:
    """Returns warnings about orders between structures that are not drawn by themselves: parts of a body."""

    def other(s: SolvedStructure, body: SolvedStructure) -> list[str]:
        return [name for name in STACKING if name in s.attributes]

    found = united_notes(root, bodies, other, hint=_REMEDY)
    for around in root.walk():
        parts = {s.name for s in around.structures if s.kind != "drawing" and s.path not in bodies}
        for s in around.structures if around.kind == "solid" else ():
            for name in STACKING if s.kind == "drawing" else ():
                if united := [part for part in map(str, s.attributes.get(name, ())) if part in parts]:
                    found.append(_idle(s, name, united, around))
    return found


def _idle(s: SolvedStructure, name: str, united: list[str], body: SolvedStructure) -> Diagnostic:
    are = "is" if len(united) == 1 else "are"
    return Diagnostic(
        "W0727",
        f"`@{name}` of `{s.path}` counts for nothing: {named(united, 3)} {are} one body with `{body.path}`",
        s.span,
        "drawn on all of that body",
        hints=(_REMEDY.format(body.name),),
    )


def _ordered(beside: Sequence[SolvedStructure]) -> Sequence[SolvedStructure]:
    """Returns structures side by side from back to front.

    Who states an order that writing does not give stands directly behind, or in front of, what it names; the
    others keep their order.
    """
    if not any(name in s.attributes for s in beside for name in STACKING):
        return beside
    places = {s.name: number for number, s in enumerate(beside)}
    said = {
        (s.name, name): [other for other in map(str, s.attributes.get(name, ())) if other in places]
        for s in beside
        for name in STACKING
    }
    wanted = _wanted(places, said)
    above: dict[str, set[str]] = {name: set() for name in places}
    for (own, name), others in said.items():
        for other in others:
            back, front = (own, other) if name == BEHIND else (other, own)
            above[back].add(front)
    below = dict.fromkeys(places, 0)
    for fronts in above.values():
        for front in fronts:
            below[front] += 1
    ready = [(wanted[name], places[name], name) for name, count in below.items() if not count]
    heapify(ready)
    found: list[SolvedStructure] = []
    while ready:
        _, place, name = heappop(ready)
        found.append(beside[place])
        for front in above[name]:
            below[front] -= 1
            if not below[front]:
                heappush(ready, (wanted[front], places[front], front))
    return found


def _wanted(places: dict[str, int], said: dict[tuple[str, str], list[str]]) -> dict[str, float]:
    """Returns the place for which each structure asks: its own, or a little before or after that of what it
    names.
    """
    wanted: dict[str, float] = {name: float(place) for name, place in places.items()}
    step = 1 / (len(places) + 1)
    for _ in places:
        before = dict(wanted)
        for (own, name), others in said.items():
            if others and name == BEHIND:
                wanted[own] = min(wanted[own], min(wanted[other] for other in others) - step)
            elif others and name == IN_FRONT:
                wanted[own] = max(wanted[own], max(wanted[other] for other in others) + step)
        if wanted == before:
            break
    return wanted
