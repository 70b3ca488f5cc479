"""The order of drawing from what structures say of it."""

from __future__ import annotations

import random

import pytest

from aidl_lang.geometry.solved import SolvedStructure
from aidl_lang.geometry.styles import stacked
from tests.geometry.models import structure


def order(**said: dict[str, tuple[str, ...]]) -> str:
    """The order of structures with names of one letter, written in this order."""
    root = structure("assembly", "_", *(structure("solid", name, **words) for name, words in said.items()))
    return "".join(s.name for s in stacked(root) if s.name != "_")


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ({"a": {}, "b": {}, "c": {}}, "abc"),
        ({"a": {}, "b": {}, "c": {"behind": ("a",)}}, "cab"),
        ({"a": {}, "b": {}, "c": {"behind": ("b",)}}, "acb"),
        ({"a": {"in_front": ("c",)}, "b": {}, "c": {}, "d": {}}, "bcad"),
        ({"a": {}, "b": {"behind": ("c",)}, "c": {}}, "abc"),
        ({"p": {}, "q": {}, "a": {}, "b": {"behind": ("a",)}, "c": {"behind": ("b",)}}, "pqcba"),
        ({"a": {"in_front": ("b",)}, "b": {"in_front": ("c",)}, "c": {}, "d": {}}, "cbad"),
        ({"a": {}, "b": {}, "c": {"behind": ("a", "b")}}, "cab"),
        ({"a": {}, "b": {"in_front": ("c",), "behind": ("d",)}, "c": {}, "d": {}}, "acbd"),
        ({"a": {"behind": ("c",), "in_front": ("d",)}, "b": {}, "c": {}, "d": {}}, "bdac"),
    ],
)
def test_who_states_an_order_moves(said: dict[str, dict[str, tuple[str, ...]]], expected: str) -> None:
    assert order(**said) == expected


def test_whatever_is_stated_holds() -> None:
    chance = random.Random(7)
    for _ in range(300):
        count = chance.randint(2, 9)
        names = [chr(ord("a") + k) for k in range(count)]
        depth = dict(zip(names, chance.sample(range(count), count), strict=True))
        said: dict[str, dict[str, tuple[str, ...]]] = {name: {} for name in names}
        for _ in range(chance.randint(1, 8)):
            back, front = sorted(chance.sample(names, 2), key=depth.__getitem__)
            own, word, other = chance.choice([(back, "behind", front), (front, "in_front", back)])
            said[own][word] = (*said[own].get(word, ()), other)
        found = order(**said)
        assert sorted(found) == names
        for own, words in said.items():
            assert all(found.index(own) < found.index(other) for other in words.get("behind", ()))
            assert all(found.index(own) > found.index(other) for other in words.get("in_front", ()))


def test_all_of_a_structure_goes_with_it() -> None:
    inner = structure("solid", "a", structure("drawing", "x"), in_front=("b",))
    root: SolvedStructure = structure("assembly", "r", inner, structure("solid", "b"))
    assert [s.name for s in stacked(root)] == ["r", "b", "a", "x"]
