"""The order of drawing from what structures say of it."""

from __future__ import annotations

import random

from aidl_lang.geometry.styles import stacked
from tests.geometry.models import structure


def order(**said: dict[str, tuple[str, ...]]) -> str:
    """The order of structures with names of one letter, written in this order."""
    root = structure("assembly", "_", *(structure("solid", name, **words) for name, words in said.items()))
    return "".join(s.name for s in stacked(root) if s.name != "_")


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
