"""What turns because a constraint asks it to: shapes that are level, and structures, until then."""

from __future__ import annotations

from aidl_lang import expression as ex
from aidl_lang.expression import Expression
from aidl_lang.model import Condition
from aidl_lang.types import Signature

_OF_DIRECTIONS = frozenset({"parallel", "perpendicular", "angle", "collinear"})
"""Constraints on the directions of lines, which may be edges of shapes."""

_SMALL = 1e-9


def unlock(*of: Expression) -> None:
    """What was exact only because nothing asked it to turn is an unknown from now on."""
    for unknown in ex.unknowns(of):
        unknown.exact &= not unknown.locked


def ask_to_turn(definition: Signature, condition: Condition) -> None:
    """Let shapes turn whose edges a constraint gives a direction; not those that it finds level both."""
    if not definition.standard or definition.name not in _OF_DIRECTIONS:
        return
    for comparison in condition.comparisons():
        sides = comparison.left, comparison.right
        found = list(ex.unknowns(sides))
        level = {u.holder for u in found if u.locked and u.exact}
        is_decided = all(u.holder in level for u in found)
        if not (is_decided and abs(comparison.left.value - comparison.right.value) < _SMALL):
            unlock(*sides)
