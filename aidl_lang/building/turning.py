"""Shapes and structures that are level until a constraint asks them to turn."""

from __future__ import annotations

from collections.abc import Iterable

from aidl_lang.building import expression as ex
from aidl_lang.building.expression import Expression
from aidl_lang.building.model import Comparison
from aidl_lang.checking.types import Signature

_OF_DIRECTIONS = frozenset({"parallel", "perpendicular", "angle", "collinear"})
"""Constraints on the directions of lines, which may be edges of shapes."""

_SMALL = 1e-9


def unlock(*of: Expression) -> None:
    """Frees unknowns that were exact only because nothing asked them to turn."""
    for unknown in ex.unknowns(of):
        unknown.exact &= not unknown.locked


def is_of_directions(definition: Signature) -> bool:
    """Tells whether a constraint is about the directions of lines, which may be edges."""
    return definition.standard and definition.name in _OF_DIRECTIONS


def ask_to_turn(comparisons: Iterable[Comparison]) -> None:
    """Lets shapes turn whose edges a constraint gives a direction: those that it places, and one that it
    holds only if nothing else could give way. Two that are level both stay so.
    """
    for comparison in comparisons:
        found = list(ex.unknowns([comparison.left, comparison.right]))
        level = [u for u in found if u.locked and u.exact]
        shapes = {u.holder for u in level}
        others = [u for u in found if u.holder not in shapes]
        if not others and abs(comparison.left.value - comparison.right.value) < _SMALL:
            continue
        placed = [u for u in level if u in comparison.placed]
        for unknown in placed or ([] if others else level):
            unknown.exact = False
